//! The boards for the bench cannot be run here. They build, and what their memory maps promise holds.

use crate::running::is_wanted;
use object::{Object, ObjectSymbol};
use palpate_tool::firmware::{BenchBoard, Progress, build_bench};
use std::fs;

/// The interrupt that the servo runs in.
const fn interrupt(board: BenchBoard) -> &'static str {
    match board {
        BenchBoard::Stm32g4 => "TIM7",
        BenchBoard::Pico2 => "PWM_IRQ_WRAP_0",
        BenchBoard::Teensy41 => "PIT",
    }
}

/// Where the chip fetches code without waiting: the first address and the one past the last.
const fn fast(board: BenchBoard) -> [u64; 2] {
    match board {
        BenchBoard::Stm32g4 => [0x1000_0000, 0x1000_8000],
        BenchBoard::Pico2 => [0x2000_0000, 0x2008_0000],
        BenchBoard::Teensy41 => [0x0000_0000, 0x0003_0000],
    }
}

#[test]
fn the_boards_for_the_bench_build_and_their_tick_lies_where_the_chip_is_fastest() {
    if !is_wanted("the_boards_for_the_bench_build_and_their_tick_lies_where_the_chip_is_fastest") {
        return;
    }
    for board in BenchBoard::ALL {
        let elf = build_bench(board, &Progress::new()).unwrap();
        let content = fs::read(&elf).unwrap();
        let file = object::File::parse(content.as_slice()).unwrap();
        let functions: Vec<(String, u64, u64)> = file
            .symbols()
            .filter(|symbol| symbol.kind() == object::SymbolKind::Text && symbol.size() > 0)
            .filter_map(|symbol| Some((symbol.name().ok()?.to_owned(), symbol.address(), symbol.size())))
            .collect();

        let [first, end] = fast(board);
        // The library's functions, by the length and name of its crate; libm's square root; the interrupt itself. A
        // thunk is the linker's way to such a function from afar.
        let of_the_tick = |name: &str| {
            let is_ours = name == interrupt(board) || name.contains("7palpate") || name.contains("4libm");
            is_ours && !name.contains("Thunk")
        };
        let mut bytes = 0;
        for (name, address, size) in functions.iter().filter(|(name, ..)| of_the_tick(name)) {
            assert!((first..end).contains(address), "{board:?}: {name} lies at {address:#x}");
            bytes += size;
        }
        assert!(functions.iter().any(|(name, ..)| name == interrupt(board)), "{board:?}: no {}", interrupt(board));
        assert!(bytes > 4_000, "{board:?}: a tick of {bytes} bytes is none");

        // A set-up that the compiler proves to panic, such as a clock that the voltage does not allow, leaves next to
        // nothing of main.
        let main = functions.iter().filter(|(name, ..)| name.contains("cortex_m_rt_main")).map(|(.., size)| size);
        let main: u64 = main.sum();
        assert!(main > 4_000, "{board:?}: a main of {main} bytes never comes to its loop");
    }
}
