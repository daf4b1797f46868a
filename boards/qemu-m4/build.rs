//! Lays the linker's files where it finds them.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy("memory.x", out.join("memory.x")).expect("memory.x lies beside this file");
    // cortex-m-rt wants the names of the chip's interrupt handlers; those that nobody defines go to the default one.
    fs::write(out.join("device.x"), "PROVIDE(TIMER0 = DefaultHandler);\n").expect("OUT_DIR can be written");
    // Where the log's strings go: into the ELF file, and not into flash.
    if env::var_os("CARGO_FEATURE_DEFMT").is_some() {
        println!("cargo::rustc-link-arg-bin=log=-Tdefmt.x");
    }
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rerun-if-changed=memory.x");
    println!("cargo::rerun-if-changed=build.rs");
}
