//! A tool with a shape on a simulated gimbal, that the hand of a run turns.

use anyhow::{Context as _, ensure};
use glam::Vec3 as Axis;
use palpate::body::Body;
use palpate::device::{Encoder, Wrist};
use palpate::math::Vec3;
use palpate::pair::{Core, Tool, ToolSurface};
use palpate::servo::Settings;
use std::f64::consts::TAU;

/// Yaw, pitch and roll about the probe, 4,096 counts a turn.
pub const GIMBAL: Wrist = Wrist {
    axes: [Vec3::Z, Vec3::Y, Vec3::X],
    encoders: [Encoder::geared(COUNTS as f32, 1.0, 0.0); 3],
    range_rad: [[-2.5, 2.5], [-1.2, 1.2], [-2.6, 2.6]],
    max_rate_rad_per_s: 30.0,
};
const COUNTS: f64 = 4_096.0;

/// How far the hand turns each axis to and fro, radians.
const SWING_RAD: [f64; 3] = [0.3, 0.25, 0.4];

/// The tool of a run.
#[derive(Clone, Copy, Debug)]
pub struct ShapedTool {
    core: CoreOf,
    radius_m: f32,
    /// Largest speed of the hand's turns, rad/s.
    turn: f64,
    friction: f32,
}

/// Half lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoreOf {
    /// Of a ball.
    Point,
    /// Along z.
    Segment(f32),
    /// Along x, y and z.
    Box([f32; 3]),
}

/// A core from the command line, in mm.
///
/// # Errors
/// A form that is not among these, or a length that is not above 0.
pub fn core(text: &str) -> Result<CoreOf, String> {
    let (kind, lengths) = text.split_once(':').unwrap_or((text, ""));
    let half: Option<Vec<f64>> = match lengths {
        "" => Some(Vec::new()),
        lengths => lengths.split(',').map(|number| number.trim().parse().ok()).collect(),
    };
    let half = half.filter(|half| half.iter().all(|length| length.is_finite() && *length > 0.0));
    let metres = |half: f64| (half * 1e-3) as f32;
    match (kind, half.as_deref()) {
        ("point", Some([])) => Ok(CoreOf::Point),
        ("capsule", Some([])) => Ok(CoreOf::Segment(0.009)),
        ("segment", Some([half])) => Ok(CoreOf::Segment(metres(*half))),
        ("box", Some([x, y, z])) => Ok(CoreOf::Box([*x, *y, *z].map(metres))),
        _ => {
            Err("give point, capsule (segment:9), segment:H along z or box:X,Y,Z: half lengths in mm, above 0"
                .to_owned())
        }
    }
}

impl ShapedTool {
    /// A core, its radius in mm, how fast the hand turns it, rad/s, and its coefficient of friction.
    ///
    /// # Errors
    /// A radius, speed or coefficient that is none.
    pub fn new(core: CoreOf, radius_mm: f32, turn: f64, friction: f32) -> anyhow::Result<Self> {
        // Half of what the gimbal takes for a fault.
        ensure!((0.0..=15.0).contains(&turn), "--turn {turn}: a hand turns a tool by 0 to 15 rad/s");
        ensure!((0.0..=2.0).contains(&friction), "--friction {friction}: give a coefficient from 0 to 2");
        let tool = Self { core, radius_m: radius_mm * 1e-3, turn, friction };
        tool.tool().with_context(|| format!("--radius {radius_mm}"))?;
        Ok(tool)
    }

    fn tool(&self) -> anyhow::Result<Tool<'static>> {
        let core = match self.core {
            CoreOf::Point => Core::Point,
            CoreOf::Segment(half) => Core::Segment { half },
            CoreOf::Box(half) => Core::Box { half },
        };
        Ok(Tool::new(core, self.radius_m)?)
    }

    /// The surface of a loop.
    ///
    /// # Errors
    /// A tool too thin for these settings.
    pub fn on(
        &self,
        body: &'static Body<'static>,
        settings: &Settings,
    ) -> anyhow::Result<&'static ToolSurface<'static>> {
        let surface = ToolSurface::new(body, self.tool()?, settings).context("the tool on this body (--radius)")?;
        Ok(Box::leak(Box::new(surface.with_friction(self.friction)?)))
    }

    /// How far from the body the probe is where the hand aims at its surface, metres: half of the core sticks out.
    pub fn stand_off_m(&self) -> f64 {
        let reach = match self.core {
            CoreOf::Point => 0.0,
            CoreOf::Segment(half) => half,
            CoreOf::Box(half) => Axis::from_array(half).length(),
        };
        f64::from(self.radius_m + 0.5 * reach)
    }

    /// Counts of the gimbal's axes at a time, s.
    pub fn counts(&self, time: f64) -> [i32; 3] {
        let share = self.turn / 3.0_f64.sqrt();
        SWING_RAD.map(|swing| (swing * (share / swing * time).sin() * COUNTS / TAU).floor() as i32)
    }

    /// The surface of an image, from the source of its body.
    pub fn source(&self, body: &str, settings: &Settings) -> String {
        let core = match self.core {
            CoreOf::Point => "Point".to_owned(),
            CoreOf::Segment(half) => format!("Segment {{ half: {half:?} }}"),
            CoreOf::Box(half) => format!("Box {{ half: {half:?} }}"),
        };
        let Settings { rate_hz, stiffness_n_per_m, .. } = settings;
        format!(
            "#[allow(dead_code, unused_imports)]\nmod rest {{\n{body}\n}}\npub use rest::TABLE_CRC;\n\
             /// The type of the surface.\npub type Surface = palpate::pair::ToolSurface<'static>;\n\
             /// The tool on the body.\npub const fn with_effort(_: palpate::body::Effort) -> Surface {{\n    \
             use palpate::{{pair::{{Core, Tool}}, servo::Settings}};\n    \
             let Ok(tool) = Tool::new(Core::{core}, {:?}) else {{ panic!(\"tool\") }};\n    \
             let settings = Settings {{ rate_hz: {rate_hz:?}, stiffness_n_per_m: {stiffness_n_per_m:?}, ..Settings::DEFAULT }};\n    \
             let Ok(surface) = Surface::new(&rest::BODY, tool, &settings) else {{ panic!(\"tool on body\") }};\n    \
             let Ok(surface) = surface.with_friction({:?}) else {{ panic!(\"friction\") }};\n    \
             surface\n}}\n",
            self.radius_m, self.friction
        )
    }

    /// In words.
    pub fn name(&self) -> String {
        let friction = if self.friction > 0.0 { format!(", friction {}", self.friction) } else { String::new() };
        format!("{}{friction}, on a gimbal; turned at up to {} rad/s", self.shape(), self.turn)
    }

    /// Its shape alone.
    pub fn shape(&self) -> String {
        let mm = |length: f32| (f64::from(length) * 1e6).round() / 1e3;
        let radius = mm(self.radius_m);
        let core = match self.core {
            CoreOf::Point => "ball".to_owned(),
            CoreOf::Segment(half) => format!("capsule, half length {} mm", mm(half)),
            CoreOf::Box([x, y, z]) => format!("box, half lengths {} × {} × {} mm", mm(x), mm(y), mm(z)),
        };
        format!("{core}, radius {radius} mm")
    }
}

/// [`GIMBAL`] as source.
pub fn wrist_source() -> String {
    let Wrist { axes, encoders, range_rad, max_rate_rad_per_s } = GIMBAL;
    let axes = axes.map(|Vec3 { x, y, z }| format!("palpate::math::vec3({x:?}, {y:?}, {z:?})")).join(", ");
    let encoders = encoders
        .map(|encoder| format!("palpate::device::Encoder {encoder:?}").replacen("Encoder Encoder", "Encoder", 1))
        .join(", ");
    format!(
        "/// The gimbal under the handle.\npub const WRIST: palpate::device::Wrist = palpate::device::Wrist {{ axes: [{axes}], \
         encoders: [{encoders}], range_rad: {range_rad:?}, max_rate_rad_per_s: {max_rate_rad_per_s:?} }};\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_core_is_read_in_millimetres_or_refused() {
        assert_eq!(core("capsule"), core("segment:9"));
        assert_eq!(core("box:9, 6,3"), Ok(CoreOf::Box([0.009, 0.006, 0.003])));
        for bad in ["segment", "segment:0", "segment:-1", "segment:x", "box:1,2", "point:1", "box:1,2,NaN", "drill"] {
            assert!(core(bad).is_err_and(|error| error.contains("half lengths in mm")), "{bad}");
        }
    }

    #[test]
    fn a_hand_turns_no_faster_than_it_is_asked_to() {
        let tool = ShapedTool::new(CoreOf::Point, 3.0, 6.0, 0.0).expect("a tool");
        let angles = |time: f64| tool.counts(time).map(|count| f64::from(count) * TAU / COUNTS);
        let speeds = (0..40_000).map(|tick| {
            let [now, then] = [f64::from(tick), f64::from(tick) + 100.0].map(|tick| angles(tick * 1e-4));
            (0..3).map(|axis| ((then[axis] - now[axis]) / 0.01).powi(2)).sum::<f64>().sqrt()
        });
        let fastest = speeds.fold(0.0, f64::max);
        // A count in 10 ms is 0.15 rad/s an axis.
        assert!((4.0..6.3).contains(&fastest), "{fastest}");
    }
}
