//! A body from a file beside the same one from statics: the same bits, cold and tick after tick.

use super::scene::{Scene, repeat};
use palpate::body::{Aligned, Body, BodyBuffer, BodyWitness, Edge, Face, FileHead};
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_bake::body::room;
use palpate_bake::file::{self, BakedFile};
use palpate_bake::{BakedBody, Model};
use palpate_truth::measured::{grouped, measured_if_listed};
use std::fs;

const PROBES: u32 = 100_000;
const TICKS: u32 = 100_000;

/// Every bit that a tick leaves for the next one and for the force.
fn bits(state: &BodyWitness) -> String {
    format!("{state:?}")
}

/// The words of a file, aligned as a target has them.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

/// Those whose files lie beside the tables of the boards.
const COMMITTED: [&str; 2] = ["capped_box", "sphere_body"];
/// Models whose locators are soon baked.
const QUICK: [&str; 3] = ["table1", "capped_box", "thin_plate"];

#[test]
fn a_file_gives_the_bits_of_statics() {
    compare(&|name| QUICK.contains(&name));
}

#[test]
#[ignore = "takes minutes"]
fn a_file_gives_the_bits_of_statics_for_every_model_that_ships() {
    compare(&|_| true);
}

fn compare(is_wanted: &dyn Fn(&str) -> bool) {
    for name in palpate_suites::models().into_iter().filter(|name| is_wanted(name)) {
        let text = &*fs::read_to_string(palpate_suites::model_file(name)).unwrap();
        let begun = std::time::Instant::now();
        let scene = Scene::located(name, BakedBody::locator_options);
        let model = Model::parse(text, name).unwrap();
        let baked = BakedBody { locator: scene.locator.clone(), ..BakedBody::new(&model, name).unwrap() };
        let bytes = file::write([7; 32], &model, &baked).unwrap();
        let words = words(&bytes);
        let head = FileHead::of(bytemuck::cast_slice(&words)).unwrap();
        let (mut faces, mut edges) = (vec![Face::VACANT; head.faces], vec![Edge::VACANT; head.edges]);
        let place = BodyBuffer { faces: &mut faces, edges: &mut edges };
        let from_file = Body::from_bytes(bytemuck::cast_slice(&words), place).unwrap();
        assert_eq!(from_file.baked_crc(), scene.body.baked_crc());
        // Loading lowers an effort that does not fit the boards' period.
        let statics = scene.body.with_effort(from_file.effort());
        let differing = repeat(PROBES, 61, |random| {
            let probe = scene.around(random);
            from_file.locate(probe) != scene.body.locate(probe)
        });
        assert!(!differing.contains(&true), "{name}: another cold answer");
        // A probe that wanders at up to 0.4 m/s, and is pressed in as far as it comes.
        let parts = repeat(TICKS / 1_000, 62, |random| {
            let (mut ours, mut theirs) = (from_file.start(), statics.start());
            let (mut probe, mut aim) = (scene.around(random), scene.around(random));
            for tick in 0..1_000 {
                if tick % 200 == 0 {
                    aim = scene.around(random);
                }
                probe += (aim - probe).clamp_length_max(1e-4);
                let step = |body: &Body<'_>, state: &mut BodyWitness| {
                    body.step(&Controller::SecondOrder, state, Probe::at(probe), 1.0 / 4_000.0)
                };
                let (a, b) = (step(&from_file, &mut ours), step(&statics, &mut theirs));
                if format!("{a:?}") != format!("{b:?}") || bits(&ours) != bits(&theirs) {
                    return false;
                }
            }
            true
        });
        assert!(parts.iter().all(|same| *same), "{name}: another tick");
        // What the host makes of it bakes to the same file.
        let read = BakedFile::read(&bytes).unwrap();
        assert!(file::write(read.source, &read.model, &read.body).unwrap() == bytes, "{name}: another file");
        // What the board's programs have compiled in.
        if COMMITTED.contains(&name) {
            let committed = fs::read(palpate_suites::repository("boards/bodies").join(name).with_extension("palp"));
            let committed = committed.unwrap();
            // All but the hash of the model's text, which no board reads.
            let source = BakedFile::read(&committed).unwrap().source;
            assert!(
                committed == file::write(source, &model, &baked).unwrap(),
                "boards/bodies/{name}.palp has drifted: cargo palpate bake {name} --out boards/bodies/{name}.palp"
            );
        }
        println!("{name}: {PROBES} probes and {TICKS} ticks the same, {:.1} s", begun.elapsed().as_secs_f64());
        measured_if_listed(&format!("bytes of the file of `{name}`"), grouped(bytes.len() as u64));
        measured_if_listed(&format!("RAM for the file of `{name}`"), grouped(room(&baked) as u64));
    }
}

/// The tables that are compiled in, against the file.
mod compiled {
    include!("../../../../boards/bodies/capped_box.rs");
}

#[test]
fn the_committed_statics_have_the_crc_of_the_file() {
    let scene = Scene::located("capped_box", BakedBody::locator_options);
    assert_eq!((compiled::BODY.baked_crc(), compiled::BODY.table_crc()), (scene.body.baked_crc(), compiled::TABLE_CRC));
    let nearest = compiled::BODY.locate(Vec3::splat(0.05));
    assert_eq!(nearest, scene.body.locate(Vec3::splat(0.05)));
    assert_eq!(align_of::<Aligned<[u8; 3]>>(), 4);
}
