//! Debian's Rust for the boards: its packages bring a compiler and the library's source, but no library for their
//! targets. That is built once and kept in a cache.

use super::process::{apt_install, existing, output};
use super::way::{Way, has_core};
use super::{Progress, SetUpError, without_outer_cargo};
use crate::cache;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

pub(super) const RUSTC: &str = "/usr/bin/rustc";
pub(super) const CARGO: &str = "/usr/bin/cargo";
pub(super) const CARGO_CLIPPY: &str = "/usr/bin/cargo-clippy";
/// The minimum minor version of Rust 1 that compiles the library.
const LEAST_MINOR: u32 = 88;
/// Part of the stamp: raise it when this file lays the cache out differently.
const LAYOUT: u32 = 1;

/// Whether nothing is missing and the cache holds the library.
pub(super) fn is_at_hand(target: &str) -> bool {
    let (Some(compiler), Some(_), Ok(cache)) = (Compiler::find(), find_linker(target), cache_folder()) else {
        return false;
    };
    is_built(target, &compiler.sysroot(&cache, target), &compiler.stamp())
}

/// Installs the missing packages and builds the library, unless the cache holds it.
pub(super) fn set_up(target: &str, progress: &Progress) -> Result<Way, SetUpError> {
    install_missing(target, progress)?;
    let missing =
        |what: &str| SetUpError::NoToolchain(format!("{what} is still missing after installing the packages"));
    let compiler = Compiler::find().ok_or_else(|| missing("a recent /usr/bin/rustc with its library's source"))?;
    let linker = find_linker(target).ok_or_else(|| missing("the linker lld"))?;
    let (sysroot, stamp) = (compiler.sysroot(&cache_folder()?, target), compiler.stamp());
    if !is_built(target, &sysroot, &stamp) {
        let what = format!("building the library for {target}, once, about 20 s, into {}", sysroot.display());
        progress.during(&what, || build(target, &sysroot, &stamp))?;
    }
    Ok(Way::Debian { sysroot, linker })
}

/// Installs Debian's clippy if it is missing.
pub(super) fn set_up_clippy(progress: &Progress) -> Result<(), SetUpError> {
    if Path::new(CARGO_CLIPPY).exists() {
        return Ok(());
    }
    apt_install(&["rust-web-clippy"], progress).map_err(SetUpError::NoToolchain)
}

fn install_missing(target: &str, progress: &Progress) -> Result<(), SetUpError> {
    let mut packages = Vec::new();
    if Compiler::find().is_none() {
        packages.extend(["rustc-web", "cargo-web", "rust-web-src"]);
    }
    if find_linker(target).is_none() {
        packages.push("lld-22");
    }
    if packages.is_empty() {
        return Ok(());
    }
    apt_install(&packages, progress).map_err(|error| {
        SetUpError::NoToolchain(format!("{error}\nwith rustup: rustup target add {target}\nwith Debian: see above"))
    })
}

/// The compiler of the packages.
struct Compiler {
    /// All that it says about its version.
    version: String,
    /// The release, such as `1.96.0`.
    release: String,
}

impl Compiler {
    /// The compiler, if it is recent enough and its library's source and cargo are there.
    fn find() -> Option<Self> {
        existing(CARGO)?;
        let rustc = |arguments: &[&str]| output(without_outer_cargo(&mut Command::new(RUSTC)).args(arguments)).ok();
        let version = rustc(&["-vV"])?;
        let release = version.lines().find_map(|line| line.strip_prefix("release: "))?.to_owned();
        let minor: u32 = release.split('.').nth(1)?.parse().ok()?;
        let source =
            Path::new(rustc(&["--print", "sysroot"])?.trim()).join("lib/rustlib/src/rust/library/core/src/lib.rs");
        (minor >= LEAST_MINOR && source.exists()).then_some(Self { version, release })
    }

    /// Where the library for a target lies in the cache.
    fn sysroot(&self, cache: &Path, target: &str) -> PathBuf {
        cache.join(format!("debian-rust-{}-{target}", self.release))
    }

    /// The stamp: names this compiler and this layout of the cache.
    fn stamp(&self) -> String {
        format!("layout {LAYOUT}\n{}", self.version)
    }
}

/// The linker of Debian's newest LLVM for a target.
fn find_linker(target: &str) -> Option<PathBuf> {
    let linker = if target.starts_with("wasm32") { "bin/wasm-ld" } else { "bin/ld.lld" };
    let versions = fs::read_dir("/usr/lib").ok()?.flatten().filter_map(|entry| {
        let version: u32 = entry.file_name().to_str()?.strip_prefix("llvm-")?.parse().ok()?;
        Some((version, existing(entry.path().join(linker))?))
    });
    versions.max().map(|(_, linker)| linker)
}

/// The cache, by its whole path.
fn cache_folder() -> Result<PathBuf, SetUpError> {
    let folder =
        cache::folder().ok_or_else(|| SetUpError::NoToolchain("no cache folder: set PALPATE_CACHE".to_owned()))?;
    // rustc runs elsewhere: the path must not depend on where this program was started.
    std::path::absolute(&folder).map_err(SetUpError::io(folder.display()))
}

fn library_folder(target: &str, sysroot: &Path) -> PathBuf {
    sysroot.join("lib/rustlib").join(target).join("lib")
}

fn is_built(target: &str, sysroot: &Path, stamp: &str) -> bool {
    fs::read_to_string(sysroot.join("stamp")).is_ok_and(|found| found == stamp)
        && has_core(&library_folder(target, sysroot))
}

/// Builds the library in a folder of its own and moves it into place whole: an interrupted build leaves nothing that
/// could be taken for a library.
fn build(target: &str, sysroot: &Path, stamp: &str) -> Result<(), SetUpError> {
    let cache = sysroot.parent().unwrap_or(sysroot);
    fs::create_dir_all(cache).map_err(SetUpError::io(cache.display()))?;
    let work =
        tempfile::Builder::new().prefix("building-").tempdir_in(cache).map_err(SetUpError::io(cache.display()))?;
    let finished = work.path().join("sysroot");
    let library = library_folder(target, &finished);
    compile(target, work.path(), &library)?;
    fs::write(finished.join("stamp"), stamp).map_err(SetUpError::io(finished.display()))?;
    if sysroot.exists() {
        fs::remove_dir_all(sysroot).map_err(SetUpError::io(sysroot.display()))?;
    }
    match fs::rename(&finished, sysroot) {
        // Another process was quicker.
        Err(_) if is_built(target, sysroot, stamp) => Ok(()),
        moved => moved.map_err(SetUpError::io(sysroot.display())),
    }
}

/// Compiles the library by way of an empty package that needs it, and copies what came of it.
fn compile(target: &str, work: &Path, library: &Path) -> Result<(), SetUpError> {
    const MANIFEST: &str = "[package]\nname = \"seed\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\
                            [lib]\npath = \"lib.rs\"\n[profile.release]\ndebug = 1\n[workspace]\n";
    let seed = work.join("seed");
    fs::create_dir_all(&seed).map_err(SetUpError::io(seed.display()))?;
    fs::write(seed.join("Cargo.toml"), MANIFEST).map_err(SetUpError::io(seed.display()))?;
    fs::write(seed.join("lib.rs"), "#![no_std]\n").map_err(SetUpError::io(seed.display()))?;
    // Building the library is what the compiler calls unstable; what it gives is the same library that rustup ships.
    // Bitcode for link-time optimisation; "unmarked" so that it passes for the compiler's own.
    let mut cargo = Command::new(CARGO);
    output(
        without_outer_cargo(&mut cargo)
            .env_remove("RUSTUP_TOOLCHAIN")
            .env("RUSTC", RUSTC)
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTFLAGS", "-Cembed-bitcode=yes -Zforce-unstable-if-unmarked")
            .current_dir(&seed)
            .args(["build", "--release", "--target", target, "--target-dir", "target"])
            .args(["-Zbuild-std=core,alloc,compiler_builtins", "-Zbuild-std-features=compiler-builtins-mem"]),
    )?;
    fs::create_dir_all(library).map_err(SetUpError::io(library.display()))?;
    let built = seed.join("target").join(target).join("release/deps");
    for entry in fs::read_dir(&built).map_err(SetUpError::io(built.display()))?.flatten() {
        let name = entry.file_name();
        let shown = name.to_string_lossy();
        if shown.ends_with(".rlib") && !shown.starts_with("libseed") {
            fs::copy(entry.path(), library.join(&name)).map_err(SetUpError::io(entry.path().display()))?;
        }
    }
    if has_core(library) {
        return Ok(());
    }
    Err(SetUpError::NoToolchain(format!("cargo built no core library in {}", built.display())))
}
