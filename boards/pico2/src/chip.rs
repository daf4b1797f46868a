//! Image, reset and stop of the RP2350.

use palpate::servo::ResetReason;
use palpate_bench::{Cause, Memo, ResetFlags};
use rp235x_hal::block::ImageDef;
use rp235x_hal::pac::{POWMAN, SIO, WATCHDOG};

/// DeviceMessage to the boot ROM: a program for the secure state of an Arm core.
#[unsafe(link_section = ".start_block")]
#[used]
// SAFETY: nothing else lies in this section; the boot ROM reads it.
static IMAGE: ImageDef = ImageDef::secure_exe();

/// The crystal, Hz.
pub const CRYSTAL: u32 = 12_000_000;
/// The core's clock as the HAL sets it, Hz.
pub const CLOCK: u32 = 150_000_000;
/// The pin that switches the bridges on.
const ENABLE_PIN: u32 = 16;
/// The pin of the light.
const LIGHT_PIN: u32 = 25;

/// The memo lies in two scratch registers of the watchdog, which a reset by it leaves alone and any other clears. The
/// boot ROM uses those from the fourth on.
pub fn remember(cause: Cause) {
    let Memo([word, complement]) = Memo::new(cause);
    // SAFETY: two registers that nobody else uses, a word each.
    unsafe {
        let watchdog = &*WATCHDOG::ptr();
        watchdog.scratch0().write(|w| w.bits(word));
        watchdog.scratch1().write(|w| w.bits(complement));
    }
}

/// Why the chip was reset, as its flags and the memo say.
pub fn reset(watchdog: &WATCHDOG, power: &POWMAN) -> ResetReason {
    let memo = Memo([watchdog.scratch0().read().bits(), watchdog.scratch1().read().bits()]);
    let reason = watchdog.reason().read();
    let chip = power.chip_reset().read();
    let (timer, forced) = (reason.timer().bit_is_set(), reason.force().bit_is_set());
    // What reset the chip last stays there over a reset by the watchdog.
    let of_chip = !timer && !forced;
    let flags = ResetFlags {
        watchdog: timer,
        // The boot ROM reboots by the watchdog too, as `picotool` asks it to; it comes from a reset that left no memo.
        tool: timer && memo.cause().is_none(),
        // A flag of its own, which power-on does not raise; or a glitch of the core's supply, where it is watched for.
        brown_out: of_chip && (chip.had_bor().bit_is_set() || chip.had_glitch_detect().bit_is_set()),
        power: of_chip && chip.had_por().bit_is_set(),
        // A program, or a debugger by its port. One that resets a core alone leaves the reason that was there.
        software: forced || (of_chip && (chip.had_dp_reset_req().bit_is_set() || chip.had_rescue().bit_is_set())),
        pin: of_chip && chip.had_run_low().bit_is_set(),
    };
    // Power-on clears the memo: what is left of it says nothing about a brown-out here.
    let of_this_reset = if timer { memo } else { Memo::EMPTY };
    flags.reason(of_this_reset)
}

/// Whether the pin that switches the bridges on reads as high.
pub fn reads_enabled() -> bool {
    // SAFETY: read alone.
    unsafe { (*SIO::ptr()).gpio_in().read().bits() & 1 << ENABLE_PIN != 0 }
}

/// Takes the motors' power away, by the register. Before anything else too: a reset of the core alone leaves the level
/// as it was, and a pin that becomes an output shows it.
pub fn motors_off() {
    // SAFETY: a write that clears one bit, and leaves the others alone.
    unsafe { (*SIO::ptr()).gpio_out_clr().write(|w| w.bits(1 << ENABLE_PIN)) };
}

#[unsafe(no_mangle)]
fn palpate_motors_off(cause: Cause) {
    motors_off();
    // SAFETY: nothing else runs on this core any more; it lights the light.
    unsafe { (*SIO::ptr()).gpio_out_set().write(|w| w.bits(1 << LIGHT_PIN)) };
    remember(cause);
}
