//! The functions in an image.

use super::decode::{Decoder, Flow, Instruction};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};
use thiserror::Error;

/// Why an image's code cannot be read.
#[derive(Debug, Error)]
pub enum CodeError {
    /// The file.
    #[error("{0}: {1}")]
    Io(PathBuf, io::Error),
    /// Not the kind of file.
    #[error("{0}: {1}")]
    File(PathBuf, object::Error),
    /// The disassembler.
    #[error("the disassembler: {0}")]
    Decoder(capstone::Error),
    /// Something that is no instruction.
    #[error("{function}: no instruction at {address:#x}")]
    Undecodable {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
    },
    /// No such function, or several.
    #[error("{count} functions are called {name}")]
    NotOne {
        /// The name.
        name: String,
        /// How many there are.
        count: usize,
    },
}

/// A function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name in the source, without hash.
    pub name: String,
    /// Its first address.
    pub address: u64,
    /// Its instructions, by address.
    pub instructions: BTreeMap<u64, Instruction>,
    /// Where each jump through a table may lead, by the address of the jump.
    pub tables: BTreeMap<u64, Vec<u64>>,
    /// Bytes, with its literals and tables.
    pub size: u64,
}

impl Function {
    /// Where an instruction may lead within this function, and what it calls or jumps to outside.
    pub fn successors(&self, instruction: &Instruction) -> (Vec<u64>, Option<u64>) {
        let next = instruction.address + instruction.length;
        let inside = |target: u64| self.instructions.contains_key(&target);
        match instruction.flow {
            Flow::Next | Flow::IndirectCall | Flow::MaybeReturn => (vec![next], None),
            Flow::Jump(target) if inside(target) => (vec![target], None),
            Flow::Jump(target) => (Vec::new(), Some(target)),
            Flow::Branch(target) if inside(target) => (vec![next, target], None),
            Flow::Branch(target) => (vec![next], Some(target)),
            Flow::Call(target) => (vec![next], Some(target)),
            Flow::Table(_) => (self.tables.get(&instruction.address).cloned().unwrap_or_default(), None),
            Flow::Return | Flow::IndirectJump | Flow::Trap => (Vec::new(), None),
        }
    }
}

/// Everything in an image that can be executed.
#[derive(Debug)]
pub struct Code {
    functions: BTreeMap<u64, Function>,
}

impl Code {
    /// Reads an image.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path) -> Result<Self, CodeError> {
        let content = fs::read(path).map_err(|error| CodeError::Io(path.to_path_buf(), error))?;
        let refused = |error| CodeError::File(path.to_path_buf(), error);
        let file = object::File::parse(content.as_slice()).map_err(refused)?;
        let decoder = Decoder::new().map_err(CodeError::Decoder)?;
        // `$t` begins code, `$d` data among it (Arm ELF, "Mapping symbols").
        let mut kinds = BTreeMap::new();
        let mut starts: BTreeMap<u64, (String, u64)> = BTreeMap::new();
        for symbol in file.symbols() {
            let Ok(name) = symbol.name() else { continue };
            if name.starts_with("$t") || name.starts_with("$d") {
                kinds.insert(symbol.address(), name.starts_with("$t"));
            } else if symbol.kind() == SymbolKind::Text && symbol.is_definition() {
                // The lowest bit says that it is Thumb.
                let entry = starts.entry(symbol.address() & !1).or_default();
                // Of several names for one place the longest function's, and a mangled one before a bare one.
                if entry.0.is_empty() || symbol.size() > entry.1 || name.starts_with("_R") || name.starts_with("_Z") {
                    *entry = (format!("{:#}", rustc_demangle::demangle(name)), symbol.size().max(entry.1));
                }
            }
        }
        let mut functions = BTreeMap::new();
        for (address, (name, size)) in starts {
            let Some(section) = file.sections().find(|section| {
                (section.address()..section.address() + section.size()).contains(&address) && section.size() > 0
            }) else {
                continue;
            };
            let data = section.data_range(address, size).map_err(refused)?.unwrap_or_default();
            functions.insert(address, function(&decoder, &kinds, name, address, data)?);
        }
        Ok(Self { functions })
    }

    /// Every function.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        self.functions.values()
    }

    /// The function that starts at this address.
    pub fn at(&self, address: u64) -> Option<&Function> {
        self.functions.get(&address)
    }

    /// The one function of this name.
    ///
    /// # Errors
    /// [`CodeError::NotOne`].
    pub fn named(&self, name: &str) -> Result<&Function, CodeError> {
        let found: Vec<&Function> = self.functions().filter(|function| function.name == name).collect();
        match found[..] {
            [function] => Ok(function),
            _ => Err(CodeError::NotOne { name: name.to_owned(), count: found.len() }),
        }
    }
}

/// `NOP`, as it lies in memory.
const NOP: [u8; 2] = [0x00, 0xbf];

fn function(
    decoder: &Decoder,
    kinds: &BTreeMap<u64, bool>,
    name: String,
    address: u64,
    data: &[u8],
) -> Result<Function, CodeError> {
    let end = address + data.len() as u64;
    let mut instructions = BTreeMap::new();
    let mut start = address;
    let is_code = |at: u64| kinds.range(..=at).next_back().is_none_or(|(_, code)| *code);
    let bytes = |from: u64, to: u64| &data[(from - address) as usize..(to - address) as usize];
    while start < end {
        let stop = kinds.range(start + 1..end).next().map_or(end, |(at, _)| *at);
        if is_code(start) {
            let decoded = decoder
                .decode(bytes(start, stop), start)
                .map_err(|address| CodeError::Undecodable { function: name.clone(), address })?;
            instructions.extend(decoded.into_iter().map(|instruction| (instruction.address, instruction)));
        }
        start = stop;
    }
    let mut tables = BTreeMap::new();
    for instruction in instructions.values() {
        let Flow::Table(width) = instruction.flow else { continue };
        // The entries run from behind the jump to where code begins again. What is there for alignment alone is a zero,
        // which would lead to the table itself, and then NOPs.
        let from = instruction.address + instruction.length;
        let to = kinds.range(from + 1..end).find(|(_, code)| **code).map_or(end, |(at, _)| *at);
        let mut table = bytes(from, to);
        while let Some(shorter) = table.strip_suffix(&NOP) {
            table = shorter;
        }
        let targets = table.chunks_exact(width as usize).map(|entry| {
            let count = entry.iter().rev().fold(0, |count, byte| count << 8 | u64::from(*byte));
            from + 2 * count
        });
        let mut targets: Vec<u64> = targets.filter(|target| instructions.contains_key(target)).collect();
        targets.sort_unstable();
        targets.dedup();
        tables.insert(instruction.address, targets);
    }
    Ok(Function { name, address, instructions, tables, size: data.len() as u64 })
}
