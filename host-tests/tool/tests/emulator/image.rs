//! The size of the image is a budget.

use crate::running::firmware_of;
use palpate_tool::firmware::{Board, Transport};

/// Code and tables of the capped box, the loop and its UART: they fit small Cortex-M4F parts. Two of the kilobytes are
/// the search beside a pole and the watch over contact; one buys that nothing is felt in free air: over sharp edges,
/// at corners and over hollow faces; another that a search ends unseen only where little is left to gain. It holds the code of its body's degrees alone.
const FLASH: u64 = 48 * 1024;
/// Files of the host in the place of a UART are the emulator's, and take more.
const WITH_FILES: u64 = FLASH + 2 * 1024;
/// Variables; the stack comes on top.
const RAM: u64 = 4 * 1024;

#[test]
fn the_image_is_within_its_budget() {
    for board in Board::CORTEX_F {
        let Some(firmware) = firmware_of(board, "the_image_is_within_its_budget") else { return };
        for (transport, most) in [(Transport::Uart, FLASH), (Transport::Fifo, WITH_FILES)] {
            let image = firmware.images.of(transport);
            assert!((4_096..=most).contains(&image.flash), "{board:?}, {transport:?}: {} bytes of flash", image.flash);
            assert!((64..=RAM).contains(&image.ram), "{board:?}, {transport:?}: {} bytes of RAM", image.ram);
        }
    }
}
