//! The instructions that a call executes, in their order, as the emulator logs them.

use super::model::{Core, Cost, Cycles};
use super::{Calls, PUSH, Root};
use crate::firmware::{Program, SetUpError};
use crate::proof::{Code, CodeError, Flow, Tree};
use std::collections::{BTreeMap, HashMap, HashSet};
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
    /// A function that is never called.
    #[error("{0} was not called")]
    NotCalled(&'static str),
}

/// Cost of an instruction, its target, and the address behind it.
type Costs = HashMap<u64, (Cost, Flow, u64)>;

/// A call that is being followed.
struct Window {
    root: u64,
    /// Calls within it that have not come back. A jump to another function leaves it to that one to come back.
    depth: u32,
    executed: Vec<u64>,
}

/// Runs a program that counts until each of these roots was called often enough, and returns the instructions and cycles
/// of the calls on its core.
///
/// # Errors
/// A program that cannot be run or read.
pub fn estimate(program: &Program, core: Core, roots: &[Root]) -> Result<Vec<(Root, Calls)>, TraceError> {
    let code = Code::read(&program.image.elf)?;
    let (mut functions, mut wanted) = (BTreeMap::new(), Vec::new());
    let mut starts = HashSet::new();
    for root in roots {
        let function = code.named(root.function)?;
        starts.insert(function.address);
        wanted.push((function.address, root.skip + root.take));
        functions.extend(Tree::new(&code, function).functions().map(|function| (function.address, function)));
    }
    let costs: Costs = functions
        .values()
        .flat_map(|function| &function.instructions)
        .map(|(address, instruction)| {
            (*address, (Cost::of(instruction), instruction.flow.clone(), address + instruction.length))
        })
        .collect();
    let ranges: Vec<(u64, u64)> = functions.values().map(|function| (function.address, function.size)).collect();

    // Of a rigid body there is none.
    let push = code.functions().find(|function| function.name == PUSH).map(|function| function.address);

    let mut all: HashMap<u64, Vec<(u32, [u32; 2], bool)>> = HashMap::new();
    let (mut open, mut finished, mut perhaps) = (Vec::<Window>::new(), Vec::new(), None);
    let mut child = program.trace(&ranges)?;
    let log = child.stderr.take().ok_or_else(|| io::Error::other("the emulator has none"))?;
    let mut log = BufReader::with_capacity(1 << 20, log);
    let mut line = Vec::new();
    let mut block: Option<u64> = None;
    'log: loop {
        line.clear();
        if log.read_until(b'\n', &mut line)? == 0 {
            break;
        }
        let Some(start) = address(&line).filter(|start| costs.contains_key(start)) else { continue };
        let Some(from) = block.replace(start) else { continue };
        for address in straight(&costs, from, start) {
            let Some((_, flow, next)) = costs.get(&address) else { continue };
            // One that may return has done so if something else than the next comes.
            if let Some(next) = perhaps.take()
                && next != address
            {
                returned(&mut open, &mut finished);
            }
            if starts.contains(&address) && open.iter().all(|window| window.root != address) {
                open.push(Window { root: address, depth: 0, executed: Vec::new() });
            }
            for window in &mut open {
                window.executed.push(address);
            }
            match flow {
                Flow::Call(_) => open.iter_mut().for_each(|window| window.depth += 1),
                Flow::Return => returned(&mut open, &mut finished),
                Flow::MaybeReturn => perhaps = Some(*next),
                _ => {}
            }
            if finished.is_empty() {
                continue;
            }
            for window in finished.drain(..) {
                let (instructions, cycles) = spent(core, &costs, &window.executed);
                let is_pushed = push.is_some_and(|push| window.executed.contains(&push));
                all.entry(window.root).or_default().push((instructions, cycles, is_pushed));
            }
            if wanted.iter().all(|(root, calls)| all.get(root).is_some_and(|found| found.len() >= *calls)) {
                child.kill()?;
                break 'log;
            }
        }
    }
    child.wait()?;
    roots
        .iter()
        .map(|root| {
            let address = code.named(root.function)?.address;
            let mut calls = Calls::default();
            let found = all.get(&address).into_iter().flatten();
            for (instructions, [low, high], is_pushed) in found.skip(root.skip).take(root.take) {
                calls.instructions.push(*instructions);
                calls.is_pushed.push(*is_pushed);
                calls.cycles[0].push(*low);
                calls.cycles[1].push(*high);
            }
            if calls.instructions.is_empty() { Err(TraceError::NotCalled(root.function)) } else { Ok((*root, calls)) }
        })
        .collect()
}

/// The emulator's blocks end where this many bytes do, if not before: behind the last instruction that starts within
/// them, or before it where it reaches beyond and is not the block's first.
const PAGE: u64 = 1024;

/// The instructions of a block and the ones behind it up to where it leads: it ends with one that may lead elsewhere,
/// or at the end of a page, where the next block goes on.
fn straight(costs: &Costs, from: u64, then: u64) -> Vec<u64> {
    let mut executed = Vec::new();
    let mut at = from;
    while let Some((_, flow, next)) = costs.get(&at) {
        executed.push(at);
        let ends_page = at / PAGE != then / PAGE || (then + 2).is_multiple_of(PAGE);
        let goes_on = *next == then && ends_page;
        if *flow != Flow::Next || goes_on {
            break;
        }
        at = *next;
    }
    executed
}

/// One function came back: the calls that this ends are finished.
fn returned(open: &mut Vec<Window>, finished: &mut Vec<Window>) {
    let is_over = |window: &mut Window| window.depth == 0;
    finished.extend(open.extract_if(.., is_over));
    open.iter_mut().for_each(|window| window.depth -= 1);
}

/// Instructions and cycles of a call.
fn spent(core: Core, costs: &Costs, executed: &[u64]) -> (u32, [u32; 2]) {
    let cost = |index: usize| executed.get(index).and_then(|address| costs.get(address)).map(|(cost, ..)| cost);
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
    use super::{Costs, address, straight};
    use crate::cycles::model::Cost;
    use crate::proof::{Flow, Instruction};

    #[test]
    fn a_block_ends_at_a_page_whose_last_instruction_reaches_beyond() {
        // Four instructions of two half-words, the last of which calls.
        let costs: Costs = (0..4)
            .map(|index| {
                let (at, flow) = (0x3fa + 4 * index, if index == 3 { Flow::Call(0) } else { Flow::Next });
                let text = "nop.w".to_owned();
                let instruction =
                    Instruction { address: at, length: 4, text, flow: flow.clone(), grows: Some(0), double: false };
                (at, (Cost::of(&instruction), flow, at + 4))
            })
            .collect();
        // Not the first: the block ends before it. The first: it ends behind it.
        assert_eq!(straight(&costs, 0x3fa, 0x3fe), [0x3fa]);
        assert_eq!(straight(&costs, 0x3fe, 0x402), [0x3fe]);
        // The call within a page is the end, wherever it leads.
        assert_eq!(straight(&costs, 0x402, 0x402), [0x402, 0x406]);
    }

    #[test]
    fn the_program_counter_stands_in_the_middle() {
        let line = b"Trace 0: 0x7f3bac01a480 [00800400/00001bb2/00000010/ff000201] name/of/a/function\n";
        assert_eq!(address(line), Some(0x1bb2));
        assert_eq!(address(b"qemu: fatal: 1/2/3\n"), None);
    }
}
