//! The memories of the bench boards: place of a body's tables, and the linker's use of each memory.

use super::{BenchBoard, SetUpError};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, SectionKind, elf};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A memory of a chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Its name, as the board's memory map has it.
    pub name: &'static str,
    /// Its name in the board's memory map.
    pub start: u64,
    /// Its bytes.
    pub bytes: u64,
    /// Kind of memory.
    pub kind: &'static str,
}

/// Place of a body's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// All in the fastest memory.
    Fast,
    /// In flash, behind its cache, except for tables that the board copies to faster memory.
    Flash,
}

/// Kind of a board's image; each kind has its own memory map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It renders the body that it was built with.
    Alone,
    /// A host may change the rendered body (feature `host`).
    Hosted,
    /// Its acceptance (feature `accept`).
    Accepted,
}

const KB: u64 = 1_024;

const fn memory(name: &'static str, start: u64, bytes: u64, kind: &'static str) -> Memory {
    Memory { name, start, bytes, kind }
}

impl BenchBoard {
    /// Its memories. A test compares them with the board's memory map.
    pub const fn memories(self, kind: Kind) -> &'static [Memory] {
        const STM32G4: &[Memory] = &[
            memory("CCM", 0x1000_0000, 32 * KB, "core-coupled RAM"),
            memory("STACK", 0x2000_0000, 8 * KB, "RAM, all for the stack"),
            memory("RAM", 0x2000_2000, 16 * KB, "RAM"),
            memory("TABLES", 0x2000_6000, 72 * KB, "RAM"),
            memory("FLASH", 0x0800_0000, 384 * KB, "flash"),
        ];
        const PICO2: &[Memory] = &[
            memory("STACK", 0x2000_0000, 32 * KB, "RAM, all for the stack"),
            memory("RAM", 0x2000_8000, 32 * KB, "RAM"),
            memory("FAST", 0x2001_0000, 448 * KB, "RAM"),
            memory("FLASH", 0x1000_0000, 3 * KB * KB, "flash"),
        ];
        const TEENSY41: &[Memory] = &[
            memory("ITCM", 0x0000_0000, 192 * KB, "core-coupled RAM for code"),
            memory("DTCM", 0x2000_0000, 320 * KB, "core-coupled RAM for data"),
            memory("FLASH", 0x6000_0000, 7_936 * KB, "flash"),
        ];
        // The script's code takes more than any other's.
        const TEENSY41_ACCEPTED: &[Memory] = &[
            memory("ITCM", 0x0000_0000, 224 * KB, "core-coupled RAM for code"),
            memory("DTCM", 0x2000_0000, 288 * KB, "core-coupled RAM for data"),
            memory("FLASH", 0x6000_0000, 7_936 * KB, "flash"),
        ];
        const STM32G4_HOSTED: &[Memory] = &[
            memory("CCM", 0x1000_0000, 32 * KB, "core-coupled RAM"),
            memory("STACK", 0x2000_0000, 8 * KB, "RAM, all for the stack"),
            memory("RAM", 0x2000_2000, 28 * KB, "RAM"),
            memory("TABLES", 0x2000_9000, 60 * KB, "RAM"),
            memory("FLASH", 0x0800_0000, 129 * KB, "flash"),
        ];
        const PICO2_HOSTED: &[Memory] = &[
            memory("STACK", 0x2000_0000, 32 * KB, "RAM, all for the stack"),
            memory("RAM", 0x2000_8000, 224 * KB, "RAM"),
            memory("FAST", 0x2004_0000, 256 * KB, "RAM"),
            memory("FLASH", 0x1000_0000, 3 * KB * KB, "flash"),
        ];
        match (self, kind) {
            (Self::Stm32g4, Kind::Alone | Kind::Accepted) => STM32G4,
            (Self::Stm32g4, Kind::Hosted) => STM32G4_HOSTED,
            (Self::Pico2, Kind::Alone | Kind::Accepted) => PICO2,
            (Self::Pico2, Kind::Hosted) => PICO2_HOSTED,
            (Self::Teensy41, Kind::Alone | Kind::Hosted) => TEENSY41,
            (Self::Teensy41, Kind::Accepted) => TEENSY41_ACCEPTED,
        }
    }

    /// Bytes available for tables in the fastest memory and in flash: the capacity less the needs of the loop and of
    /// the code of its largest body.
    const fn room(self, kind: Kind) -> [u64; 2] {
        match (self, kind) {
            // 16 KB of TABLES for code that CCM does not take and for constants; 32 KB of flash for the program.
            (Self::Stm32g4, Kind::Alone | Kind::Accepted) => [56 * KB, 352 * KB],
            // 96 KB for the code of the largest kind of body and of the plug, and for constants.
            (Self::Pico2, Kind::Alone | Kind::Accepted) => [352 * KB, (3 * KB - 64) * KB],
            // 32 KB of stack, 32 KB of variables and constants, including the USB controller's lists.
            (Self::Teensy41, Kind::Alone | Kind::Accepted) => [256 * KB, (7_936 - 256) * KB],
            // A scene's code takes most of CCM and TABLES. With the initial values of variables it takes 83 KB of the
            // program's bank of flash.
            (Self::Stm32g4, Kind::Hosted) => [4 * KB, 44 * KB],
            (Self::Pico2, Kind::Hosted) => [160 * KB, (3 * KB - 64) * KB],
            // The two banks for bodies of a host take 182 KB.
            (Self::Teensy41, Kind::Hosted) => [64 * KB, (7_936 - 256) * KB],
        }
    }

    /// The memory that holds `tables` bytes of tables on this board; `None` if they do not fit.
    pub const fn place(self, kind: Kind, tables: u64) -> Option<Place> {
        let [fast, flash] = self.room(kind);
        if tables <= fast {
            Some(Place::Fast)
        } else if tables <= flash {
            Some(Place::Flash)
        } else {
            None
        }
    }

    /// [`Self::place`], in a sentence.
    pub fn says(self, kind: Kind, tables: u64) -> String {
        let [fast, flash] = self.room(kind);
        let kb = |bytes: u64| format!("{:.1} KB", bytes as f64 / KB as f64);
        match self.place(kind, tables) {
            Some(Place::Fast) => format!("in the fastest memory, of {}", kb(fast)),
            Some(Place::Flash) => {
                format!("in flash, behind its cache: the fastest memory has {} for {}", kb(fast), kb(tables))
            }
            None => format!("do not fit: {} of tables, {} of flash", kb(tables), kb(flash)),
        }
    }
}

/// Reports the size of an image in each memory of a board, and the memory that holds the body's tables.
///
/// # Errors
/// If the file cannot be read.
pub fn report(board: BenchBoard, kind: Kind, image: &Path) -> Result<String, SetUpError> {
    let content = fs::read(image).map_err(SetUpError::io(image.display()))?;
    let refused = |reason: &str| SetUpError::Image { path: image.to_path_buf(), reason: reason.to_owned() };
    let file = object::File::parse(content.as_slice()).map_err(|error| refused(&error.to_string()))?;
    let taken = |memory: &Memory| -> u64 {
        let is_in = |address: u64| (memory.start..memory.start + memory.bytes).contains(&address);
        let sections = file.sections().filter(|section| is_in(section.address()));
        sections.filter(|section| is_loaded(&section.flags())).map(|section| section.size()).sum()
    };
    // What is copied before main lies in flash once more.
    let images: u64 = file
        .sections()
        .filter(|section| is_loaded(&section.flags()) && section.kind() != SectionKind::UninitializedData)
        .filter(|section| {
            board.memories(kind).iter().all(|memory| memory.kind != "flash" || !memory.holds(section.address()))
        })
        .filter(|section| section.name().is_ok_and(|name| name != ".stack"))
        .map(|section| section.size())
        .sum();
    let mut text = String::new();
    for memory in board.memories(kind) {
        // The stack has no section: the whole memory is its.
        if memory.name == "STACK" && taken(memory) == 0 {
            let _ = writeln!(text, "  {:<7} {:>8}    {:>8} bytes  {}", memory.name, "", memory.bytes, memory.kind);
            continue;
        }
        let copies = if memory.kind == "flash" { format!(", and {images} of images for RAM") } else { String::new() };
        let _ = writeln!(
            text,
            "  {:<7} {:>8} of {:>8} bytes  {}{copies}",
            memory.name,
            taken(memory),
            memory.bytes,
            memory.kind
        );
    }
    let tables: Vec<(u64, u64)> = file
        .symbols()
        .filter(|symbol| {
            symbol.name().is_ok_and(|name| rustc_demangle::demangle(name).to_string().contains("body::tables::"))
        })
        .map(|symbol| (symbol.address(), symbol.size()))
        .collect();
    for memory in board.memories(kind) {
        let bytes: u64 = tables.iter().filter(|(address, _)| memory.holds(*address)).map(|(_, bytes)| bytes).sum();
        if bytes > 0 {
            let _ = writeln!(text, "  tables  {bytes:>8} bytes in {} ({})", memory.name, memory.kind);
        }
    }
    Ok(text)
}

impl Memory {
    const fn holds(&self, address: u64) -> bool {
        self.start <= address && address < self.start + self.bytes
    }
}

fn is_loaded(flags: &SectionFlags) -> bool {
    matches!(flags, SectionFlags::Elf { sh_flags, .. } if *sh_flags & elf::SHF_ALLOC == elf::SHF_ALLOC)
}
