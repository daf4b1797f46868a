//! Bodies that cut each other or themselves, lie in each other, share a face or are open are said to, by the names of
//! their faces.

use palpate_bake::flaws::{self, Flaw};
use palpate_bake::{BakedBody, Model};
use palpate_cad::{Options, import};
use std::path::PathBuf;

/// What `check` and `bake` find, in their words.
fn said(part: &str) -> Result<Vec<(Flaw, String)>, String> {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/parts/{part}.step"));
    let imported = import(&file, &Options::default()).map_err(|error| error.to_string())?;
    let model = Model::parse(&imported.model, part).map_err(|error| error.to_string())?;
    let body = BakedBody::new(&model, part).map_err(|error| error.to_string())?;
    let surfaces: Vec<_> = body.faces.iter().map(|face| face.surface.clone()).collect();
    let labels = body.labels(&model);
    let words = |flaw: Flaw| {
        let words = flaw.describe(&|index| labels[index].clone(), model.centre, model.unit);
        (flaw, words)
    };
    Ok(flaws::find(&surfaces, &body.topology).into_iter().map(words).collect())
}

#[test]
fn bodies_that_cut_each_other() {
    let said = said("overlapping").unwrap();
    let [(Flaw::Crossing { .. }, words)] = &said[..] else { panic!("{said:?}") };
    assert!(words.contains("\"face ") && words.contains("cut each other near"), "{words}");
}

#[test]
fn a_body_in_another() {
    let said = said("nested").unwrap();
    let [(Flaw::Nested { inside: 1, hollow: false, .. }, words)] = &said[..] else { panic!("{said:?}") };
    assert!(words.contains("\"face 7\" lies in another piece"), "{words}");
}

#[test]
fn a_pipe_that_passes_through_itself() {
    let said = said("crossing_itself").unwrap();
    let crossing = said.iter().find(|(flaw, _)| matches!(flaw, Flaw::Crossing { .. }));
    let Some((_, words)) = crossing else { panic!("{said:?}") };
    assert!(words.contains("\"face "), "{words}");
}

#[test]
fn bodies_that_share_a_face_are_refused() {
    let message = said("sharing_a_face").unwrap_err();
    assert!(message.matches("face ").count() >= 2, "{message}");
}

#[test]
fn an_open_shell() {
    let said = said("s12").unwrap();
    let [(Flaw::Open { .. }, words)] = &said[..] else { panic!("{said:?}") };
    assert!(words.starts_with("the body is open"), "{words}");
}

/// What is sound is not said to be anything else: two solids side by side among it.
#[test]
fn nothing_of_sound_parts() {
    for part in ["s02", "s05", "s11"] {
        assert_eq!(said(part).unwrap(), [], "{part}");
    }
}
