//! Whether C is compiled here, and what of it.

use palpate::body::{Body, BodyBuffer, Edge, Effort, Face, FileHead};
use palpate_tool::firmware::Progress;
use palpate_tool::in_c::{self, WITH_C};
use palpate_tool::repository;
use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{env, fs};

/// Whether a C compiler is to be used. If not, that is said.
pub fn is_wanted(test: &str) -> bool {
    let wanted = env::var_os(WITH_C).is_some();
    if !wanted {
        // Past the test harness, which would swallow it, and in one piece.
        let line =
            format!("LEFT OUT {test}: it needs a C compiler for the boards; `cargo palpate test --c` sets it up\n");
        let _ = stderr().write_all(line.as_bytes());
    }
    wanted
}

/// One build at a time: cargo would wait for its own lock, and say so.
pub fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The library for a core.
pub fn library(core: in_c::Core) -> PathBuf {
    let _alone = alone();
    in_c::library(core, &Progress::new()).expect("the library builds")
}

/// A file of the C crate.
pub fn file(name: &str) -> PathBuf {
    in_c::folder().expect("in the repository").join(name)
}

/// The file of the capped box.
pub fn capped_box() -> PathBuf {
    repository::root().expect("in the repository").join("boards/bodies/capped_box.palp")
}

/// The same as the library has it, for Rust to feel.
pub fn with_capped_box<T>(then: impl FnOnce(&Body<'_>) -> T) -> T {
    let bytes = fs::read(capped_box()).expect("the body");
    // Words, so that they are aligned.
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
    let bytes: &[u8] = bytemuck::cast_slice(&words);
    let head = FileHead::of(bytes).expect("a body's file");
    let (mut faces, mut edges) = (vec![Face::VACANT; head.faces], vec![Edge::VACANT; head.edges]);
    let body = Body::from_bytes(bytes, BodyBuffer { faces: &mut faces, edges: &mut edges }).expect("a body");
    // As the library for C has it.
    then(&body.with_effort(Effort::ONE))
}

/// A program of the host from a source of the C crate, linked with the library.
pub fn program(source: &str, folder: &Path, options: &[String]) -> Command {
    let mut gcc = in_c::compiler(in_c::Core::Host, "gcc").expect("in the repository");
    let made = folder.join("program");
    gcc.args(["-std=c11"])
        .args(options)
        .arg(file(source))
        .arg(library(in_c::Core::Host))
        .args(["-lm", "-o"])
        .arg(&made);
    run(&mut gcc);
    Command::new(made)
}

/// Runs a program to its end and gives what it printed.
pub fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    assert!(output.status.success(), "{command:?}\n{said}");
    said
}
