//! A million ticks that visit everything a servo can do, on every core and on the host: the same bits.

use crate::running::is_wanted;
use object::{Object, ObjectSection};
use palpate::servo::{Fault, Phase};
use palpate_bench::exercise::tally::Tally;
use palpate_tool::firmware::{self, Board, Pace, Program, Progress};
use std::fs;
use std::io::{Write, stderr};
use std::path::Path;
use std::thread;
use std::time::Instant;

/// What the host prints, and the tallies.
fn on_host() -> (String, Vec<Tally>) {
    let (mut lines, mut tallies) = (String::new(), Vec::new());
    palpate_bench::exercise::run(&mut |name, tally| {
        lines += &format!("{name} {tally}\n");
        tallies.push(*tally);
    });
    (lines, tallies)
}

#[test]
fn every_core_and_the_host_agree_in_every_bit_of_a_million_ticks() {
    if !is_wanted("every_core_and_the_host_agree_in_every_bit_of_a_million_ticks") {
        return;
    }
    let prepare = |board: &Board| Program::prepare(*board, "parity", &[], &Progress::new()).unwrap();
    let programs: Vec<Program> = firmware::compared().iter().map(prepare).collect();
    let (mut host, _) = on_host();
    let mut soft = Tally::default();
    palpate_bench::exercise::run_soft(&mut |name, tally| {
        host += &format!("{name} {tally}\n");
        soft = *tally;
    });
    assert!(soft.touches > 25 && soft.touching > 5_000, "{soft:?}");
    thread::scope(|scope| {
        for program in &programs {
            let host = &host;
            scope.spawn(move || {
                let start = Instant::now();
                let board = program.run(Pace::Free).unwrap();
                let core = program.image.board.core();
                assert_eq!(&board, host, "{core} and the host differ");
                let seconds = start.elapsed().as_secs_f64();
                let _ = writeln!(stderr(), "{core}: {} ticks agree, {seconds:.0} s", palpate_bench::exercise::TICKS);
            });
        }
    });
}

/// The fused multiply-adds of RISC-V code, by their addresses: they round once where the host rounds twice.
fn fused(elf: &Path) -> Vec<u64> {
    let content = fs::read(elf).expect("the image");
    let file = object::File::parse(content.as_slice()).expect("an ELF file");
    let section = file.section_by_name(".text").expect("code");
    let (code, mut at, mut found) = (section.data().expect("its bytes"), 0, Vec::new());
    while let Some(&[low, _]) = code.get(at..at + 2) {
        // FMADD, FMSUB, FNMSUB, FNMADD: `10xx11` in the seven bits of the operation.
        if low & 0b111_0011 == 0b100_0011 {
            found.push(section.address() + at as u64);
        }
        // Two bits set: four bytes; else a compressed instruction.
        at += if low & 0b11 == 0b11 { 4 } else { 2 };
    }
    found
}

#[test]
fn no_image_for_risc_v_fuses_a_multiplication_with_an_addition() {
    if !is_wanted("no_image_for_risc_v_fuses_a_multiplication_with_an_addition") {
        return;
    }
    let program = Program::prepare(Board::Riscv, "parity", &[], &Progress::new()).unwrap();
    assert_eq!(fused(&program.image.elf), Vec::<u64>::new());
}

#[test]
fn the_million_ticks_visit_every_mode_phase_and_fault() {
    let (_, tallies) = on_host();
    assert_eq!(tallies.len() as u32, palpate_bench::exercise::TICKS / palpate_bench::exercise::TICKS_PER_LINE);
    let all = |of: fn(&Tally) -> u32| tallies.iter().map(of).fold(0, |all, bits| all | bits);
    assert_eq!(all(|tally| tally.modes), 0b111_1110, "modes");
    // No tick ends in the phase before the first tick.
    let phases =
        Phase::ALL.iter().filter(|phase| **phase != Phase::Reset).fold(0, |all, phase| all | 1 << *phase as u32);
    assert_eq!(all(|tally| tally.phases), phases, "phases");
    // A wrong sign shows on a device that answers its motors, as the servo's own tests have it; the script's does not.
    // A calibration is looked at before the loop is made. A bad magnet and a frozen sensor take a damaged frame's way.
    // A rigid body is for every rate.
    let unscripted = [Fault::WrongPolarity, Fault::Calibration, Fault::Magnet, Fault::Frozen, Fault::OtherRate];
    let scripted = Fault::ALL.iter().filter(|fault| !unscripted.contains(fault));
    assert_eq!(all(|tally| tally.faults), scripted.fold(0, |all, fault| all | 1 << fault.code()), "faults");
    for (part, bits) in [0b11_1111, 0xfff, 0xff].into_iter().enumerate() {
        let visited = tallies.iter().fold(0, |all, tally| all | tally.features[part]);
        assert_eq!(visited, bits, "faces, edges and vertices of the capped box: part {part}");
    }
    // The tally of a lap is that of its last line.
    let nexts = tallies.iter().skip(1).map(|next| next.ticks).chain([0]);
    let ends: Vec<_> = tallies.iter().zip(nexts).filter(|(tally, next)| *next <= tally.ticks).collect();
    let total = |of: fn(&Tally) -> u32| ends.iter().map(|(tally, _)| of(tally)).sum::<u32>();
    let (touches, touching) = (total(|tally| tally.touches), total(|tally| tally.touching));
    assert!(touches > 250 && touching > 100_000, "{touches} touches, {touching} ticks of them: {tallies:?}");
}
