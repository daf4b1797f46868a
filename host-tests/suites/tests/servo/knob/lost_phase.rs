//! A phase that is lost while nothing watches the currents, as below `open_a`: it has to be harmless.

use palpate::servo::Fault;
use palpate_sim::knob::{FEELS, HostKnob, NAMES};
use palpate_sim::plant::{Cogging, DialSettings, Fingers};

/// Full duty of torque as the amplitude of a phase, A: 0.75 A in the scale that keeps the power.
const FULL: f64 = 0.613;

/// Without cogging: the torque is the field's alone.
fn plain() -> DialSettings {
    let mut settings = DialSettings::gimbal_knob();
    settings.cogging = settings.cogging.map(|part| Cogging { torque: 0.0, ..part });
    settings
}

#[test]
fn with_a_phase_lost_the_torque_is_weaker_and_never_turns_its_sign() {
    for phase in 0..3 {
        let mut knob = HostKnob::running(plain(), None);
        // The spring.
        knob.choose(3);
        knob.dial.lose(Some(phase));
        let (mut least, mut most, mut over, mut current) = (f64::INFINITY, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut from = knob.dial.angle();
        // Round an electrical turn on either side of the middle, and out to where all torque is asked for.
        for step in -40..=40 {
            let angle = 0.7 + f64::from(step) * 0.03;
            // A clamp pulls hard: there by and by, as in a hand.
            for part in 1..=300 {
                knob.dial.hold(Fingers::clamp(from + (angle - from) * f64::from(part) / 300.0));
                knob.tick();
            }
            from = angle;
            knob.ticks(200);
            for _ in 0..40 {
                knob.tick();
                let [asked, given] = [f64::from(knob.state().witness().torque()), knob.dial.torque()];
                current = knob.dial.currents().map(f64::abs).into_iter().fold(current, f64::max);
                let along = given * asked.signum();
                // Beyond what the sensor's noise asks for.
                if asked.abs() > 2e-3 {
                    least = least.min(along);
                }
                most = most.max(along);
                over = over.max(along - asked.abs());
            }
        }
        assert_eq!(knob.state().fault(), None);
        let told = [least, most, over].map(|torque| 1e3 * torque);
        println!("phase {phase} lost: least, most, most above what is asked for: {told:.3?} mN·m; {current:.2} A");
        // What dead time is made up for by is a little too much with a phase less; the wrong way it is a tenth of the
        // dry friction at most.
        assert!(least > -1e-4 && over < 1.5e-3 && current < FULL, "{told:?} {current}");
        assert!(most > 0.03, "it is driven: {told:?}");
    }
}

#[test]
fn with_a_phase_lost_no_dial_runs_away_in_any_feel() {
    let mut stopped = 0;
    for (index, name) in NAMES.into_iter().enumerate().take(FEELS.len()) {
        for phase in 0..3 {
            let mut knob = HostKnob::running(DialSettings::gimbal_knob(), None);
            knob.choose(index as u8);
            knob.dial.hold(Fingers::turning(0.7 + 1.2, 0.0));
            knob.ticks(2_000);
            // Wound up, lost, and let go of.
            knob.dial.lose(Some(phase));
            knob.ticks(400);
            knob.dial.hold(Fingers::NONE);
            let (mut fastest, mut current, mut late) = (0.0_f64, 0.0_f64, 0.0_f64);
            for tick in 0..8_000 {
                knob.tick();
                fastest = fastest.max(knob.dial.rate().abs());
                current = knob.dial.currents().map(f64::abs).into_iter().fold(current, f64::max);
                if tick > 6_000 {
                    late = late.max(knob.dial.rate().abs());
                }
            }
            let fault = knob.state().fault().map(|(fault, _)| fault);
            println!(
                "{name}, phase {phase} lost: {fastest:.1} rad/s, {current:.2} A, in the end {late:.2} rad/s, {fault:?}"
            );
            stopped += usize::from(fault == Some(Fault::Overspeed));
            assert!(matches!(fault, None | Some(Fault::Overspeed)), "{name}: {fault:?}");
            assert!(fastest < 70.0 && late < 0.3 && current < 2.0 * FULL, "{name}: {fastest} {late} {current}");
        }
    }
    println!("stopped for their speed: {stopped}");
}
