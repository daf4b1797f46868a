//! Contestants, in the order of the table. A new contestant is a file with one or two functions, and its lines here.

use crate::contestant::{Answer, Contestant, Enter};
use crate::scene::{Probe, Scene};
use crate::{newton, ours};
#[cfg(feature = "peers")]
use crate::{parry, truck};

/// Every query by itself.
pub fn cold() -> Vec<(&'static str, Enter)> {
    #[cfg_attr(not(feature = "peers"), expect(unused_mut, reason = "only peers are added"))]
    let mut entries: Vec<(&'static str, Enter)> = vec![
        ("call", nobody),
        ("palpate", ours::cold),
        ("newton", newton::cold),
        ("newton-safeguarded", newton::cold_safeguarded),
    ];
    #[cfg(feature = "peers")]
    entries.extend::<[(&'static str, Enter); 5]>([
        ("truck", truck::cold),
        ("parry-mesh-256", parry::mesh_256),
        ("parry-mesh-128", parry::mesh_128),
        ("parry-mesh-32", parry::mesh_32),
        ("parry-hull", parry::hull),
    ]);
    entries
}

/// The probe moves a little from query to query.
pub fn track() -> Vec<(&'static str, Enter)> {
    #[cfg_attr(not(feature = "peers"), expect(unused_mut, reason = "only peers are added"))]
    let mut entries: Vec<(&'static str, Enter)> = vec![
        ("call", nobody),
        ("palpate", ours::track),
        ("palpate-settled", ours::track_settled),
        ("palpate-first-order", ours::track_to_first_order),
        ("newton-one-step", newton::one_step),
        ("newton", newton::track),
        ("newton-safeguarded", newton::track_safeguarded),
    ];
    // parry takes no hint: each of its queries is by itself.
    #[cfg(feature = "peers")]
    entries.extend::<[(&'static str, Enter); 5]>([
        ("truck", truck::track),
        ("parry-mesh-256", parry::mesh_256),
        ("parry-mesh-128", parry::mesh_128),
        ("parry-mesh-32", parry::mesh_32),
        ("parry-hull", parry::hull),
    ]);
    entries
}

/// Answers nothing: what asking costs.
fn nobody(_: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Nobody;
    impl Contestant for Nobody {
        fn answer(&mut self, _: &Probe) -> Answer {
            Answer::Nothing
        }
    }
    Ok(Box::new(Nobody))
}
