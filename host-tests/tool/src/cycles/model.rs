//! Cost of an instruction on a core.
//!
//! Cortex-M4F: Arm's *Cortex-M4 Technical Reference Manual*, "Processor instruction timings" and "FPU instruction set".
//! Arm publishes no such table of the Cortex-M7; its range runs from two instructions in every cycle and every branch
//! foreseen to one at a time and no conditional branch foreseen.

use crate::proof::{Flow, Instruction};

/// A core with a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// Cortex-M4F.
    M4,
    /// Cortex-M7.
    M7,
}

/// The two ends of the range, in half cycles: two instructions may share one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycles(pub [u32; 2]);

/// Cycles of a division and of a square root of floats, on either core.
const FLOAT_DIVISION: u32 = 14;
/// Cycles of a fused multiply-add.
const FLOAT_MULTIPLY_ADD: u32 = 3;
/// Range of cycles of an integer division, depending on its operands.
const DIVISION: [u32; 2] = [2, 12];
/// Filling the M4's pipeline again.
const M4_REFILL: [u32; 2] = [1, 3];
/// Filling the M7's pipeline of six stages again.
const M7_REFILL: u32 = 6;
/// Cycles until the M7's next instruction can have the result of a float operation, beyond the one it took.
const M7_FLOAT_STALL: u32 = 2;

/// Properties of an instruction that determine its cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cost {
    kind: Kind,
    /// Words moved from or to memory.
    words: u32,
    /// The float register that it computes.
    result: Option<String>,
    /// The float registers named behind the first.
    operands: Vec<String>,
    /// Whether it may lead elsewhere, and whether only under a condition.
    branches: Option<bool>,
    address: u64,
    next: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Simple,
    IfThen,
    Load,
    Store,
    Divide,
    FloatDivide,
    FloatMultiplyAdd,
    TableBranch,
}

impl Cost {
    /// Of an instruction.
    pub fn of(instruction: &Instruction) -> Self {
        let (mnemonic, operands) = instruction.text.split_once(' ').unwrap_or((&instruction.text, ""));
        let kind = kind(mnemonic);
        let registers: Vec<&str> =
            operands.split([',', '{', '}', '[', ']', '!']).map(str::trim).filter(|word| !word.is_empty()).collect();
        let computes = mnemonic.starts_with('v')
            && !["vld", "vst", "vpush", "vpop", "vmrs"].iter().any(|m| mnemonic.starts_with(m));
        // A comparison only reads; a multiply-add reads what it writes, too.
        let reads_first = mnemonic.starts_with("vcmp") || mnemonic.starts_with("vst") || kind == Kind::FloatMultiplyAdd;
        let is_float = |word: &&&str| word.starts_with('s') && word[1..].parse::<u8>().is_ok();
        Self {
            kind,
            words: words(mnemonic, operands, &registers),
            result: registers
                .first()
                .filter(|first| computes && !mnemonic.starts_with("vcmp") && is_float(first))
                .map(|&first| first.to_owned()),
            operands: registers
                .iter()
                .skip(usize::from(!reads_first))
                .filter(is_float)
                .map(|&word| word.to_owned())
                .collect(),
            branches: match instruction.flow {
                Flow::Next | Flow::Trap => None,
                Flow::Branch(_) | Flow::MaybeReturn => Some(true),
                _ => Some(false),
            },
            address: instruction.address,
            next: instruction.address + instruction.length,
        }
    }

    /// The cycles of this instruction between the ones executed before and after it.
    pub fn on(&self, core: Core, before: Option<&Self>, after: Option<&Self>) -> Cycles {
        let taken = self.branches.is_some() && after.is_none_or(|after| after.address != self.next);
        // Its result is wanted at once.
        let stalls = match (&self.result, after) {
            (Some(result), Some(after)) => after.operands.contains(result),
            _ => false,
        };
        match core {
            Core::M4 => self.on_m4(before, taken, stalls),
            Core::M7 => self.on_m7(taken, stalls),
        }
    }

    fn on_m4(&self, before: Option<&Self>, taken: bool, stalls: bool) -> Cycles {
        let follows_memory = before.is_some_and(|before| matches!(before.kind, Kind::Load | Kind::Store));
        let [low, high] = match self.kind {
            Kind::Simple => [1, 1],
            // May be folded into the instruction before it.
            Kind::IfThen => [0, 1],
            Kind::Load if self.words == 1 => [if follows_memory { 1 } else { 2 }, 2],
            // The write buffer takes it, or is full.
            Kind::Store if self.words == 1 => [1, 2],
            Kind::Load | Kind::Store => [1 + self.words; 2],
            Kind::Divide => DIVISION,
            Kind::FloatDivide => [FLOAT_DIVISION; 2],
            Kind::FloatMultiplyAdd => [FLOAT_MULTIPLY_ADD; 2],
            Kind::TableBranch => [2, 2],
        };
        let refill = if taken { M4_REFILL } else { [0; 2] };
        let stall = u32::from(stalls);
        Cycles([2 * (low + refill[0] + stall), 2 * (high + refill[1] + stall)])
    }

    fn on_m7(&self, taken: bool, stalls: bool) -> Cycles {
        // Half cycles at the low end: paired. Two words in a cycle over the 64 bit of its memory.
        let (low, high) = match self.kind {
            Kind::Simple | Kind::IfThen => (1, 1),
            Kind::Load if self.words == 1 => (1, 2),
            Kind::Store if self.words == 1 => (1, 1),
            Kind::Load | Kind::Store => (self.words, 1 + self.words),
            Kind::Divide => (2 * DIVISION[0], DIVISION[1]),
            Kind::FloatDivide => (2 * FLOAT_DIVISION, FLOAT_DIVISION),
            Kind::FloatMultiplyAdd => (1, FLOAT_MULTIPLY_ADD),
            Kind::TableBranch => (2, 2 + M7_REFILL),
        };
        let unforeseen = match self.branches {
            Some(true) => M7_REFILL,
            Some(false) if taken => 1,
            _ => 0,
        };
        let stall = if stalls { M7_FLOAT_STALL } else { 0 };
        Cycles([low, 2 * (high + unforeseen + stall)])
    }
}

fn kind(mnemonic: &str) -> Kind {
    let starts = |beginnings: &[&str]| beginnings.iter().any(|beginning| mnemonic.starts_with(beginning));
    if starts(&["vdiv", "vsqrt"]) {
        Kind::FloatDivide
    } else if starts(&["vmla", "vmls", "vnmla", "vnmls", "vfma", "vfms", "vfnma", "vfnms"]) {
        Kind::FloatMultiplyAdd
    } else if starts(&["tbb", "tbh"]) {
        Kind::TableBranch
    } else if starts(&["udiv", "sdiv"]) {
        Kind::Divide
    } else if starts(&["ldr", "ldm", "pop", "vldr", "vldm", "vpop"]) {
        Kind::Load
    } else if starts(&["str", "stm", "push", "vstr", "vstm", "vpush"]) {
        Kind::Store
    } else if starts(&["it"]) {
        Kind::IfThen
    } else {
        Kind::Simple
    }
}

/// Words that a load or a store moves.
fn words(mnemonic: &str, operands: &str, registers: &[&str]) -> u32 {
    if let Some(list) = operands.split_once('{').and_then(|(_, list)| list.split_once('}')) {
        let each = |name: &str| if name.trim().starts_with('d') { 2 } else { 1 };
        return list.0.split(',').map(each).sum();
    }
    let first_is_double = registers.first().is_some_and(|first| first.starts_with('d'));
    if mnemonic.starts_with("ldrd") || mnemonic.starts_with("strd") || first_is_double { 2 } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instruction(address: u64, text: &str, flow: Flow) -> Instruction {
        Instruction { address, length: 2, text: text.to_owned(), flow, grows: Some(0), double: false }
    }

    /// The M4's cycles of a straight run, both ends.
    fn run(core: Core, texts: &[&str]) -> [u32; 2] {
        let costs: Vec<Cost> =
            texts.iter().enumerate().map(|(i, text)| Cost::of(&instruction(2 * i as u64, text, Flow::Next))).collect();
        let mut sum = [0; 2];
        for (i, cost) in costs.iter().enumerate() {
            let Cycles([low, high]) = cost.on(core, i.checked_sub(1).map(|i| &costs[i]), costs.get(i + 1));
            sum = [sum[0] + low, sum[1] + high];
        }
        sum.map(|halves| halves.div_ceil(2))
    }

    #[test]
    fn the_m4_takes_what_its_manual_says() {
        assert_eq!(run(Core::M4, &["vadd.f32 s0, s1, s2", "vmul.f32 s3, s4, s5"]), [2, 2]);
        // The second wants the first's result.
        assert_eq!(run(Core::M4, &["vadd.f32 s0, s1, s2", "vmul.f32 s3, s0, s5"]), [3, 3]);
        assert_eq!(run(Core::M4, &["vdiv.f32 s0, s1, s2"]), [14, 14]);
        assert_eq!(run(Core::M4, &["vldr s0, [r0]", "vldr s1, [r0, #4]"]), [3, 4]);
        assert_eq!(run(Core::M4, &["vpush {d8, d9}", "push {r4, r5, lr}"]), [9, 9]);
        assert_eq!(run(Core::M4, &["ldrd r0, r1, [sp]"]), [3, 3]);
        // Writing s0 again wants nothing.
        assert_eq!(run(Core::M4, &["vadd.f32 s0, s1, s2", "vmov.f32 s0, s3"]), [2, 2]);
        assert_eq!(run(Core::M4, &["vadd.f32 s0, s1, s2", "vcmp.f32 s0, s3"]), [3, 3]);
    }

    #[test]
    fn a_branch_costs_a_refill_only_where_it_is_taken() {
        let branch = Cost::of(&instruction(0, "beq #0x20", Flow::Branch(0x20)));
        let [on, off] = [2, 0x20].map(|at| Cost::of(&instruction(at, "movs r0, #0", Flow::Next)));
        assert_eq!(branch.on(Core::M4, None, Some(&on)), Cycles([2, 2]));
        assert_eq!(branch.on(Core::M4, None, Some(&off)), Cycles([4, 8]));
        assert_eq!(branch.on(Core::M7, None, Some(&off)), Cycles([1, 14]));
    }

    #[test]
    fn the_m7_takes_two_at_once_or_one_after_the_other() {
        assert_eq!(run(Core::M7, &["adds r0, r0, r1", "adds r2, r2, r3"]), [1, 2]);
        assert_eq!(run(Core::M7, &["vmul.f32 s0, s1, s2", "vadd.f32 s3, s0, s4"]), [1, 4]);
    }
}
