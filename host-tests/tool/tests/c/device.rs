//! A device as a C header: a compiler of C reads the numbers that Rust has.

use crate::everything;
use crate::running::{is_wanted, run};
use palpate_sim::devices::{DEVICES, OwnDevice, c_header};
use palpate_tool::in_c::{self, Core};
use std::fs;
use std::process::Command;

/// Prints the words of the header's mechanism, device and protection.
const PRINTS: &str = r#"
#include "device.h"
#include <stdio.h>
#include <string.h>
static void print(const void *from, size_t bytes)
{
    for (size_t at = 0; at < bytes; at += 4) {
        uint32_t word;
        memcpy(&word, (const char *)from + at, 4);
        printf("%u\n", (unsigned)word);
    }
}
int main(void)
{
    (void)START_DEVICE;
    (void)START_DEVICE_PROTECTED;
    palpate_settings settings;
    if (device_settings(&settings)) return 1;
    print(&settings, offsetof(palpate_settings, body_origin));
    print(&settings.between_counts, sizeof settings.between_counts);
    print(&MECHANISM, sizeof MECHANISM);
    print(&DEVICE, sizeof DEVICE);
    print(&PROTECTION, offsetof(palpate_protection, watch_signs));
    print(PROTECTION.inertia, sizeof PROTECTION.inertia);
    return 3 * (ENCODER_INPUTS[0] + 3 * MOTOR_OUTPUTS[2]) != 18;
}
"#;

#[test]
fn the_header_of_a_device_has_its_numbers_in_c() {
    if !is_wanted("the header of a device in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("print.c");
    fs::write(&source, PRINTS).expect("a source");
    for shipped in &DEVICES {
        let Some(file) = shipped.file() else { continue };
        let own = OwnDevice::new(file, shipped.name).expect("a device");
        fs::write(folder.path().join("device.h"), c_header(&own, shipped.name)).expect("a header");
        let made = folder.path().join("print");
        let mut gcc = in_c::compiler(Core::Host, "gcc").expect("in the repository");
        gcc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-I"]).arg(folder.path()).arg(&source);
        run(gcc.arg("-I").arg(folder.path()).arg(crate::running::library(Core::Host)).args(["-lm", "-o"]).arg(&made));
        let mut printed: Vec<f32> =
            run(&mut Command::new(&made)).lines().map(|word| f32::from_bits(word.parse().expect("a word"))).collect();
        let settings = own.preset.recommended().settings;
        let recommended = [
            settings.rate_hz,
            settings.stiffness_n_per_m,
            settings.damping_n_s_per_m,
            settings.max_force_n,
            settings.velocity_corner_hz,
            settings.soft_start_s,
            f32::from_bits(1),
        ];
        assert!(printed.drain(..recommended.len()).eq(recommended), "{}: its settings", shipped.name);
        if shipped.name == "woodenhaptics-2016" {
            assert_eq!(printed, everything::numbers());
        }
        assert!(printed.iter().all(|number| number.is_finite()), "{}", shipped.name);
    }
}
