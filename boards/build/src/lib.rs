//! Shared by the boards' build scripts: the memory map for the linker, the body for the image.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Names the baked body: a file that `cargo palpate bake MODEL --out FILE.rs` wrote. `cargo palpate firmware --board B
/// --body MODEL …` sets it.
const BODY: &str = "PALPATE_BODY";
/// Names the device: a file that `cargo palpate device my.toml --out FILE.rs` wrote. `cargo palpate firmware --board B
/// --device my.toml …` sets it.
const DEVICE: &str = "PALPATE_DEVICE";
/// The servo rate, Hz. `cargo palpate firmware --board B --rate HZ …` sets it.
const RATE: &str = "PALPATE_RATE";

/// The origin of the body in the workspace, metres. `cargo palpate firmware --board B --body MODEL --at X,Y,Z …` sets it.
const ORIGIN: &str = "PALPATE_ORIGIN";

/// Lays a memory map where the linker finds it as `memory.x`.
///
/// # Panics
/// If it cannot be read or laid there: a build script has no better way to say so.
pub fn memory_map(file: &str) {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(file, out.join("memory.x")).unwrap_or_else(|error| panic!("{file}: {error}"));
    println!("cargo::rustc-link-arg-bins=-L{}", out.display());
    println!("cargo::rerun-if-changed={file}");
    println!("cargo::rerun-if-changed=build.rs");
}

/// Lays another memory map where the linker finds it for a package's examples.
///
/// # Panics
/// As [`memory_map`].
pub fn memory_map_of_examples(memory: &str) {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR")).join("examples");
    fs::create_dir_all(&out).expect("OUT_DIR can be written");
    fs::write(out.join("memory.x"), memory).expect("OUT_DIR can be written");
    println!("cargo::rustc-link-arg-examples=-L{}", out.display());
}

/// Lays the regions of a memory map beside it, as `regions.x`: those of an image that a host may order about, with the
/// feature `host`, else the others.
///
/// # Panics
/// As [`memory_map`].
pub fn regions() {
    let file = if is_hosted() { "regions/hosted.x" } else { "regions/alone.x" };
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(file, out.join("regions.x")).unwrap_or_else(|error| panic!("{file}: {error}"));
    println!("cargo::rerun-if-changed={file}");
}

/// Lays other regions where the linker finds them for one program of a package: before [`memory_map`].
///
/// # Panics
/// As [`memory_map`].
pub fn regions_of(program: &str, file: &str) {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR")).join(program);
    fs::create_dir_all(&out).expect("OUT_DIR can be written");
    fs::copy(file, out.join("regions.x")).unwrap_or_else(|error| panic!("{file}: {error}"));
    println!("cargo::rustc-link-arg-bin={program}=-L{}", out.display());
    println!("cargo::rerun-if-changed={file}");
}

/// The board's own body: one patch, or with the feature `host`, which wants a whole body, the capped box.
#[must_use]
pub fn own_body() -> &'static str {
    if is_hosted() { "../bodies/capped_box.rs" } else { "../bodies/table1c.rs" }
}

fn is_hosted() -> bool {
    env::var_os("CARGO_FEATURE_HOST").is_some()
}

/// Says where the body's tables lie: `fast`, in the fastest memory, or `flash`.
const TABLES: &str = "PALPATE_TABLES";

/// Whether the body's tables lie in the fastest memory: unless `PALPATE_TABLES` says `flash`.
///
/// # Panics
/// If it says anything else.
pub fn tables_are_fast() -> bool {
    println!("cargo::rerun-if-env-changed={TABLES}");
    match env::var(TABLES).as_deref() {
        Ok("fast") | Err(env::VarError::NotPresent) => true,
        Ok("flash") => false,
        other => panic!("{TABLES}={other:?}: neither fast nor flash"),
    }
}

/// Writes `tables.x`, which a memory map includes for the sections beside the hot code: all constants, or all
/// but a body's tables.
///
/// # Panics
/// If it cannot be written.
pub fn tables() {
    let patterns = if tables_are_fast() {
        "*(.rodata .rodata.*);\n"
    } else {
        // Constants of the code itself: small, and read in every tick.
        "*(.rodata.cst* .rodata.str* .rodata..L* .rodata.*7palpate*);\n"
    };
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("tables.x"), patterns).expect("OUT_DIR can be written");
}

/// Passes on the body that `PALPATE_BODY` names, or the board's own, as `PALPATE_BODY_FILE` for `include!`, and the
/// device that `PALPATE_DEVICE` names, or `src/device.rs`, as `PALPATE_DEVICE_FILE`.
///
/// # Panics
/// If there is no such file.
pub fn body_and_device(body: &str) {
    choose(BODY, body);
    choose(DEVICE, "src/device.rs");
}

/// Writes the servo rate, Hz, that `PALPATE_RATE` names, or 4,000, as `rate.rs` for `include!`.
///
/// # Panics
/// If it is no whole number from 3,000 up to the highest that the board was modelled at.
pub fn rate(highest_hz: u32) {
    println!("cargo::rerun-if-env-changed={RATE}");
    let asked = env::var(RATE).unwrap_or_else(|_| "4000".to_owned());
    let rate = asked.parse().ok().filter(|rate| (3_000..=highest_hz).contains(rate));
    let rate: u32 = rate.unwrap_or_else(|| panic!("{RATE}={asked}: this board takes 3000 to {highest_hz} Hz"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("rate.rs"), rate.to_string()).expect("OUT_DIR can be written");
}

/// Writes the body's origin, metres, that `PALPATE_ORIGIN` names as `origin.rs` for `include!`; by default a body of
/// 100 mm square lies level, 60 mm below the centre of the workspace.
///
/// # Panics
/// If it is not three finite numbers.
pub fn origin() {
    println!("cargo::rerun-if-env-changed={ORIGIN}");
    let asked = env::var(ORIGIN).unwrap_or_else(|_| "-0.05,-0.05,-0.06".to_owned());
    let metres: Option<Vec<f32>> = asked.split(',').map(|metres| metres.trim().parse().ok()).collect();
    let [x, y, z] = metres
        .and_then(|metres| <[f32; 3]>::try_from(metres).ok())
        .filter(|metres| metres.iter().all(|metres| metres.is_finite()))
        .unwrap_or_else(|| panic!("{ORIGIN}={asked}: not three finite numbers, metres"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("origin.rs"), format!("palpate::math::vec3({x:?}, {y:?}, {z:?})"))
        .expect("OUT_DIR can be written");
}

fn choose(variable: &str, default: &str) {
    println!("cargo::rerun-if-env-changed={variable}");
    let chosen = env::var_os(variable).map_or_else(|| Path::new(default).to_path_buf(), PathBuf::from);
    let absolute = chosen.canonicalize().unwrap_or_else(|error| panic!("{variable}: {}: {error}", chosen.display()));
    println!("cargo::rerun-if-changed={}", absolute.display());
    println!("cargo::rustc-env={variable}_FILE={}", absolute.display());
}
