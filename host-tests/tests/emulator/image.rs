//! The size of the image is a budget.

use crate::running::{TRANSPORTS, firmware_of};
use palpate_host::firmware::Board;

/// Code and tables of one patch: they fit the smallest Cortex-M4F parts.
const FLASH: u64 = 32 * 1024;
/// Variables; the stack comes on top.
const RAM: u64 = 2 * 1024;

#[test]
fn the_image_is_within_its_budget() {
    for board in Board::ALL {
        let Some(firmware) = firmware_of(board, "the_image_is_within_its_budget") else { return };
        for transport in TRANSPORTS {
            let image = firmware.images.of(transport);
            assert!((4_096..=FLASH).contains(&image.flash), "{board:?}, {transport:?}: {} bytes of flash", image.flash);
            assert!((64..=RAM).contains(&image.ram), "{board:?}, {transport:?}: {} bytes of RAM", image.ram);
        }
    }
}
