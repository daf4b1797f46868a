//! Commissioning as a person at a port reads it, in `docs/howto/commissioning.md`.

use crate::pages::{compare, palpate, text};

const PAGE: &str = "docs/howto/commissioning.md";
/// The loop of the boards in this program, and on the emulated board where its image is built.
const BOARDS: [&[&str]; 2] = [&["--host"], &["--emulator", "m4"]];

#[test]
fn the_transcript_of_commissioning_is_what_the_command_prints() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("device.toml").to_string_lossy().into_owned();
    let boards = if std::env::var_os("PALPATE_FIRMWARE").is_some() { &BOARDS[..] } else { &BOARDS[..1] };
    for board in boards {
        let command = ["commission", "--prompts", "--plant", "encoder-sign:1", "--plant", "motors:0-2", "--out", &out];
        let said = palpate(&[&command, *board].concat()).replace(&out, "device.toml");
        let page = text(PAGE);
        let (before, rest) = page.split_once("<!-- generated: the command's own -->\n").expect("its place");
        let (_, after) = rest.split_once("<!-- end -->").expect("its end");
        let wanted = format!(
            "{before}<!-- generated: the command's own -->\n\n```text\n{}\n```\n\n<!-- end -->{after}",
            said.trim_end()
        );
        compare(PAGE, &wanted);
    }
}
