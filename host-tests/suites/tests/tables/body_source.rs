//! Bodies as Rust source and as a graph.

use palpate_bake::source::{Origin, body_source};
use palpate_bake::{BakedBody, Model, graph};
use std::error::Error;
use std::fs;

/// The source of a body with rational faces, planes, ruled separators and poles, as firmware takes it.
mod compiled {
    include!("../../data/half_ball.rs");
}

/// The upper half of a ball on a disc: four octants with a pole, and a bottom of four sectors with one.
fn half_ball() -> String {
    let weight = std::f64::consts::FRAC_1_SQRT_2;
    let quarter = |turns: usize| {
        [[1.0, 0.0, 1.0], [1.0, 1.0, weight], [0.0, 1.0, 1.0]].map(|[x, y, w]| match turns {
            0 => [x, y, w],
            1 => [-y, x, w],
            2 => [-x, -y, w],
            _ => [y, -x, w],
        })
    };
    let mut text = "name = \"half-ball\"\nunit = \"mm\"\n".to_owned();
    for turns in 0..4 {
        let arc = quarter(turns);
        let row = |[x, y, w]: [f64; 3]| {
            let along =
                quarter(0).map(|[r, z, v]| format!("[{}, {}, {}, {}]", 30.0 * x * r, 30.0 * y * r, 30.0 * z, w * v));
            format!("[{}]", along.join(", "))
        };
        let ball = arc.map(row).join(", ");
        text += &format!("[[patch]]\nname = \"ball{turns}\"\ndegree = [2, 2]\npoints = [{ball}]\n");
        let row = |[x, y, w]: [f64; 3]| format!("[[{}, {}, 0, {w}], [0, 0, 0, {w}]]", 30.0 * x, 30.0 * y);
        let disc = arc.map(row).join(", ");
        text += &format!("[[patch]]\nname = \"disc{turns}\"\nflip = true\ndegree = [2, 1]\npoints = [{disc}]\n");
    }
    text
}

fn baked() -> Result<(String, BakedBody), Box<dyn Error>> {
    let text = half_ball();
    let model = Model::parse(&text, "half_ball.toml")?;
    let body = BakedBody::new(&model, "half_ball.toml")?;
    let origin =
        Origin { model_file: "half_ball.toml", out_file: "half_ball.rs", model: text.as_bytes(), centre: model.centre };
    Ok((body_source(&origin, &body, &body.labels(&model))?, body))
}

#[test]
fn the_compiled_source_has_the_bits_of_the_baked_body() -> Result<(), Box<dyn Error>> {
    let (source, body) = baked()?;
    let file = palpate_suites::data("half_ball.rs");
    if std::env::var_os("PALPATE_WRITE").is_some() {
        fs::write(&file, &source)?;
    }
    let again = "data/half_ball.rs has drifted: PALPATE_WRITE=1 cargo test -p palpate-suites --test tables body_source";
    assert!(fs::read_to_string(file)? == source, "{again}");
    assert_eq!(baked()?.0, source, "the same to the byte");
    let crc = body.to_body()?.table_crc();
    assert_eq!((compiled::TABLE_CRC, compiled::BODY.table_crc()), (crc, crc));
    assert_eq!(compiled::BODY.baked_crc(), Some(crc), "what the loop compares with");
    // What a board takes, whatever the model.
    let surface: &compiled::Surface = compiled::SURFACE;
    assert_eq!((surface.table_crc(), surface.faces().len()), (crc, 8));
    // A rim that is sharp all along, and nothing else: 4 arcs; 4 meridians and 4 radii are smooth.
    use palpate::body::EdgeKind::{Convex, Smooth};
    assert_eq!([Convex, Smooth].map(|kind| body.topology.count(kind)), [4, 8]);
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
