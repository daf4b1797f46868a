//! What can be proved of an image from its machine code alone, whatever the compiler made of the source.
//!
//! The whole call tree of a function is read: each instruction, each branch, each call. What cannot be followed (a call
//! through a pointer, a jump into the middle of another function, a stack pointer set from a register) is itself a
//! finding, never passed over.

mod decode;
mod flow;
mod image;
mod lines;
mod loop_list;
mod parts;
mod stack;
mod tree;

pub use decode::{Flow, Instruction};
pub use flow::Loop;
pub use image::{Code, CodeError, Function};
pub use lines::{Lines, Place};
pub use loop_list::{LoopEntry, LoopList};
pub use parts::flash_by_part;
pub use stack::{StackError, deepest};
pub use tree::{Finding, Tree, is_double_routine};
