//! Models of whole bodies, exact, as text of model files: those that ship in `host-tests/models` and are written by
//! `PALPATE_WRITE=1 cargo test -p palpate-suites --test tables models`.

mod cube_sphere;
mod cuboid;
mod octants;
mod plate;
mod rounded_box;
mod rounded_cylinder;
mod text;

pub use cuboid::{Corner, cuboid, moved};
pub use rounded_box::rounded_box;

/// A model file that ships.
#[derive(Clone, Debug)]
pub struct GeneratedModel {
    /// Its name, without a directory.
    pub file: &'static str,
    /// What stands in it.
    pub text: String,
}

/// Half axes of both ellipsoids, mm.
pub const HALF_AXES: [f64; 3] = [50.0, 35.0, 25.0];
/// Radius of the sphere, mm.
pub const RADIUS: f64 = 50.0;

/// The text of an ellipsoid's model file, without poles: six patches of degree (4, 4). Half axes in millimetres.
pub fn ellipsoid(name: &str, half_axes: [f64; 3]) -> String {
    text::model(&format!("An ellipsoid with half axes {half_axes:?} mm."), name, &cube_sphere::patches(half_axes))
}

/// All of them.
pub fn all() -> Vec<GeneratedModel> {
    let poles = "without poles: six patches of degree (4, 4), a cube blown up to a sphere (host-tests/truth/src/generate/models/cube_sphere.rs).";
    vec![
        GeneratedModel {
            file: "sphere_body.toml",
            text: text::model(
                &format!("A sphere of radius {RADIUS} mm, exact and {poles}"),
                "sphere-body",
                &cube_sphere::patches([RADIUS; 3]),
            ),
        },
        GeneratedModel {
            file: "ellipsoid_body.toml",
            text: text::model(
                &format!("An ellipsoid with half axes 50, 35 and 25 mm, exact and {poles}"),
                "ellipsoid-body",
                &cube_sphere::patches(HALF_AXES),
            ),
        },
        GeneratedModel {
            file: "ellipsoid_poles.toml",
            text: text::model(
                "The same ellipsoid, half axes 50, 35 and 25 mm, from eight octants of degree (2, 2) that meet in two poles.",
                "ellipsoid-poles",
                &octants::patches(HALF_AXES),
            ),
        },
        GeneratedModel {
            file: "rounded_cylinder.toml",
            text: text::model(
                "A cylinder of radius 30 mm and height 50 mm about z whose rims are rounded by 8 mm: all edges are smooth. Exact; four \
                 sectors, and each cap is a square with four patches around it, so that there are no poles.",
                "rounded-cylinder",
                &rounded_cylinder::patches(rounded_cylinder::SHAPE),
            ),
        },
        GeneratedModel {
            file: "thin_plate.toml",
            text: text::model("A plate of 60 x 40 x 2 mm.", "thin-plate", &plate::patches([60.0, 40.0, 2.0])),
        },
    ]
}
