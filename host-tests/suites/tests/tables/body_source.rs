//! Bodies as Rust source and as a graph.

use palpate::body::{Effort, TickLimit};
use palpate_bake::source::{Origin, body_source};
use palpate_bake::{BakedBody, Model, graph};
use palpate_truth::generate::models::half_ball;
use std::error::Error;

fn baked(limit: TickLimit) -> Result<(String, BakedBody), Box<dyn Error>> {
    let text = half_ball();
    let model = Model::parse(&text, "half_ball.toml")?;
    let body = BakedBody::new(&model, "half_ball.toml")?;
    let origin = Origin {
        model_file: "half_ball.toml",
        out_file: "half_ball.rs",
        model: text.as_bytes(),
        centre: model.centre,
        limit,
    };
    Ok((body_source(&origin, &body, &body.labels(&model))?, body))
}

#[test]
fn the_source_is_the_same_to_the_byte_with_the_edges_of_the_body() -> Result<(), Box<dyn Error>> {
    use palpate::body::EdgeKind::{Convex, Smooth};
    let (source, body) = baked(TickLimit::BENCH)?;
    assert_eq!(baked(TickLimit::BENCH)?.0, source);
    assert!(source.contains(&format!("pub const TABLE_CRC: u32 = {};", body.to_body()?.table_crc())), "{source}");
    // A rim that is sharp all along, and nothing else: 4 arcs; 4 meridians and 4 radii are smooth.
    assert_eq!([Convex, Smooth].map(|kind| body.topology.count(kind)), [4, 8]);
    Ok(())
}

#[test]
fn the_body_of_the_source_has_the_effort_that_keeps_its_limit() -> Result<(), Box<dyn Error>> {
    let tables = baked(TickLimit::BENCH)?.1.to_body()?;
    let tight =
        TickLimit { cycles: tables.with_effort(Effort { steps: 2, candidates: 1 }).worst_cycles(), ..TickLimit::BENCH };
    for limit in [TickLimit::BENCH, tight, TickLimit::NONE] {
        let (source, _) = baked(limit)?;
        let effort @ Effort { steps, candidates } = tables.fitted(limit).effort();
        assert_eq!(effort == Effort::BENCH, limit == TickLimit::NONE, "{effort:?}");
        let call = format!(".with_effort(palpate::body::Effort{{steps:{steps},candidates:{candidates},}});");
        assert!(source.split_whitespace().collect::<String>().contains(&call), "{call}: {source}");
    }
    Ok(())
}

#[test]
fn the_graph_has_the_transitions_of_the_features() -> Result<(), Box<dyn Error>> {
    // A box: each of 12 edges between 2 faces and 2 vertices. Smooth: each of 12 edges a handing over between two
    // faces.
    for (name, transitions, vertices) in [("thin_plate", 12 * 4, 8), ("sphere_body", 12, 0)] {
        let body = BakedBody::new(&palpate_suites::model(name), name)?;
        let labels: Vec<_> = (0..6).map(|face| format!("the \"{face}\"\n")).collect();
        let text = graph::graph(&body, name, &labels);
        assert_eq!(text.matches(" -- ").count(), transitions, "{text}");
        assert_eq!(text.matches("shape = point").count(), vertices);
        assert_eq!(text.matches("shape = box").count(), 6);
        assert!(text.contains(r#"label = "the \"3\" ""#), "{text}");
    }
    Ok(())
}
