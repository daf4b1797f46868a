//! The boards for the bench cannot be run here. They build, and what their memory maps promise holds.

use crate::running::is_wanted;
use object::{Object, ObjectSection, ObjectSymbol};
use palpate_tool::cache;
use palpate_tool::firmware::{BenchBoard, Kind, Place, Progress, build_bench, is_long, report};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A board's image with its own body.
struct Own {
    board: BenchBoard,
    content: Vec<u8>,
    report: String,
}

/// All boards with their own bodies, built once: each other body replaces the image and is another compilation.
static OWN: LazyLock<Vec<Own>> = LazyLock::new(|| {
    let own = |board| {
        let elf = build_bench(board, None, &Progress::new()).unwrap();
        Own { board, content: fs::read(&elf).unwrap(), report: report(board, Kind::Alone, &elf).unwrap() }
    };
    BenchBoard::ALL.map(own).into()
});

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

/// Looks at the image of each board with its own body.
fn on_every_board(test: &str, look: impl Fn(BenchBoard, &object::File<'_>)) {
    if is_wanted(test) {
        for own in OWN.iter() {
            look(own.board, &object::File::parse(own.content.as_slice()).unwrap());
        }
    }
}

/// The boards' USB driver in a mangled name: as a path, and as a type.
const USB: [&str; 2] = ["13palpate_bench3usb", "palpate_bench..usb"];

#[test]
fn the_boards_for_the_bench_build_and_their_tick_lies_where_the_chip_is_fastest() {
    on_every_board("the_boards_for_the_bench_build_and_their_tick_lies_where_the_chip_is_fastest", |board, file| {
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
        // The driver of the Pico's USB masks the tick's interrupt: it may not wait for a cache meanwhile. Names of
        // functions and of the crates that they are compiled from.
        let of_the_plug = [USB[0], USB[1], "usb_device", "usbd_serial", "rp235x_hal..usb", "critical_section"];
        let of_the_plug = |name: &str| of_the_plug.iter().any(|part| name.contains(part)) && !name.contains("Thunk");
        let plug: Vec<_> = functions.iter().filter(|(name, ..)| of_the_plug(name)).collect();
        if matches!(board, BenchBoard::Pico2) {
            for (name, address, _) in &plug {
                assert!((first..end).contains(address), "{board:?}: {name} lies at {address:#x}");
            }
        }
        let has_plug = plug.iter().any(|(name, ..)| USB.iter().any(|part| name.contains(part)));
        assert_eq!(has_plug, !matches!(board, BenchBoard::Stm32g4), "{board:?}: {plug:?}");
        assert!(functions.iter().any(|(name, ..)| name == interrupt(board)), "{board:?}: no {}", interrupt(board));
        assert!(bytes > 4_000, "{board:?}: a tick of {bytes} bytes is none");

        // A set-up that the compiler proves to panic, such as a clock that the voltage does not allow, leaves next to
        // nothing of main, and nothing of the loop below the tick that it ends in.
        let of_main = ["cortex_m_rt_main", "6set_up6set_up", "program..Below", "13palpate_bench4idle"];
        let is_main = |name: &str| of_main.iter().any(|part| name.contains(part));
        let main: u64 = functions.iter().filter(|(name, ..)| is_main(name)).map(|(.., size)| size).sum();
        assert!(main > 4_000, "{board:?}: a main of {main} bytes never comes to its loop");
    });
}

/// The numbers of a line of a memory map: name, first address, bytes.
fn region(line: &str) -> Option<(&str, u64, u64)> {
    let (name, rest) = line.trim().split_once(':')?;
    let (origin, length) = rest.trim().strip_prefix("ORIGIN = 0x")?.split_once(", LENGTH = ")?;
    let (number, unit) = length.split_at(length.len() - 1);
    let unit = match unit {
        "K" => 1 << 10,
        "M" => 1 << 20,
        _ => return None,
    };
    Some((name.trim(), u64::from_str_radix(origin, 16).ok()?, number.parse::<u64>().ok()? * unit))
}

#[test]
fn the_memories_of_a_board_are_those_of_its_memory_map() {
    let images = [(Kind::Alone, "alone"), (Kind::Hosted, "hosted")];
    for (board, (kind, name)) in
        [BenchBoard::Stm32g4, BenchBoard::Pico2].into_iter().flat_map(|board| images.map(|image| (board, image)))
    {
        let map = fs::read_to_string(board.folder().unwrap().join(format!("regions/{name}.x"))).unwrap();
        let regions: Vec<_> = map.lines().filter_map(region).collect();
        for memory in board.memories(kind) {
            assert!(regions.contains(&(memory.name, memory.start, memory.bytes)), "{board:?}: {memory:?} {regions:?}");
        }
        // What is copied from flash needs its image there.
        assert!(regions.iter().any(|(name, ..)| *name == "IMAGES"));
    }
}

#[test]
fn a_body_lies_in_the_fastest_memory_while_it_fits_then_in_flash_and_is_refused_beyond() {
    let places = |bytes: u64| BenchBoard::ALL.map(|board| board.place(Kind::Alone, bytes));
    assert_eq!(places(7_160), [Some(Place::Fast); 3]);
    // A part of 250 KB.
    assert_eq!(places(250 << 10), [Some(Place::Flash), Some(Place::Fast), Some(Place::Fast)]);
    assert_eq!(places(400 << 10), [None, Some(Place::Flash), Some(Place::Flash)]);
    // The rounded cylinder: with a host the program's half of the flash is too full for it.
    assert_eq!(BenchBoard::Stm32g4.place(Kind::Hosted, 51_756), None);
    let says = BenchBoard::Stm32g4.says(Kind::Alone, 400 << 10);
    assert_eq!(says, "do not fit: 400.0 KB of tables, 352.0 KB of flash");
}

/// The bytes of tables in an image; all lie in the memory that they were promised.
fn bytes_of_tables(place: Place, board: BenchBoard, said: &str) -> u64 {
    println!("{}\n{said}", board.name());
    let lines: Vec<&str> = said.lines().filter(|line| line.contains("  tables")).collect();
    let in_flash = lines.iter().any(|line| line.contains("FLASH"));
    assert_eq!(in_flash, place == Place::Flash, "{board:?}: {said}");
    lines.iter().map(|line| line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap()).sum()
}

#[test]
fn every_board_takes_a_small_body_and_a_large_one_and_the_tables_lie_where_it_says() {
    if !is_wanted("every_board_takes_a_small_body_and_a_large_one_and_the_tables_lie_where_it_says") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for own in OWN.iter() {
        // One patch: the size is the linker's word alone.
        let bytes = bytes_of_tables(Place::Fast, own.board, &own.report);
        assert!((200..4_000).contains(&bytes), "{:?}: {bytes}", own.board);
    }
    let dunes = folder.path().join("dunes.toml");
    fs::write(&dunes, palpate_truth::dunes::dunes(10)).unwrap();
    let (file, tables) = baked(&dunes, folder.path());
    assert!(tables >= 210 << 10, "{tables} bytes of tables");
    // Where they go is each board's `place`; that they lie there is the build script's, which all have in common.
    let boards = if is_long() { &BenchBoard::ALL[..] } else { &[BenchBoard::Stm32g4] };
    for &board in boards {
        let place = board.place(Kind::Alone, tables).unwrap();
        let elf = build_bench(board, Some((&file, place)), &Progress::new()).unwrap();
        let bytes = bytes_of_tables(place, board, &report(board, Kind::Alone, &elf).unwrap());
        // All of them but the record of the body, which is a constant of the code.
        assert!((tables - 100..=tables).contains(&bytes), "{board:?}: {bytes} of {tables} bytes");
    }
}

/// A model's baked source, and the bytes of its tables.
fn baked(name: &Path, folder: &Path) -> (PathBuf, u64) {
    let file = palpate_tool::models::ModelFile::read(name).unwrap();
    let model = file.model().unwrap();
    let body = palpate_bake::BakedBody::new(&model, &file.label).unwrap();
    let (body, _) = cache::located(body.clone(), &file.text, &body.locator_options(), None, &|_, _| ()).unwrap();
    let out_file = format!("{}.rs", name.file_stem().unwrap().to_string_lossy());
    let origin = palpate_bake::source::Origin {
        model_file: &file.name,
        out_file: &out_file,
        model: file.text.as_bytes(),
        centre: model.centre,
        limit: palpate::body::TickLimit::BENCH,
    };
    let path = folder.join(&out_file);
    fs::write(&path, palpate_bake::source::source(&origin, &model, &body).unwrap()).unwrap();
    (path, palpate_bake::body::BodyBytes::of(&body).total() as u64)
}

#[test]
fn every_vector_of_a_board_is_its_tick_its_start_or_a_stop() {
    on_every_board("every_vector_of_a_board_is_its_tick_its_start_or_a_stop", |board, file| {
        let address = |name: &str| {
            let symbol = file.symbols().find(|symbol| symbol.name() == Ok(name));
            symbol.map(|symbol| symbol.address() | 1)
        };
        // The last one is the default of cortex-m-rt, which loops with the motors as they are.
        assert_eq!(address("DefaultHandler_"), None, "{board:?}");
        let stops = ["HardFault", "NonMaskableInt", "DefaultHandler"].map(|name| address(name).expect(name));
        let [tick, reset] = [interrupt(board), "Reset"].map(|name| address(name).expect(name));
        let table = file.section_by_name(".vector_table").unwrap();
        let words = table.data().unwrap().chunks_exact(4);
        let vectors: Vec<u64> = words.map(|word| u32::from_le_bytes(word.try_into().unwrap()).into()).skip(1).collect();
        // A vector of the Teensy may lead to the first function of all, at 0: its lowest bit is set all the same.
        assert_eq!(vectors.iter().filter(|vector| **vector == tick).count(), 1, "{board:?}");
        for (number, vector) in (1..).zip(vectors) {
            let known = vector == 0 || stops.contains(&vector) || [tick, reset].contains(&vector);
            assert!(known, "{board:?}: vector {number} leads to {vector:#x}");
        }
    });
}
