//! `palpate accept` on the emulated boards: it passes, and it finds what is planted in the image or in its timer.

use crate::running::{boards, is_wanted};
use object::{Object, ObjectSection, ObjectSymbol};
use palpate_tool::accept;
use palpate_tool::firmware::{Board, Program};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Accepts an image: the exit status, and the report.
fn accepted(board: Board, image: &Path) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("accept.md");
    let output = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["accept", "--emulator", board.name(), "--seconds", "1", "--ticks", "2500", "--image"])
        .arg(image)
        .arg("--report")
        .arg(&report)
        .output()
        .unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(!printed.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(fs::read_to_string(report).unwrap(), printed, "what is printed is what is posted");
    (output.status.code(), printed)
}

/// What a report says failed.
fn failed(report: &str) -> Vec<String> {
    let rows = report.lines().filter(|line| line.starts_with("| FAILED |"));
    rows.map(|line| line.split('|').nth(2).unwrap().trim().to_owned()).collect()
}

/// The same image with some of its bytes changed: those of the first symbol whose name has all these parts.
fn changed(program: &Program, folder: &Path, parts: &[&str], change: impl FnOnce(&mut [u8])) -> std::path::PathBuf {
    let mut content = fs::read(&program.image.elf).unwrap();
    let (start, length) = {
        let file = object::File::parse(content.as_slice()).unwrap();
        let symbol = file.symbols().find(|symbol| {
            let name = symbol.name().unwrap_or_default();
            symbol.size() > 0 && parts.iter().all(|part| name.contains(part))
        });
        let symbol = symbol.unwrap_or_else(|| panic!("no symbol of {parts:?}"));
        // The lowest bit of a function's address says that it is Thumb code.
        let address = symbol.address() & !1;
        let section = file.section_by_index(symbol.section_index().unwrap()).unwrap();
        let (offset, _) = section.file_range().unwrap();
        ((offset + address - section.address()) as usize, symbol.size() as usize)
    };
    change(&mut content[start..start + length]);
    let path = folder.join("changed");
    fs::write(&path, content).unwrap();
    path
}

#[test]
fn a_good_board_is_accepted_on_every_core() {
    if !is_wanted("a_good_board_is_accepted_on_every_core") {
        return;
    }
    for board in Board::CORTEX_F {
        let program = accept::prepared(board, &[]).unwrap();
        let (status, report) = accepted(board, &program.image.elf);
        assert_eq!((status, failed(&report)), (Some(0), vec![]), "{report}");
        assert!(report.contains("22500 ticks in 9 lines agree"), "{report}");
    }
}

#[test]
fn one_wrong_bit_in_the_code_is_found_and_the_lap_that_it_spoils_is_named() {
    if !is_wanted("one_wrong_bit_in_the_code_is_found_and_the_lap_that_it_spoils_is_named") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for &board in boards() {
        let program = accept::prepared(board, &[]).unwrap();
        // The first sum in the kinematics of the delta becomes a difference: VADD.F32 and VSUB.F32 differ in one bit
        // (Arm architecture reference manual, "VADD (floating-point)", encoding T2).
        let image = changed(&program, folder.path(), &["Delta", "Kinematics", "held_pose"], |code| {
            let sum = code.chunks_exact(2).map(|half| u16::from_le_bytes(half.try_into().unwrap())).collect::<Vec<_>>();
            let is_sum = |pair: &[u16]| pair[0] & 0xffb0 == 0xee30 && pair[1] & 0x0f50 == 0x0a00;
            let at = sum.windows(2).position(is_sum).expect("a sum");
            code[2 * (at + 1)] ^= 1 << 6;
        });
        let (status, report) = accepted(board, &image);
        assert_eq!(
            (status, failed(&report)),
            (Some(1), vec!["state hash".to_owned(), "script".to_owned()]),
            "{report}"
        );
        // The first lap of a delta.
        assert!(report.contains("a wrong bit in lap coupled, between ticks 1 and 2500: "), "{report}");
    }
}

#[test]
fn one_wrong_bit_in_the_tables_is_found() {
    if !is_wanted("one_wrong_bit_in_the_tables_is_found") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for &board in boards() {
        let program = accept::prepared(board, &[]).unwrap();
        let image = changed(&program, folder.path(), &["palpate_emulated", "tables", "6FACE_2"], |table| {
            let middle = table.len() / 2;
            table[middle] ^= 1;
        });
        let (status, report) = accepted(board, &image);
        assert_eq!((status, failed(&report)), (Some(1), vec!["table CRC".to_owned()]), "{report}");
    }
}

#[test]
fn a_late_tick_is_found() {
    if !is_wanted("a_late_tick_is_found") {
        return;
    }
    for &board in boards() {
        let program = accept::prepared(board, &["planted-late"]).unwrap();
        let (status, report) = accepted(board, &program.image.elf);
        // One tick of a thousand, by 12 or 15 of 250 microseconds.
        let expected = ["rate".to_owned(), "jitter".to_owned()];
        let failed = failed(&report);
        assert!(status == Some(1) && failed.contains(&"jitter".to_owned()), "{report}");
        assert!(failed.iter().all(|name| expected.contains(name)), "{report}");
        assert!(report.contains("a late tick in "), "{report}");
    }
}
