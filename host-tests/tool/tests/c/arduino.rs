//! The package for C: the sketches link with each of its libraries, the loop of a host rests where two springs do, and
//! the servo loop has the bits of Rust.

use crate::running::{alone, is_wanted, run};
use crate::servo;
use clap::Parser;
use palpate_tool::commands::c_library;
use palpate_tool::in_c::{self, Core};
use std::fs;

#[derive(Parser)]
struct Command {
    #[command(flatten)]
    arguments: c_library::Arguments,
}

/// As much of the Arduino core as the sketch uses.
const ARDUINO: &str = "#pragma once
#include <math.h>
#include <stdint.h>
#define LOW 0
#define INPUT_PULLUP 2
struct Port { void begin(long) {} void println(const char *) {} void println(float) {} };
static Port Serial;
inline int digitalRead(int) { return 1; }
inline void pinMode(int, int) {}
inline uint32_t micros() { return 0; }
inline void delay(uint32_t) {}
struct IntervalTimer { bool begin(void (*tick)(), float) { tick(); return true; } void priority(uint8_t) {} };
void setup();
void loop();
";

#[test]
fn the_examples_of_the_package_link_with_its_libraries_and_the_loop_of_a_host_rests_where_two_springs_do() {
    if !is_wanted("the package for C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("palpate");
    let root = palpate_tool::repository::root().expect("in the repository");
    // A model that is no body's file; the loop in Rust has the body that is kept.
    let model = root.join("host-tests/models/capped_box.toml");
    let [out_name, model] = [&out, &model].map(|path| path.to_str().expect("a path"));
    let Command { arguments } = Command::parse_from(["c-library", "--out", out_name, "--model", model]);
    {
        let _alone = alone();
        c_library::run(&arguments).expect("the folder is written");
    }
    let refused = c_library::run(&arguments).expect_err("already exists");
    assert!(refused.to_string().contains("already exists"), "{refused}");
    let properties = fs::read_to_string(out.join("library.properties")).expect("properties");
    for key in ["name=", "version=", "author=", "sentence=", "architectures=", "precompiled=full", "ldflags=-lpalpate"]
    {
        assert!(properties.lines().any(|line| line.starts_with(key)), "library.properties has no {key}");
    }
    let json: String = fs::read_to_string(out.join("library.json")).expect("PlatformIO's").split_whitespace().collect();
    assert!(json.contains("\"extraScript\":\"link.py\"") && json.contains("\"libArchive\":false"), "{json}");

    for manifest in [
        "library.properties",
        "library.json",
        "lib/pkgconfig/palpate.pc",
        "lib/cmake/palpate/palpate-config-version.cmake",
    ] {
        let text = fs::read_to_string(out.join(manifest)).expect(manifest);
        assert!(text.contains(env!("CARGO_PKG_VERSION")), "{manifest} has another version:\n{text}");
    }

    let host = out.join("lib").join(format!("{}-{}", std::env::consts::OS, std::env::consts::ARCH));
    for library in ["libpalpate.a", "libpalpate.so"] {
        let program = folder.path().join("loop");
        let mut gcc = in_c::compiler(Core::Host, "g++").expect("in the repository");
        gcc.arg("-std=c++11").arg(out.join("examples/host/loop.cpp")).arg(host.join(library)).arg("-o").arg(&program);
        run(&mut gcc);
        let said = run(std::process::Command::new(&program).env("LD_LIBRARY_PATH", &host));
        // 300 N/m of the hand, drawn 10 mm inside, against 500 N/m of the wall: 3.75 mm and 1.875 N.
        assert_eq!(said, "depth 3.7500 mm, force 1.8750 N\n", "{library}");
        let mut gcc = in_c::compiler(Core::Host, "gcc").expect("in the repository");
        gcc.args(["-std=c99", "-pedantic", "-I"])
            .arg(out.join("src"))
            .arg(out.join("examples/Servo/pc/main.c"))
            .arg(host.join(library));
        run(gcc.args(["-lm", "-o"]).arg(&program));
        let said = run(std::process::Command::new(&program).env("LD_LIBRARY_PATH", &host));
        assert_eq!(said, servo::in_rust(), "{library}");
    }

    // The program of the page.
    let page = fs::read_to_string(root.join("docs/howto/c.md")).expect("the page");
    let (source, program) = (out.join("examples/host/first.c"), folder.path().join("first"));
    let shown = fs::read_to_string(&source).expect("a source");
    assert!(page.contains(&format!("```c\n{shown}```")), "docs/howto/c.md shows another program than first.c");
    let mut gcc = in_c::compiler(Core::Host, "gcc").expect("in the repository");
    gcc.args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I"]).arg(out.join("src"));
    gcc.arg(&source).arg(host.join("libpalpate.a"));
    run(gcc.args(["-lm", "-o"]).arg(&program));
    let said = run(&mut std::process::Command::new(&program));
    assert!(page.contains(&format!("```text\n{said}```")), "docs/howto/c.md prints something else than\n{said}");
    // At rest the wall of 500 N/m is a spring.
    let numbers: Vec<f64> = said.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    assert!(said.contains("fault: none") && (numbers[1] - 0.5 * numbers[0]).abs() < 0.01, "{said}");

    let program = folder.path().join("knob");
    let mut gcc = in_c::compiler(Core::Host, "gcc").expect("in the repository");
    gcc.args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I"]).arg(out.join("src"));
    gcc.arg(out.join("examples/host/knob.c")).arg(host.join("libpalpate.a"));
    run(gcc.args(["-lm", "-o"]).arg(&program));
    let said = run(&mut std::process::Command::new(&program));
    // At rest beyond an end stop: its torque, that of a detent and of the spring, as the header has them.
    let angle = 2_700.5 * std::f64::consts::TAU / 16_384.0;
    let torque = -10.0 * (std::f64::consts::TAU * angle / 0.2618).sin() - 520.0 * (angle - 1.0);
    let duty = torque / 63.0 * 32_767.0;
    assert!(said.starts_with("done, limit 0: ") && said.contains(", detent 4, end 1, "), "{said}");
    let numbers: Vec<f64> = said.split([' ', ',']).filter_map(|word| word.trim_end().parse().ok()).collect();
    // Half a count of 0.38 mrad by the stiffness, 0.76 N·m/rad.
    for (found, expected, by) in [(numbers[0], angle, 2e-4), (numbers[3], torque, 0.15), (numbers[4], duty, 80.0)] {
        assert!((found - expected).abs() < by, "{found} {expected}: {said}");
    }

    fs::write(folder.path().join("Arduino.h"), ARDUINO).expect("a header");
    for core in [Core::M4, Core::M33] {
        for place in core.arduino() {
            for (sketch, teensy) in [("Feel", ""), ("Servo", ""), ("Servo", "-DTEENSYDUINO")] {
                let from = out.join("examples").join(sketch);
                let main = folder.path().join("main.cpp");
                let sketch = from.join(format!("{sketch}.ino"));
                fs::write(
                    &main,
                    format!("#include <Arduino.h>\n#include {sketch:?}\nint main() {{ setup(); for (;;) loop(); }}\n"),
                )
                .expect("a program");
                let object = folder.path().join("main.o");
                let mut gcc = in_c::compiler(core, "g++").expect("in the repository");
                gcc.args(["-std=c++17", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics"]);
                gcc.args((!teensy.is_empty()).then_some(teensy));
                gcc.arg("-ffunction-sections").arg("-I").arg(folder.path()).arg("-I").arg(out.join("src"));
                run(gcc.arg("-c").arg(&main).arg("-o").arg(&object));
                // Linked as C: the library of C++ is a large package that nothing here needs.
                let mut gcc = in_c::compiler(core, "gcc").expect("in the repository");
                gcc.args(["-Wl,--gc-sections", "--specs=nosys.specs", "-std=c99", "-I"])
                    .arg(out.join("src"))
                    .arg(&object);
                if from.join("servo.c").exists() {
                    gcc.arg(from.join("servo.c"));
                }
                gcc.arg("-L").arg(out.join("src").join(place)).args(["-lpalpate", "-lm", "-o"]);
                run(gcc.arg(folder.path().join("sketch.elf")));
            }
            println!("the sketches link for {place}");
        }
    }
}
