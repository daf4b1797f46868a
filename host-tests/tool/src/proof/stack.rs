//! How deep the stack can get.

use super::{Code, Function};
use std::collections::BTreeMap;
use thiserror::Error;

/// Why there is no bound.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum StackError {
    /// The stack pointer is set to something that is not known from the code.
    #[error("{function} moves the stack pointer by an unknown amount at {address:#x}: {text}")]
    Unknown {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
        /// How.
        text: String,
    },
    /// Two ways to one instruction leave different depths.
    #[error("{function} comes to {address:#x} with different depths of stack")]
    Uneven {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
    },
    /// A function calls itself, if by way of others.
    #[error("{function} is recursive")]
    Recursive {
        /// Which.
        function: String,
    },
    /// A call to what is no function, or through a pointer.
    #[error("{function} calls what is not known at {address:#x}")]
    UnknownCall {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
    },
}

/// The most bytes of stack that a function takes with all it calls.
///
/// # Errors
/// Why there is no bound.
pub fn deepest(code: &Code, function: &Function) -> Result<i64, StackError> {
    visit(code, function, &mut BTreeMap::new())
}

/// `known` holds what was found; `None` while it is still being looked for.
fn visit(code: &Code, function: &Function, known: &mut BTreeMap<u64, Option<i64>>) -> Result<i64, StackError> {
    let name = || function.name.clone();
    match known.get(&function.address) {
        Some(Some(depth)) => return Ok(*depth),
        Some(None) => return Err(StackError::Recursive { function: name() }),
        None => known.insert(function.address, None),
    };
    let mut worst = 0;
    let mut depths = BTreeMap::from([(function.address, 0)]);
    let mut open = vec![function.address];
    while let Some(address) = open.pop() {
        let Some(instruction) = function.instructions.get(&address) else { continue };
        let before = depths[&address];
        let grows = instruction.grows.ok_or_else(|| StackError::Unknown {
            function: name(),
            address,
            text: instruction.text.clone(),
        })?;
        let after = before + grows;
        worst = worst.max(after);
        let unknown = || StackError::UnknownCall { function: name(), address };
        if matches!(instruction.flow, super::Flow::IndirectCall | super::Flow::IndirectJump) {
            return Err(unknown());
        }
        let (next, outside) = function.successors(instruction);
        if let Some(callee) = outside {
            let callee = code.at(callee).ok_or_else(unknown)?;
            worst = worst.max(after + visit(code, callee, known)?);
        }
        // A return that was not taken has taken nothing off.
        let here = if instruction.flow == super::Flow::MaybeReturn { before } else { after };
        for target in next {
            match depths.insert(target, here) {
                None => open.push(target),
                Some(depth) if depth == here => {}
                Some(_) => return Err(StackError::Uneven { function: name(), address: target }),
            }
        }
    }
    known.insert(function.address, Some(worst));
    Ok(worst)
}
