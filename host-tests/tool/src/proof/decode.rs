//! One Thumb-2 instruction: where it leads and what it does to the stack pointer.

use capstone::arch::arm::{ArchMode, ArmCC, ArmInsn};
use capstone::prelude::*;

/// Target of an instruction, apart from the instruction behind it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Flow {
    /// None.
    Next,
    /// Always this address.
    Jump(u64),
    /// This address, or the next instruction.
    Branch(u64),
    /// One of the entries of the table behind it; the parameter is the size of an entry in bytes. Entries count
    /// half-words.
    Table(u64),
    /// A call to this address.
    Call(u64),
    /// A call through a register.
    IndirectCall,
    /// An address in a register.
    IndirectJump,
    /// Back to the caller.
    Return,
    /// Back to the caller, or the next instruction.
    MaybeReturn,
    /// None: it stops the program.
    Trap,
}

/// An instruction.
#[derive(Clone, Debug)]
pub struct Instruction {
    /// Its address.
    pub address: u64,
    /// Its length, bytes.
    pub length: u64,
    /// Its text in assembler syntax.
    pub text: String,
    /// Its target.
    pub flow: Flow,
    /// Bytes by which the stack grows; `None` if unknown.
    pub grows: Option<i64>,
    /// Whether it computes in double precision. Moving a pair of floats as if it were a double is no computing.
    pub double: bool,
}

/// Reads instructions of a core of the M profile.
pub struct Decoder(Capstone);

impl Decoder {
    /// A decoder.
    ///
    /// # Errors
    /// An error of the library.
    pub fn new() -> Result<Self, capstone::Error> {
        let capstone = Capstone::new()
            .arm()
            .mode(ArchMode::Thumb)
            .extra_mode([arch::arm::ArchExtraMode::MClass, arch::arm::ArchExtraMode::V8].into_iter())
            .detail(true)
            .build()?;
        Ok(Self(capstone))
    }

    /// The instructions in some code that holds nothing else; `Err` with the address of the first that is none.
    pub fn decode(&self, code: &[u8], start: u64) -> Result<Vec<Instruction>, u64> {
        let decoded = self.0.disasm_all(code, start).map_err(|_| start)?;
        let mut instructions = Vec::new();
        let mut next = start;
        for found in decoded.iter() {
            instructions.push(self.instruction(found).ok_or(next)?);
            next = found.address() + found.len() as u64;
        }
        if next == start + code.len() as u64 { Ok(instructions) } else { Err(next) }
    }

    fn instruction(&self, found: &capstone::Insn<'_>) -> Option<Instruction> {
        let detail = self.0.insn_detail(found).ok()?;
        let arch = detail.arch_detail();
        let conditional = !matches!(arch.arm()?.cc(), ArmCC::ARM_CC_AL | ArmCC::ARM_CC_INVALID);
        let mnemonic = found.mnemonic()?;
        let operands = found.op_str().unwrap_or_default();
        let kind = kind(found.id().0);
        Some(Instruction {
            address: found.address(),
            length: found.len() as u64,
            text: format!("{mnemonic} {operands}").trim_end().to_owned(),
            flow: flow(kind, mnemonic, operands, conditional)?,
            grows: growth(kind, operands),
            // A comparison names its result, a conversion both kinds.
            double: mnemonic.contains(".f64") && !mnemonic.starts_with("vmov"),
        })
    }
}

/// The instructions that branch or may move the stack pointer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Branch,
    Link,
    LinkRegister,
    Exchange,
    CompareBranch,
    TableBytes,
    TableHalves,
    Push,
    Pop,
    StoreDown,
    StoreUp,
    LoadUp,
    Add,
    Subtract,
    Load,
    Store,
    Trap,
    Other,
}

fn kind(id: u32) -> Kind {
    const KINDS: [(ArmInsn, Kind); 30] = [
        (ArmInsn::ARM_INS_B, Kind::Branch),
        (ArmInsn::ARM_INS_BL, Kind::Link),
        (ArmInsn::ARM_INS_BLX, Kind::LinkRegister),
        (ArmInsn::ARM_INS_BX, Kind::Exchange),
        (ArmInsn::ARM_INS_CBZ, Kind::CompareBranch),
        (ArmInsn::ARM_INS_CBNZ, Kind::CompareBranch),
        (ArmInsn::ARM_INS_TBB, Kind::TableBytes),
        (ArmInsn::ARM_INS_TBH, Kind::TableHalves),
        (ArmInsn::ARM_INS_PUSH, Kind::Push),
        (ArmInsn::ARM_INS_VPUSH, Kind::Push),
        (ArmInsn::ARM_INS_POP, Kind::Pop),
        (ArmInsn::ARM_INS_VPOP, Kind::Pop),
        (ArmInsn::ARM_INS_STMDB, Kind::StoreDown),
        (ArmInsn::ARM_INS_VSTMDB, Kind::StoreDown),
        (ArmInsn::ARM_INS_STM, Kind::StoreUp),
        (ArmInsn::ARM_INS_VSTMIA, Kind::StoreUp),
        (ArmInsn::ARM_INS_LDM, Kind::LoadUp),
        (ArmInsn::ARM_INS_VLDMIA, Kind::LoadUp),
        (ArmInsn::ARM_INS_ADD, Kind::Add),
        (ArmInsn::ARM_INS_ADDW, Kind::Add),
        (ArmInsn::ARM_INS_SUB, Kind::Subtract),
        (ArmInsn::ARM_INS_SUBW, Kind::Subtract),
        (ArmInsn::ARM_INS_LDR, Kind::Load),
        (ArmInsn::ARM_INS_LDRD, Kind::Load),
        (ArmInsn::ARM_INS_STR, Kind::Store),
        (ArmInsn::ARM_INS_STRD, Kind::Store),
        (ArmInsn::ARM_INS_UDF, Kind::Trap),
        (ArmInsn::ARM_INS_TRAP, Kind::Trap),
        (ArmInsn::ARM_INS_BKPT, Kind::Trap),
        (ArmInsn::ARM_INS_SVC, Kind::Trap),
    ];
    KINDS.iter().find(|(known, _)| *known as u32 == id).map_or(Kind::Other, |(_, kind)| *kind)
}

fn flow(kind: Kind, mnemonic: &str, operands: &str, conditional: bool) -> Option<Flow> {
    // The last operand of a branch is where it leads.
    let target = || {
        let word = operands.rsplit(' ').next()?.trim_start_matches("#0x");
        u64::from_str_radix(word, 16).ok()
    };
    let sets_counter = || operands.split([',', ' ', '{', '}']).any(|word| word == "pc");
    Some(match kind {
        Kind::Branch if conditional => Flow::Branch(target()?),
        Kind::Branch => Flow::Jump(target()?),
        Kind::CompareBranch => Flow::Branch(target()?),
        Kind::Link => Flow::Call(target()?),
        Kind::LinkRegister => Flow::IndirectCall,
        Kind::Exchange if operands == "lr" => returns(conditional),
        Kind::Exchange => Flow::IndirectJump,
        Kind::TableBytes => Flow::Table(1),
        Kind::TableHalves => Flow::Table(2),
        Kind::Pop | Kind::LoadUp if sets_counter() => returns(conditional),
        Kind::Load if operands.starts_with("pc, [sp], #") => returns(conditional),
        Kind::Trap => Flow::Trap,
        // Anything else that names the counter first sets it.
        _ if operands.starts_with("pc,") && !mnemonic.starts_with("cmp") => Flow::IndirectJump,
        _ => Flow::Next,
    })
}

const fn returns(conditional: bool) -> Flow {
    if conditional { Flow::MaybeReturn } else { Flow::Return }
}

/// Bytes by which the stack grows.
fn growth(kind: Kind, operands: &str) -> Option<i64> {
    let list = || operands.split_once('{').map_or("", |(_, list)| list.trim_end_matches('}'));
    let bytes = || list().split(", ").map(|register| if register.starts_with('d') { 8 } else { 4 }).sum::<i64>();
    let on_stack = operands.starts_with("sp!");
    match kind {
        Kind::Push => Some(bytes()),
        Kind::Pop => Some(-bytes()),
        Kind::StoreDown if on_stack => Some(bytes()),
        Kind::StoreUp | Kind::LoadUp if on_stack => Some(-bytes()),
        // Through the stack pointer, which stays: no `!`.
        Kind::StoreDown | Kind::StoreUp | Kind::LoadUp => Some(0),
        Kind::Add | Kind::Subtract if operands.starts_with("sp,") => {
            let words: Vec<&str> = operands.split(", ").collect();
            let amount = match words[..] {
                ["sp", last] | ["sp", "sp", last] => number(last)?,
                _ => return None,
            };
            Some(if kind == Kind::Add { -amount } else { amount })
        }
        Kind::Load | Kind::Store => {
            // Written back before, `[sp, #-8]!`, or after, `[sp], #8`.
            if let Some((_, offset)) = operands.split_once("[sp], ") {
                return Some(-number(offset)?);
            }
            match operands.strip_suffix("]!").and_then(|inside| inside.split_once("[sp, ")) {
                Some((_, offset)) => Some(-number(offset)?),
                None => Some(0),
            }
        }
        // Whatever else names the stack pointer first, or writes it back, moves it in a way that is not followed; a
        // comparison would be harmless, and compilers make none.
        _ if operands.starts_with("sp,") || operands.contains("[sp") && operands.contains("]!") || on_stack => None,
        _ => Some(0),
    }
}

/// `#0x10`, `#-8`, `#4`.
fn number(word: &str) -> Option<i64> {
    let word = word.strip_prefix('#')?;
    let (sign, digits) = word.strip_prefix('-').map_or((1, word), |digits| (-1, digits));
    let value = match digits.strip_prefix("0x") {
        Some(hexadecimal) => i64::from_str_radix(hexadecimal, 16).ok()?,
        None => digits.parse().ok()?,
    };
    Some(sign * value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a few half-words, at address 0x1000.
    fn decoded(halves: &[u16]) -> Instruction {
        let code: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
        Decoder::new().unwrap().decode(&code, 0x1000).unwrap().swap_remove(0)
    }

    // Encodings by hand from the Armv7-M Architecture Reference Manual, chapter A7.
    #[test]
    fn branches_lead_where_the_manual_says() {
        assert_eq!(decoded(&[0xe7fe]).flow, Flow::Jump(0x1000)); // B .
        assert_eq!(decoded(&[0xd0fe]).flow, Flow::Branch(0x1000)); // BEQ .
        assert_eq!(decoded(&[0xb108]).flow, Flow::Branch(0x1006)); // CBZ r0, .+6
        assert_eq!(decoded(&[0xf000, 0xf802]).flow, Flow::Call(0x1008)); // BL .+8
        assert_eq!(decoded(&[0x4770]).flow, Flow::Return); // BX lr
        assert_eq!(decoded(&[0xbd10]).flow, Flow::Return); // POP {r4, pc}
        assert_eq!(decoded(&[0xbc10]).flow, Flow::Next); // POP {r4}
        assert_eq!(decoded(&[0x4798]).flow, Flow::IndirectCall); // BLX r3
        assert_eq!(decoded(&[0x4718]).flow, Flow::IndirectJump); // BX r3
        assert_eq!(decoded(&[0x469f]).flow, Flow::IndirectJump); // MOV pc, r3
        assert_eq!(decoded(&[0xe8df, 0xf000]).flow, Flow::Table(1)); // TBB [pc, r0]
        assert_eq!(decoded(&[0xe8df, 0xf010]).flow, Flow::Table(2)); // TBH [pc, r0, LSL #1]
        assert_eq!(decoded(&[0xf85d, 0xfb04]).flow, Flow::Return); // LDR pc, [sp], #4
        assert_eq!(decoded(&[0xdefe]).flow, Flow::Trap); // UDF #0xfe
    }

    #[test]
    fn the_stack_grows_by_what_the_manual_says() {
        assert_eq!(decoded(&[0xb510]).grows, Some(8)); // PUSH {r4, lr}
        assert_eq!(decoded(&[0xbd10]).grows, Some(-8)); // POP {r4, pc}
        assert_eq!(decoded(&[0xb084]).grows, Some(16)); // SUB sp, #16
        assert_eq!(decoded(&[0xb004]).grows, Some(-16)); // ADD sp, #16
        assert_eq!(decoded(&[0xf5ad, 0x7d80]).grows, Some(256)); // SUB.W sp, sp, #256
        assert_eq!(decoded(&[0xed2d, 0x8b04]).grows, Some(16)); // VPUSH {d8, d9}
        assert_eq!(decoded(&[0xecbd, 0x8b04]).grows, Some(-16)); // VPOP {d8, d9}
        assert_eq!(decoded(&[0xed2d, 0x8a03]).grows, Some(12)); // VPUSH {s16-s18}
        assert_eq!(decoded(&[0xe92d, 0x47f0]).grows, Some(32)); // PUSH.W {r4-r10, lr}
        assert_eq!(decoded(&[0xf84d, 0xed04]).grows, Some(4)); // STR lr, [sp, #-4]!
        assert_eq!(decoded(&[0xf85d, 0xeb04]).grows, Some(-4)); // LDR lr, [sp], #4
        assert_eq!(decoded(&[0xe96d, 0x0102]).grows, Some(8)); // STRD r0, r1, [sp, #-8]!
        assert_eq!(decoded(&[0xe89d, 0x0007]).grows, Some(0)); // LDM.W sp, {r0-r2}
        assert_eq!(decoded(&[0xe88d, 0x0007]).grows, Some(0)); // STM.W sp, {r0-r2}
        assert_eq!(decoded(&[0xe8bd, 0x0007]).grows, Some(-12)); // POP.W {r0-r2}
        assert_eq!(decoded(&[0xec9d, 0x0a02]).grows, Some(0)); // VLDM sp, {s0, s1}
        assert_eq!(decoded(&[0x46a5]).grows, None); // MOV sp, r4
        assert_eq!(decoded(&[0x9001]).grows, Some(0)); // STR r0, [sp, #4]
        assert_eq!(decoded(&[0xa801]).grows, Some(0)); // ADD r0, sp, #4
    }

    #[test]
    fn double_precision_is_seen_and_single_is_not() {
        assert!(decoded(&[0xee20, 0x0b01]).double); // VMUL.F64 d0, d0, d1
        assert!(decoded(&[0xeeb7, 0x0ac0]).double); // VCVT.F64.F32 d0, s0
        assert!(!decoded(&[0xee20, 0x0a20]).double); // VMUL.F32 s0, s0, s1
        assert!(!decoded(&[0xed90, 0x0b00]).double); // VLDR d0, [r0]
    }
}
