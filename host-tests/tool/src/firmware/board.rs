//! The boards: emulated ones, and those for the bench.

use crate::repository::{self, NoRepository};
use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// An emulated board. All run the same programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum)]
pub enum Board {
    /// mps2-an386, a Cortex-M4F.
    #[default]
    M4,
    /// mps2-an500, a Cortex-M7.
    M7,
    /// mps2-an505, a Cortex-M33.
    M33,
    /// virt, with floats in single precision and compressed instructions.
    Riscv,
    /// virt without floats and atomics.
    RiscvImc,
    /// mps2-an385, a Cortex-M3 that runs the code of a Cortex-M0: no floats, no division.
    M0,
}

impl Board {
    /// Every board.
    pub const ALL: [Self; 6] = [Self::M4, Self::M7, Self::M33, Self::Riscv, Self::RiscvImc, Self::M0];
    /// Whether its core computes in single precision by itself.
    pub const fn has_floats(self) -> bool {
        !matches!(self, Self::RiscvImc | Self::M0)
    }

    /// Those whose images run every program and are proved: the Cortex-M cores with floats.
    pub const CORTEX_F: [Self; 3] = [Self::M4, Self::M7, Self::M33];

    /// The programs that other cores run too, without a feature of the boards' crate.
    pub const ON_ANY_CORE: [&str; 5] = ["uart", "fifo", "parity", "budget", "file_budget"];
    /// Those that need the interrupts of a Cortex-M, and its atomic exchanges.
    pub const ON_CORTEX_F: [&str; 7] = ["accept", "bench", "knob_link", "link", "log", "stack", "telemetry"];

    /// Takes one of [`Self::CORTEX_F`] from the command line.
    pub fn cortex_f() -> impl TypedValueParser<Value = Self> {
        let named = |name: String| Self::CORTEX_F.into_iter().find(|board| board.name() == name);
        PossibleValuesParser::new(Self::CORTEX_F.map(Self::name)).map(move |name| named(name).unwrap_or_default())
    }

    /// The word for it on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::M4 => "m4",
            Self::M7 => "m7",
            Self::M33 => "m33",
            Self::Riscv => "riscv",
            Self::RiscvImc => "riscv-imc",
            Self::M0 => "m0",
        }
    }

    /// The core, as its maker calls it.
    pub const fn core(self) -> &'static str {
        match self {
            Self::M4 => "Cortex-M4F",
            Self::M7 => "Cortex-M7",
            Self::M33 => "Cortex-M33",
            Self::Riscv => "RISC-V RV32IMAFC",
            Self::RiscvImc => "RISC-V RV32IMC",
            Self::M0 => "Cortex-M0",
        }
    }

    /// The emulator's name for it.
    pub const fn machine(self) -> &'static str {
        match self {
            Self::M4 => "mps2-an386",
            Self::M7 => "mps2-an500",
            Self::M33 => "mps2-an505",
            Self::Riscv | Self::RiscvImc => "virt",
            Self::M0 => "mps2-an385",
        }
    }

    /// The compiler's name for its kind of core.
    pub const fn target(self) -> &'static str {
        match self {
            Self::M4 | Self::M7 => "thumbv7em-none-eabihf",
            Self::M33 => "thumbv8m.main-none-eabihf",
            Self::Riscv => "riscv32imafc-unknown-none-elf",
            Self::RiscvImc => "riscv32imc-unknown-none-elf",
            Self::M0 => "thumbv6m-none-eabi",
        }
    }

    /// The folder of the crate for all of them.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn folder() -> Result<PathBuf, NoRepository> {
        Ok(repository::root()?.join("boards/emulated"))
    }

    /// The file to pass to cargo's `--config` for this board.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn cargo_config(self) -> Result<PathBuf, NoRepository> {
        Ok(Self::folder()?.join(self.name()).with_extension("toml"))
    }
}

/// A board for the bench, with real encoders and motors. Built here, and not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BenchBoard {
    /// Nucleo-G474RE, a Cortex-M4F.
    Stm32g4,
    /// Raspberry Pi Pico 2 (RP2350), a Cortex-M33.
    Pico2,
    /// Teensy 4.1 (i.MX RT1062), a Cortex-M7.
    Teensy41,
}

impl BenchBoard {
    /// Every board for the bench.
    pub const ALL: [Self; 3] = [Self::Stm32g4, Self::Pico2, Self::Teensy41];

    /// The word for it on the command line, and its folder.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stm32g4 => "stm32g4",
            Self::Pico2 => "pico2",
            Self::Teensy41 => "teensy41",
        }
    }

    /// The compiler's name for its kind of core.
    pub const fn target(self) -> &'static str {
        match self {
            Self::Stm32g4 | Self::Teensy41 => "thumbv7em-none-eabihf",
            Self::Pico2 => "thumbv8m.main-none-eabihf",
        }
    }

    /// Counts a turn of its sensors; `None` where any quadrature encoder is counted.
    pub const fn sensor_counts(self) -> Option<f64> {
        match self {
            Self::Stm32g4 => None,
            // AS5047P, 14 bits.
            Self::Pico2 | Self::Teensy41 => Some(16_384.0),
        }
    }

    /// Bits of the counter or angle that it counts on over its wrap.
    pub const fn counter_bits(self) -> u32 {
        match self {
            Self::Stm32g4 => 16,
            Self::Pico2 | Self::Teensy41 => 14,
        }
    }

    /// Servo rates that its build takes, Hz.
    pub const fn rates_hz(self) -> RangeInclusive<u32> {
        match self {
            Self::Stm32g4 | Self::Pico2 => 3_000..=20_000,
            Self::Teensy41 => 3_000..=40_000,
        }
    }

    /// Whether it drives bridges that give a voltage, not amplifiers that control the current.
    pub const fn has_bridges(self) -> bool {
        matches!(self, Self::Pico2)
    }

    /// The command that flashes an image.
    pub fn flashing(self, image: &Path) -> String {
        let image = image.display();
        match self {
            Self::Stm32g4 => format!("probe-rs run --chip STM32G474RETx {image}"),
            Self::Pico2 => format!("picotool load -u -v -x -t elf {image} (hold BOOTSEL while plugging in)"),
            Self::Teensy41 => format!(
                "llvm-objcopy -O ihex {image} teensy41.hex && teensy_loader_cli --mcu=TEENSY41 -w teensy41.hex (press the board's button)"
            ),
        }
    }

    /// Its crate's folder.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn folder(self) -> Result<PathBuf, NoRepository> {
        Ok(repository::root()?.join("boards").join(self.name()))
    }
}

/// A board of either kind: a crate that cargo can be run for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnyBoard {
    /// One that runs here.
    Emulated(Board),
    /// One that does not.
    Bench(BenchBoard),
}

impl AnyBoard {
    const ALL: [Self; 9] = [
        Self::Emulated(Board::M4),
        Self::Emulated(Board::M7),
        Self::Emulated(Board::M33),
        Self::Emulated(Board::Riscv),
        Self::Emulated(Board::RiscvImc),
        Self::Emulated(Board::M0),
        Self::Bench(BenchBoard::Stm32g4),
        Self::Bench(BenchBoard::Pico2),
        Self::Bench(BenchBoard::Teensy41),
    ];

    /// The word for it on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Emulated(board) => board.name(),
            Self::Bench(board) => board.name(),
        }
    }

    /// The compiler's name for its kind of core.
    pub const fn target(self) -> &'static str {
        match self {
            Self::Emulated(board) => board.target(),
            Self::Bench(board) => board.target(),
        }
    }

    /// Its crate's folder.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn folder(self) -> Result<PathBuf, NoRepository> {
        match self {
            Self::Emulated(_) => Board::folder(),
            Self::Bench(board) => board.folder(),
        }
    }

    /// The file to pass to cargo's `--config` in addition, if the board needs one.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn cargo_config(self) -> Result<Option<PathBuf>, NoRepository> {
        match self {
            Self::Emulated(board) => board.cargo_config().map(Some),
            Self::Bench(_) => Ok(None),
        }
    }
}

impl Default for AnyBoard {
    fn default() -> Self {
        Self::Emulated(Board::default())
    }
}

impl ValueEnum for AnyBoard {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
