//! The instructions that a call executes, in their order, as the emulator logs them.

use super::model::{Core, Cost, Cycles};
use super::{Calls, ROOTS, Root};
use crate::firmware::{Board, Program, Progress, SetUpError};
use crate::proof::{Code, CodeError, Flow, Tree};
use std::collections::{BTreeMap, HashMap};
use std::io::{self, BufRead, BufReader};
use thiserror::Error;

/// Why nothing can be estimated.
#[derive(Debug, Error)]
pub enum TraceError {
    /// The program did not run.
    #[error("the program that counts did not run: {0}")]
    Run(#[from] SetUpError),
    /// Its code cannot be read.
    #[error(transparent)]
    Code(#[from] CodeError),
    /// The log.
    #[error("the emulator's log: {0}")]
    Log(#[from] io::Error),
    /// A function leaves by a jump: where a call of it ends cannot be told.
    #[error("{0} ends with a jump to another function")]
    Tail(String),
    /// A function that is never called.
    #[error("{0} was not called")]
    NotCalled(&'static str),
}

/// A call that is being followed.
struct Window {
    root: u64,
    executed: Vec<u64>,
}

/// Runs the program that counts on a board and gives what the calls of each of [`ROOTS`] took on its core.
///
/// # Errors
/// What cannot be built, run or read.
pub fn estimate(board: Board, core: Core, progress: &Progress) -> Result<Vec<(Root, Calls)>, TraceError> {
    let program = Program::prepare(board, "budget", &[], progress)?;
    let code = Code::read(&program.image.elf)?;
    let mut functions = BTreeMap::new();
    let mut roots = HashMap::new();
    for root in &ROOTS {
        let function = code.named(root.function)?;
        let leaves = |instruction| matches!(instruction, Flow::Jump(to) if !function.instructions.contains_key(&to));
        if function.instructions.values().any(|instruction| leaves(instruction.flow.clone())) {
            return Err(TraceError::Tail(root.function.to_owned()));
        }
        roots.insert(function.address, function);
        functions.extend(Tree::new(&code, function).functions().map(|function| (function.address, function)));
    }
    let costs: HashMap<u64, Cost> = functions
        .values()
        .flat_map(|function| &function.instructions)
        .map(|(address, instruction)| (*address, Cost::of(instruction)))
        .collect();
    let ranges: Vec<(u64, u64)> = functions.values().map(|function| (function.address, function.size)).collect();

    let mut all: HashMap<u64, Vec<(u32, [u32; 2])>> = HashMap::new();
    let mut open: Vec<Window> = Vec::new();
    let mut child = program.trace(&ranges)?;
    let log = child.stderr.take().ok_or_else(|| io::Error::other("the emulator has none"))?;
    let mut log = BufReader::with_capacity(1 << 20, log);
    let mut line = Vec::new();
    loop {
        line.clear();
        if log.read_until(b'\n', &mut line)? == 0 {
            break;
        }
        let Some(address) = address(&line) else { continue };
        if !costs.contains_key(&address) {
            continue;
        }
        if roots.contains_key(&address) && open.iter().all(|window| window.root != address) {
            open.push(Window { root: address, executed: Vec::new() });
        }
        for window in &mut open {
            window.executed.push(address);
        }
        // Whoever was called last returns first.
        if let Some(window) = open.last()
            && roots[&window.root].instructions.get(&address).is_some_and(|found| found.flow == Flow::Return)
            && let Some(window) = open.pop()
        {
            all.entry(window.root).or_default().push(spent(core, &costs, &window.executed));
        }
    }
    child.wait()?;
    ROOTS
        .iter()
        .map(|root| {
            let address = code.named(root.function)?.address;
            let mut calls = Calls::default();
            for (instructions, [low, high]) in all.get(&address).into_iter().flatten().skip(root.skip).take(root.take) {
                calls.instructions.push(*instructions);
                calls.cycles[0].push(*low);
                calls.cycles[1].push(*high);
            }
            if calls.instructions.is_empty() { Err(TraceError::NotCalled(root.function)) } else { Ok((*root, calls)) }
        })
        .collect()
}

/// Instructions and cycles of a call.
fn spent(core: Core, costs: &HashMap<u64, Cost>, executed: &[u64]) -> (u32, [u32; 2]) {
    let cost = |index: usize| executed.get(index).and_then(|address| costs.get(address));
    let mut halves = [0; 2];
    for index in 0..executed.len() {
        let before = index.checked_sub(1).and_then(cost);
        let Cycles([low, high]) = cost(index).map(|found| found.on(core, before, cost(index + 1))).unwrap_or_default();
        halves = [halves[0] + low, halves[1] + high];
    }
    (executed.len() as u32, halves.map(|halves: u32| halves.div_ceil(2)))
}

/// The program counter in a line `Trace 0: host [base/counter/flags/flags] function`.
fn address(line: &[u8]) -> Option<u64> {
    let line = line.strip_prefix(b"Trace ")?;
    let start = line.iter().position(|byte| *byte == b'/')? + 1;
    let end = start + line[start..].iter().position(|byte| *byte == b'/')?;
    u64::from_str_radix(std::str::from_utf8(&line[start..end]).ok()?, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::address;

    #[test]
    fn the_program_counter_stands_in_the_middle() {
        let line = b"Trace 0: 0x7f3bac01a480 [00800400/00001bb2/00000010/ff000201] name/of/a/function\n";
        assert_eq!(address(line), Some(0x1bb2));
        assert_eq!(address(b"qemu: fatal: 1/2/3\n"), None);
    }
}
