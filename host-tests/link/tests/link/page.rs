//! The frames that `docs/howto/link.md` shows are those that are sent.

use palpate::scene::{BodyPose, Command};
use palpate::wire::frame::{MAX_FRAME, pack};
use palpate::wire::{HostMessage, PROTOCOL, Upload};
use std::path::Path;

/// What the page says a frame says, and the message.
const SHOWN: [(&str, HostMessage); 7] = [
    ("hello, in version 5", HostMessage::Hello { protocol: PROTOCOL }),
    ("the host is there", HostMessage::Alive),
    ("stop", HostMessage::Stop),
    (
        "order 1: a push of 0, 0, 0.5 N",
        HostMessage::Command { number: 1, command: Command::Push { force: [0.0, 0.0, 0.5] } },
    ),
    ("order 2: at most 2 N", HostMessage::Command { number: 2, command: Command::Limit { force: 2.0 } }),
    (
        "order 3: body 1 at 0, 0.06, 0 m, upright",
        HostMessage::Command {
            number: 3,
            command: Command::Place {
                body: 1,
                pose: BodyPose { position: [0.0, 0.06, 0.0], orientation: [0.0, 0.0, 0.0, 1.0] },
            },
        },
    ),
    ("part 4: a body of 6,896 bytes starts", HostMessage::Upload { number: 4, part: Upload::Begin { bytes: 6_896 } }),
];

#[test]
fn the_frames_of_the_page_are_those_that_are_sent() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/howto/link.md");
    let page = std::fs::read_to_string(path).unwrap();
    for (says, command) in SHOWN {
        let mut buffer = [0; MAX_FRAME];
        let frame = pack(&command, &mut buffer).unwrap();
        let bytes: Vec<String> = frame.iter().map(|byte| format!("{byte:02x}")).collect();
        let row = format!("| `{}` | {says} |", bytes.join(" "));
        println!("{row}");
        assert!(page.contains(&row), "docs/howto/link.md has not the row\n{row}");
    }
}

/// The Python that the page names packs the same frames.
#[test]
fn the_python_of_the_hosts_packs_the_same_frames() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hosts/frames.py");
    let block = std::fs::read_to_string(path).unwrap();
    let code = format!(
        "{block}\nfor told in HELLO, ALIVE, STOP, push(1, 0, 0, 0.5), push(300, 1.5, -2, 0.1): print(told.hex())"
    );
    let Ok(run) = std::process::Command::new("python3").args(["-c", &code]).output() else {
        println!("left out: there is no python3");
        return;
    };
    let push = |number, force| HostMessage::Command { number, command: Command::Push { force } };
    let wanted = [
        HostMessage::Hello { protocol: PROTOCOL },
        HostMessage::Alive,
        HostMessage::Stop,
        push(1, [0.0, 0.0, 0.5]),
        push(300, [1.5, -2.0, 0.1]),
    ];
    let hex = |command: &HostMessage| {
        let mut buffer = [0; MAX_FRAME];
        pack(command, &mut buffer).unwrap().iter().map(|byte| format!("{byte:02x}")).collect::<String>() + "\n"
    };
    let (said, complained) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    assert_eq!(said, wanted.iter().map(hex).collect::<String>(), "{complained}");
}
