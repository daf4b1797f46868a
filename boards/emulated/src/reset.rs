//! Why the chip was reset, from its register.

use palpate::servo::ResetReason;
use vcell::VolatileCell;

/// The register that says why the chip was reset. The emulator's says power-on, whatever came before.
#[derive(Clone, Copy, Debug)]
pub struct ResetRegister {
    /// Its address.
    pub address: usize,
    /// The flag of a reset that the program asked for.
    pub requested: u32,
    /// The flags of watchdogs, and of a core that locked up: a program that hung, as much as one that a watchdog found.
    pub hung: u32,
    /// Whether a flag is cleared by writing a one; if not, by a zero.
    pub cleared_by_one: bool,
}

impl ResetRegister {
    /// Of the Cortex-M System Design Kit (its technical reference, "System controller", RSTINFO).
    pub const DESIGN_KIT: Self = Self { address: 0x4001_f010, requested: 1, hung: 0b110, cleared_by_one: true };
    /// Of the SSE-200 (its technical reference, "System control", RESET_SYNDROME), secure alias.
    pub const SSE_200: Self =
        Self { address: 0x5002_1100, requested: 1 << 4, hung: 0b1100_1110, cleared_by_one: false };
}

impl ResetRegister {
    /// The reason, read once: the flags are cleared, so that the next reset does not find them.
    pub fn reason(&self) -> ResetReason {
        // SAFETY: the address is the chip's, the register is there for good, and a `VolatileCell` may be shared.
        let register = unsafe { &*(self.address as *const VolatileCell<u32>) };
        let flags = register.get();
        register.set(if self.cleared_by_one { flags } else { 0 });
        if flags & self.hung != 0 {
            ResetReason::Watchdog
        } else if flags & self.requested != 0 {
            ResetReason::Software
        } else {
            ResetReason::PowerOn
        }
    }
}
