//! The size of the image is a budget.

use crate::running::{TRANSPORTS, firmware};

/// Code and tables of one patch: they fit the smallest Cortex-M4F parts.
const FLASH: u64 = 32 * 1024;
/// Variables; the stack comes on top.
const RAM: u64 = 2 * 1024;

#[test]
fn the_image_is_within_its_budget() {
    let Some(firmware) = firmware("the_image_is_within_its_budget") else { return };
    for transport in TRANSPORTS {
        let image = firmware.images.of(transport);
        assert!((4_096..=FLASH).contains(&image.flash), "{transport:?}: {} bytes of flash", image.flash);
        assert!((64..=RAM).contains(&image.ram), "{transport:?}: {} bytes of RAM", image.ram);
    }
}
