//! The example in C on the emulated Cortex-M4F, in closed loop with the demo's scene, beside the image in Rust.

use crate::running::{alone, capped_box, file, is_wanted, library, run as run_program};
use clap::Parser;
use palpate_sim::devices::{DEVICES, c_preset};
use palpate_tool::commands::demo::program;
use palpate_tool::commands::options::{Scene, SceneOptions};
use palpate_tool::firmware::{Board, Link, Pace, Program, Progress, Transport};
use palpate_tool::in_c;
use palpate_tool::report::Summary;
use palpate_tool::simulation::{Trace, run};
use std::fs;
use std::path::Path;
use std::process::Command;

#[derive(Parser)]
struct Demo {
    #[command(flatten)]
    options: SceneOptions,
}

fn trace(options: &SceneOptions, scene: &Scene, link: &mut dyn Link) -> Trace {
    let mut plant = options.plant(scene).expect("the plant starts");
    run(link, &mut plant, scene.span(), |_| ()).expect("a whole run")
}

/// The functions of an image that have a branch to a panic, by the disassembler's word.
fn panicking(elf: &Path) -> Vec<String> {
    let code = run_program(Command::new("arm-none-eabi-objdump").args(["-d", "-C", "--no-show-raw-insn"]).arg(elf));
    let is_panic = |text: &str| ["panicking", "rust_begin_unwind", "_fail"].iter().any(|mark| text.contains(mark));
    let (mut function, mut found) = ("", Vec::new());
    for line in code.lines() {
        if line.ends_with(">:") {
            function = line;
        } else if is_panic(line) && !is_panic(function) {
            found.push(function.to_owned());
        }
    }
    found
}

/// Links a program for a board, in which no function may have a branch to a panic, and `part` must be linked.
pub fn cannot_panic(program: &str, part: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let (source, elf) = (folder.path().join("linked.c"), folder.path().join("linked.elf"));
    fs::write(&source, program).expect("a source");
    let mut gcc = in_c::compiler(in_c::Core::M4, "gcc").expect("in the repository");
    gcc.arg(&source).arg(library(in_c::Core::M4));
    gcc.args(["-Wl,--gc-sections,-z,noexecstack", "--specs=nosys.specs", "-lm"]);
    run_program(gcc.arg("-o").arg(&elf));
    assert_eq!(panicking(&elf), Vec::<String>::new());
    assert!(run_program(Command::new("arm-none-eabi-nm").arg("-C").arg(&elf)).contains(part), "no {part} is linked");
}

#[test]
fn the_example_in_c_computes_the_bits_of_the_image_in_rust_and_cannot_panic() {
    if !is_wanted("the example in C on the emulated board") {
        return;
    }
    let progress = Progress::new();
    let Demo { options } = Demo::parse_from(["demo"]);
    let scene = options.scene().expect("the demo's scene");
    let folder = tempfile::tempdir().expect("a folder");
    let elf = folder.path().join("example.elf");
    let example = {
        let _alone = alone();
        in_c::example(&capped_box(), scene.device, &elf, &progress).expect("the example builds")
    };

    // Another loop would take 40,000 bytes or more: the library holds ten, and the linker keeps the one that is started.
    // With all kinds of patches, whose code is unrolled, the image takes 119,000.
    assert!(example.image.flash < 130_000, "loops are linked that are not started: {} bytes", example.image.flash);

    // All of it, not a call tree: what the linker kept is what can be reached.
    let found = panicking(&elf);
    assert!(found.is_empty(), "these can panic: {found:?}");

    let in_c = trace(&options, &scene, &mut example.start_over(Transport::Fifo).expect("the emulator starts"));
    let rust = program(Board::M4, &scene, Transport::Fifo, &progress).expect("the image builds");
    // The same look finds them where they are: what the program around the loop in Rust expects, it says by a panic.
    assert!(!panicking(&rust.image.elf).is_empty(), "the look is blind");
    let in_rust = trace(&options, &scene, &mut rust.start_over(Transport::Fifo).expect("the emulator starts"));
    assert_eq!(in_c.samples.len(), in_rust.samples.len());
    for (there, here) in in_c.samples.iter().zip(&in_rust.samples) {
        let mut report = there.report;
        report.instructions = here.report.instructions;
        assert_eq!(report, here.report, "they differ at tick {}", here.report.tick);
    }
    let [of_c, of_rust] = [&in_c, &in_rust].map(Summary::new);
    assert_eq!(of_c.state_hash, of_rust.state_hash);
    assert!(of_c.touches > 3 && of_c.contact_time > 1.0 && of_c.fault.is_none(), "{of_c}");
    let most = |trace: &Trace| trace.samples.iter().map(|sample| sample.report.instructions).max().unwrap_or(0);
    println!("the capped box on an emulated Cortex-M4F, {} ticks", in_c.samples.len());
    println!("  {:<28} {:>9} {:>9}", "", "C", "Rust");
    println!(
        "  {:<28} {:>9} {:>9}",
        "state hash",
        format!("{:08x}", of_c.state_hash),
        format!("{:08x}", of_rust.state_hash)
    );
    println!("  {:<28} {:>9} {:>9}", "flash, bytes", example.image.flash, rust.image.flash);
    println!("  {:<28} {:>9} {:>9}", "static RAM, bytes", example.image.ram, rust.image.ram);
    println!("  {:<28} {:>9} {:>9}", "a tick, instructions at most", most(&in_c), most(&in_rust));
}

#[test]
fn a_loop_takes_no_more_stack_than_its_header_says() {
    if !is_wanted("the stack of a loop in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let elf = folder.path().join("stack.elf");
    let device = DEVICES.iter().find(|device| device.name == "woodenhaptics-2016").expect("the device");
    fs::write(folder.path().join("device.h"), c_preset(device)).expect("a header");
    let mut gcc = in_c::compiler(in_c::Core::M4, "gcc").expect("in the repository");
    gcc.args(["-std=c11", "-ffunction-sections", "-fdata-sections", "-I"]).arg(folder.path());
    gcc.arg(format!("-DPART=\"{}\"", capped_box().display())).arg(file("tests/stack.c"));
    for source in ["startup_mps2.c", "part.S"] {
        gcc.arg(file("examples/cube/Core/Src").join(source));
    }
    gcc.arg(library(in_c::Core::M4)).arg("-T").arg(file("examples/cube/mps2_an386.ld"));
    run_program(gcc.args(["-nostartfiles", "--specs=nosys.specs", "-Wl,--gc-sections", "-o"]).arg(&elf));
    let program = Program::of_image(Board::M4, &elf, &Progress::new()).expect("an image");
    let said = program.run(Pace::Counting).expect("it ends");
    println!("stack on an emulated Cortex-M4F, bytes, and instructions of a tick at most\n{said}");
    let of = |what: &str| -> u32 {
        let number = said.lines().find_map(|line| line.strip_prefix(what)?.strip_prefix(' '));
        number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no {what}: {said}"))
    };
    assert!(of("driven") > 10_000, "without force a tick does less: {said}");
    // As palpate_body_load() and palpate_servo_start_serial_arm_tool() say.
    let limits = [("load", 2048), ("start", 6144), ("tick", 2048), ("protected start", 6144), ("protected tick", 2048)];
    let limits = limits.into_iter().chain([("tool start", 20_480), ("tool tick", 10_240)]);
    for (what, limit) in limits {
        assert!((256..limit).contains(&of(what)), "{what}: {said}");
    }
    // Protection and a tool's contacts cost something.
    let [plain, protected, tool] = ["instructions", "protected instructions", "tool instructions"].map(of);
    assert!(0 < plain && plain < protected && protected < tool, "{said}");
}
