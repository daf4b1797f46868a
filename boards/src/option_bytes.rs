//! The option bytes of an STM32G4: what the chip does before the program and beside it.

use core::fmt::{self, Display, Formatter};

/// They, as their register has them (RM0440, FLASH_OPTR); 0 of another chip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OptionBytes(pub u32);

impl OptionBytes {
    /// As chips are delivered.
    pub const DELIVERED: Self = Self(0xffef_f8aa);

    const fn has(self, bit: u32) -> bool {
        self.0 >> bit & 1 == 1
    }

    /// The option to set before any motor is driven, if one is wrong: in Stop mode pins keep their levels and timers
    /// stand still, so that either the watchdog goes on (`IWDG_STOP`) or the mode resets the chip (`nRST_STOP`).
    ///
    /// Nothing else takes supervision away: Standby lets go of every pin, so that the motors are off whether the watchdog
    /// goes on in it or not (`IWDG_STDBY`); without a reset pin (`NRST_MODE`) the watchdog and the supply reset the chip
    /// as before; read-out protection (`RDP`) only keeps a debugger away; a watchdog that the reset starts (`IWDG_SW`)
    /// takes the program's timeout and window too. They are reported.
    pub const fn refused(self) -> Option<&'static str> {
        if self.has(12) && !self.has(17) { Some("IWDG_STOP=1") } else { None }
    }
}

impl Display for OptionBytes {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        // DS12288, "Embedded reset and power control block characteristics"; the others are reserved.
        let brown_out = ["1.7", "2.0", "2.2", "2.5", "2.8"].get((self.0 >> 8 & 7) as usize).unwrap_or(&"?");
        let protection = match self.0 & 0xff {
            0xaa => 0,
            0xcc => 2,
            _ => 1,
        };
        let of = |bit, set, clear| if self.has(bit) { set } else { clear };
        write!(
            formatter,
            "{:08x}: brown-out at {brown_out} V, read-out protection {protection}, watchdog started by the {}, {} in \
             Stop and {} in Standby, {}, {}, parity of SRAM {}",
            self.0,
            of(16, "program", "reset"),
            of(17, "on", "still"),
            of(18, "on", "still"),
            if self.0 >> 28 & 3 == 2 { "no reset pin" } else { "a reset pin" },
            of(22, "two banks", "one bank"),
            of(24, "not checked", "checked"),
        )
    }
}
