//! Why the chip was reset, from its register.

use palpate::servo::ResetReason;
use vcell::VolatileCell;

/// The reset information of the system controller (Arm CMSDK technical reference, "System controller", RSTINFO). The
/// emulator has no such block and reads it as zero: power-on, whatever came before.
const RESET_INFORMATION: *const VolatileCell<u32> = 0x4001_f010 as *const VolatileCell<u32>;
const REQUESTED: u32 = 1;
const WATCHDOG: u32 = 1 << 1;
const LOCK_UP: u32 = 1 << 2;

/// The reason, read once: the flags are cleared, lest the next reset finds them still up.
pub fn reason() -> ResetReason {
    // SAFETY: the address is the chip's (application note AN386), the register is there for good, and a `VolatileCell` may
    // be shared.
    let register = unsafe { &*RESET_INFORMATION };
    let flags = register.get();
    register.set(flags);
    // A locked-up core is a program that hung, as much as one that the watchdog found.
    if flags & (WATCHDOG | LOCK_UP) != 0 {
        ResetReason::Watchdog
    } else if flags & REQUESTED != 0 {
        ResetReason::Software
    } else {
        ResetReason::PowerOn
    }
}
