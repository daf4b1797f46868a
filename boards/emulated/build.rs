//! Says which board the image is for, lays the linker's files where it finds them, and says which body and settings go
//! into the image.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// A board's name, the compiler's name for its kind of core, and the board's memory map.
const BOARDS: [[&str; 3]; 6] = [
    ["m4", "thumbv7em-none-eabihf", "../../memory.x"],
    ["m7", "thumbv7em-none-eabihf", "../../memory.x"],
    ["m33", "thumbv8m.main-none-eabihf", "memory-m33.x"],
    ["m0", "thumbv6m-none-eabi", "../../memory.x"],
    ["riscv", "riscv32imafc-unknown-none-elf", "riscv.x"],
    ["riscv-imc", "riscv32imc-unknown-none-elf", "riscv.x"],
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let [name, .., memory_map] = board();
    println!("cargo::rustc-check-cfg=cfg(board, values(\"m4\", \"m7\", \"m33\", \"m0\", \"riscv\", \"riscv-imc\"))");
    println!("cargo::rustc-cfg=board=\"{name}\"");
    lay_out_for_the_linker(memory_map);
    choose("PALPATE_BODY", "../bodies/capped_box.rs");
    choose("PALPATE_SETTINGS", "settings.rs");
    choose("PALPATE_COLD", "../bodies/capped_box.palp");
}

/// The board that the environment names, which `cargo --config m7.toml …` sees to.
fn board() -> [&'static str; 3] {
    println!("cargo::rerun-if-env-changed=PALPATE_BOARD");
    let name = env::var("PALPATE_BOARD").unwrap_or_else(|_| "m4".to_owned());
    let board = BOARDS.into_iter().find(|[known, ..]| *known == name);
    let board = board.unwrap_or_else(|| {
        panic!("PALPATE_BOARD={name}: no such board; there are m4, m7, m33, m0, riscv and riscv-imc")
    });
    let target = env::var("TARGET").expect("cargo sets TARGET");
    assert!(board[1] == target, "PALPATE_BOARD={name} is for {}, not {target}: cargo --config {name}.toml", board[1]);
    board
}

fn lay_out_for_the_linker(memory_map: &str) {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    println!("cargo::rerun-if-changed={memory_map}");
    println!("cargo::rustc-link-search={}", out.display());
    // RISC-V has its whole script here, and the others that of cortex-m-rt.
    let file = if memory_map == "riscv.x" { "link.x" } else { "memory.x" };
    fs::copy(memory_map, out.join(file)).unwrap_or_else(|error| panic!("{memory_map}: {error}"));
    // cortex-m-rt wants the names of the chip's interrupt handlers; those that nobody defines go to the default one.
    fs::write(out.join("device.x"), "PROVIDE(TIMER0 = DefaultHandler);\n").expect("OUT_DIR can be written");
    // Where the log's strings go: into the ELF file, and not into flash.
    if env::var_os("CARGO_FEATURE_DEFMT").is_some() {
        println!("cargo::rustc-link-arg-bin=log=-Tdefmt.x");
    }
}

/// Passes on the file that the environment names, or the default, as an absolute path for `include!`.
fn choose(variable: &str, default: &str) {
    println!("cargo::rerun-if-env-changed={variable}");
    let chosen = env::var_os(variable).map_or_else(|| Path::new(default).to_path_buf(), PathBuf::from);
    let absolute = chosen.canonicalize().unwrap_or_else(|error| panic!("{variable}: {}: {error}", chosen.display()));
    println!("cargo::rerun-if-changed={}", absolute.display());
    println!("cargo::rustc-env={variable}_FILE={}", absolute.display());
}
