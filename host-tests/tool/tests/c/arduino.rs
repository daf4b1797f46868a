//! The folder for Arduino and PlatformIO: its sketch compiles and links with each of its libraries.

use crate::running::{alone, is_wanted, run};
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
struct Port { void begin(long) {} void println(const char *) {} void println(float) {} };
static Port Serial;
void setup();
void loop();
";

#[test]
fn the_sketch_links_with_every_library_of_the_folder() {
    if !is_wanted("the Arduino library") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("palpate");
    let Command { arguments } = Command::parse_from(["c-library", "--out", out.to_str().expect("a path")]);
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

    fs::write(folder.path().join("Arduino.h"), ARDUINO).expect("a header");
    let main = folder.path().join("main.cpp");
    let sketch = out.join("examples/Feel/Feel.ino");
    fs::write(
        &main,
        format!(
            "#include <Arduino.h>\n#include \"{}\"\nint main() {{ setup(); for (;;) loop(); }}\n",
            sketch.display()
        ),
    )
    .expect("a program");
    for core in [Core::M4, Core::M33] {
        for place in core.arduino() {
            let object = folder.path().join("main.o");
            let mut gcc = in_c::compiler(core, "g++").expect("in the repository");
            gcc.args(["-std=c++17", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-ffunction-sections"]);
            gcc.arg("-I").arg(folder.path()).arg("-I").arg(out.join("src")).arg("-c").arg(&main);
            run(gcc.arg("-o").arg(&object));
            // Linked as C: the library of C++ is a large package that nothing here needs.
            let mut gcc = in_c::compiler(core, "gcc").expect("in the repository");
            gcc.args(["-Wl,--gc-sections", "--specs=nosys.specs"]).arg(&object);
            gcc.arg("-L").arg(out.join("src").join(place)).args(["-lpalpate", "-lm", "-o"]);
            run(gcc.arg(folder.path().join("sketch.elf")));
            println!("the sketch links for {place}");
        }
    }
}
