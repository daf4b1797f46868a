//! The knob's image: on every core the same bits as on the host, and it lets go.

use crate::running::{boards, is_wanted};
use palpate::servo::{Fault, Phase};
use palpate_tool::commands::demo_knob::{hash, on_board, on_host};

#[test]
fn the_knob_turns_alike_on_every_core_and_on_the_host_and_lets_go_when_its_magnet_slips() {
    if !is_wanted("the knob on the emulated boards") {
        return;
    }
    let host = on_host(true).expect("the loop runs").turned;
    for &board in boards() {
        let device = on_board(board, true).expect("the image runs").turned;
        assert_eq!(device.len(), host.len());
        for (there, here) in device.iter().zip(&host) {
            let tick = here.report.tick;
            assert_eq!(there.report.duties, here.report.duties, "{board:?}: other widths at tick {tick}");
            assert_eq!(there.report.digest, here.report.digest, "{board:?}: the states differ after tick {tick}");
        }
        assert_eq!(hash(&device), hash(&host));
    }
    let fault = host.iter().position(|sample| sample.report.fault != 0).expect("the magnet slips");
    assert_eq!(Fault::from_code(host[fault].report.fault), Some(Fault::JointJumped));
    assert!(host[fault - 1].report.phase == Phase::Running as u8 && host[fault - 1].current > 0.0);
    assert!(host[fault..].iter().all(|sample| sample.current == 0.0 && sample.report.duties == [i16::MIN; 3]));
    assert!((0..6).all(|feel| host.iter().any(|sample| sample.report.feature == feel)), "every feel is felt");
}
