//! The firmware on the emulated boards: set-up, image, emulator and the link to it.
//!
//! ```no_run
//! use palpate_tool::firmware::{self, Link, Transport};
//! # fn main() -> anyhow::Result<()> {
//! let firmware = firmware::prepare(&firmware::Choice::default(), &firmware::Progress::new())?;
//! let mut emulator = firmware.start(Transport::Fifo)?;
//! let report = emulator.exchange(&palpate::wire::Sensors::default())?;
//! # Ok(())
//! # }
//! ```

mod board;
mod debian;
mod emulator;
#[cfg(unix)]
mod fifos;
#[cfg(not(unix))]
#[path = "no_fifos.rs"]
mod fifos;
mod image;
mod line;
mod link;
mod memory;
pub(crate) mod process;
mod program;
mod progress;
mod qemu;
mod toolchain;
mod transport;
mod way;

pub use board::{AnyBoard, BenchBoard, Board};
pub use emulator::{Emulator, Running};
pub(crate) use image::choose_body;
pub use image::{BenchBody, Choice, Image, Images, build_all, build_bench};
pub use link::{Link, LinkError};
pub use memory::{Kind, Memory, Place, report};
pub use process::{SetUpError, without_outer_cargo};
pub(crate) use process::{apt_install, on_path, output};
pub use program::Program;
pub use progress::{Progress, told};
pub use qemu::{Pace, Qemu};
pub use toolchain::Toolchain;
pub use transport::Transport;

/// The variable that makes the tests use the emulated board; `palpate test` sets it once everything is set up.
pub const WITH_FIRMWARE: &str = "PALPATE_FIRMWARE";

/// The variable that makes tests of one core run on every core: `.ci/long` sets it.
pub const EVERY_CORE: &str = "PALPATE_EVERY_CORE";

/// Whether this is a long run.
pub fn is_long() -> bool {
    std::env::var_os(EVERY_CORE).is_some()
}

/// The cores that every image is built for: the first, or every Cortex-M with floats in a long run.
pub fn cores() -> &'static [Board] {
    if is_long() { &Board::CORTEX_F } else { &Board::CORTEX_F[..1] }
}

/// The cores whose bits are compared with the host's: a long run has those without floats, which take minutes.
pub fn compared() -> Vec<Board> {
    Board::ALL.into_iter().filter(|board| is_long() || board.has_floats()).collect()
}

/// All that is needed to run the firmware: an emulator and the images.
#[derive(Debug)]
pub struct Firmware {
    /// The emulator.
    pub qemu: Qemu,
    /// The images, one a transport.
    pub images: Images,
}

impl Firmware {
    /// Starts the image of a transport in the emulator.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start(&self, transport: Transport) -> Result<Emulator, LinkError> {
        Emulator::start(&self.qemu, self.images.of(transport), transport)
    }
}

/// Sets up emulator and toolchain as far as they are missing, and builds the images.
///
/// # Errors
/// [`SetUpError::NoEmulator`] if there is no emulator and none can be had: run the host loop then. Otherwise what went
/// wrong.
pub fn prepare(choice: &Choice, progress: &Progress) -> Result<Firmware, SetUpError> {
    let qemu = Qemu::set_up(choice.board, progress)?;
    let toolchain = Toolchain::set_up(choice.board.target(), progress)?;
    let images = image::build(&toolchain, choice, progress)?;
    Ok(Firmware { qemu, images })
}
