//! The runs of `sim --protected` and `demo --protected`, on every device: nothing that protects them raises an alarm.

use palpate_tool::commands::options::SceneOptions;
use palpate_tool::devices;
use palpate_tool::simulation;

#[test]
fn nothing_raises_an_alarm_in_the_runs_of_the_demo() {
    for device in ["woodenhaptics-2016", "polhem-v2", "phantom-premium", "falcon"] {
        for (model, patch) in [("capped_box", None), ("ellipsoid_body", None), ("table1c", Some("0"))] {
            for seed in [2] {
                let options = SceneOptions {
                    model: model.into(),
                    patch: patch.map(str::to_owned),
                    device: devices::named(device).expect("it ships"),
                    rate: 4_000.0,
                    seconds: 3.0,
                    seed,
                    stiffness: None,
                    damping: None,
                    max_force: 5.0,
                    velocity_corner: 150.0,
                    soft_start: 0.1,
                    protected: true,
                    at: None,
                };
                let scene = options.scene().expect("a scene");
                let (mut plant, mut servo) =
                    (options.plant(&scene).expect("a path"), scene.host_loop().expect("a loop"));
                let run = simulation::run(servo.as_mut(), &mut plant, 4_000.0, scene.ticks, scene.enable_at, |_| ());
                let trace = run.expect("a run");
                let most = trace
                    .samples
                    .iter()
                    .map(|sample| sample.report.force.iter().map(|part| part * part).sum::<f32>().sqrt());
                let most = most.fold(0.0, f32::max);
                let fault = trace.samples.last().map(|sample| sample.report.fault);
                println!("{device:<20} {model:<16} seed {seed}: up to {most:.2} N");
                assert_eq!(fault, Some(0), "{device} {model} {seed}");
                assert!(most > 1.0, "{device} {model} {seed}: {most} N");
            }
        }
    }
}
