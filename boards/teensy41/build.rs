//! The memory map: everything that the tick touches lies in memory that is as fast as the core.
//!
//! | what | where | why |
//! |---|---|---|
//! | all code | ITCM, 192 KB (acceptance: 224, of DTCM's) | fetched at 600 MHz without waiting and without a cache that could miss |
//! | vector table, tables, constants, variables, stack | DTCM, 320 KB | read beside the code, likewise |
//! | images of them | flash | copied by the run time before main |
//!
//! The other 512 KB of RAM (OCRAM) answer at a quarter of the core's clock and stay unused. Tables that do not fit stay
//! in flash, behind the core's cache (PALPATE_TABLES): `palpate firmware --board teensy41 --body MODEL …` sees to it.

use imxrt_rt::{Family, FlexRamBanks, Memory, RuntimeBuilder};

fn main() {
    let constants = if palpate_board_build::tables_are_fast() { Memory::Dtcm } else { Memory::Flash };
    // Of 32 KB each. The acceptance runs more code than any other image, and has few data.
    let itcm = if std::env::var_os("CARGO_FEATURE_ACCEPT").is_some() { 7 } else { 6 };
    RuntimeBuilder::from_flexspi(Family::Imxrt1060, 7_936 * 1024)
        .flexram_banks(FlexRamBanks { ocram: 0, itcm, dtcm: 16 - itcm })
        .vectors(Memory::Dtcm)
        .text(Memory::Itcm)
        .rodata(constants)
        .data(Memory::Dtcm)
        .bss(Memory::Dtcm)
        .uninit(Memory::Dtcm)
        .stack(Memory::Dtcm)
        .stack_size(32 * 1024)
        .heap_size(0)
        .linker_script_name("teensy.x")
        .build()
        .expect("the linker script can be written");
    palpate_board_build::body_and_device(palpate_board_build::own_body());
    palpate_board_build::origin();
    palpate_board_build::rate(40_000);
    println!("cargo::rerun-if-changed=build.rs");
}
