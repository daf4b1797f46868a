//! Newton's method for `½ ‖f(u, v) − Q‖²`, in single precision with second derivatives, one evaluation an iteration: as
//! a textbook has it, and with the safeguards it needs.
//!
//! Both answer with parameters: the evaluation at the answer, which a force needs, is not asked of them.

use crate::contestant::{Answer, Contestant};
use crate::horner::{Biquadratic, Derivatives};
use crate::ours;
use crate::scene::{Probe, Scene};
use palpate::math::Vec3;

/// Cells along each parameter; a cold start evaluates the patch at their centres.
const CELLS: usize = 8;
/// Converged when neither parameter moves by more: the remaining error is about its square, and `f32` resolves 6e-8.
const SETTLED: f32 = 1e-5;
/// Iterations of a cold search, and of one row of a track.
const COLD_ITERATIONS: usize = 20;
const TRACK_ITERATIONS: usize = 8;
/// Halvings of a step that leads farther away.
const HALVINGS: usize = 8;

/// The nearest cell, then the textbook's iteration.
pub fn cold(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    Ok(Box::new(Cold { patch: Biquadratic::new(scene), seeds: Seeds::new(scene), is_safeguarded: false }))
}

/// From every cell nearer than its neighbours, with safeguards.
pub fn cold_safeguarded(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    Ok(Box::new(Cold { patch: Biquadratic::new(scene), seeds: Seeds::new(scene), is_safeguarded: true }))
}

/// From the last answer, one iteration a row.
pub fn one_step(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct OneStep(Biquadratic, [f32; 2]);
    impl Contestant for OneStep {
        fn answer(&mut self, probe: &Probe) -> Answer {
            self.1 = textbook_step(&self.0, self.1, Vec3::from_array(probe.single));
            Answer::Parameters(self.1.map(f64::from))
        }
    }
    Ok(Box::new(OneStep(Biquadratic::new(scene), ours::start(scene).parameters)))
}

/// From the last answer, until it has settled.
pub fn track(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Track(Biquadratic, [f32; 2]);
    impl Contestant for Track {
        fn answer(&mut self, probe: &Probe) -> Answer {
            self.1 = textbook(&self.0, self.1, Vec3::from_array(probe.single), TRACK_ITERATIONS);
            Answer::Parameters(self.1.map(f64::from))
        }
    }
    Ok(Box::new(Track(Biquadratic::new(scene), ours::start(scene).parameters)))
}

/// The same with safeguards.
pub fn track_safeguarded(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Track(Biquadratic, [f32; 2]);
    impl Contestant for Track {
        fn answer(&mut self, probe: &Probe) -> Answer {
            self.1 = safeguarded(&self.0, self.1, Vec3::from_array(probe.single), TRACK_ITERATIONS).0;
            Answer::Parameters(self.1.map(f64::from))
        }
    }
    Ok(Box::new(Track(Biquadratic::new(scene), ours::start(scene).parameters)))
}

struct Cold {
    patch: Biquadratic,
    seeds: Seeds,
    is_safeguarded: bool,
}

impl Contestant for Cold {
    fn answer(&mut self, probe: &Probe) -> Answer {
        let probe = Vec3::from_array(probe.single);
        let squares = self.seeds.points.map(|row| row.map(|point| point.distance_squared(probe)));
        let parameters = if self.is_safeguarded {
            let mut best = ([0.5; 2], f32::INFINITY);
            for (row, column) in local_minima(&squares) {
                let found = safeguarded(&self.patch, centre(row, column), probe, COLD_ITERATIONS);
                if found.1 < best.1 {
                    best = found;
                }
            }
            best.0
        } else {
            let mut nearest = (0, 0);
            for row in 0..CELLS {
                for column in 0..CELLS {
                    if squares[row][column] < squares[nearest.0][nearest.1] {
                        nearest = (row, column);
                    }
                }
            }
            textbook(&self.patch, centre(nearest.0, nearest.1), probe, COLD_ITERATIONS)
        };
        Answer::Parameters(parameters.map(f64::from))
    }
}

/// Points of the patch at the cells' centres, kept.
struct Seeds {
    points: [[Vec3; CELLS]; CELLS],
}

impl Seeds {
    fn new(scene: &Scene) -> Self {
        let patch = Biquadratic::new(scene);
        let point = |row, column| patch.point(centre(row, column));
        Self { points: std::array::from_fn(|row| std::array::from_fn(|column| point(row, column))) }
    }
}

fn centre(row: usize, column: usize) -> [f32; 2] {
    [row, column].map(|index| (index as f32 + 0.5) / CELLS as f32)
}

/// Cells that are not farther than any neighbour.
fn local_minima(squares: &[[f32; CELLS]; CELLS]) -> impl Iterator<Item = (usize, usize)> {
    let is_minimum = |row: usize, column: usize| {
        let near = |index: usize| index.saturating_sub(1)..(index + 2).min(CELLS);
        near(row).all(|r| near(column).all(|c| squares[row][column] <= squares[r][c]))
    };
    (0..CELLS * CELLS).map(|index| (index / CELLS, index % CELLS)).filter(move |&(row, column)| is_minimum(row, column))
}

/// Until it has settled, each parameter clamped by itself.
fn textbook(patch: &Biquadratic, mut at: [f32; 2], probe: Vec3, iterations: usize) -> [f32; 2] {
    for _ in 0..iterations {
        let next = textbook_step(patch, at, probe);
        let has_settled = (next[0] - at[0]).abs() <= SETTLED && (next[1] - at[1]).abs() <= SETTLED;
        at = next;
        if has_settled {
            break;
        }
    }
    at
}

/// `x − H⁻¹ g`, with `H = I + ΔR · D²f`.
#[inline]
fn textbook_step(patch: &Biquadratic, at: [f32; 2], probe: Vec3) -> [f32; 2] {
    let local = Local::new(&patch.evaluate(at), probe);
    let [step_u, step_v] = solve(local.hessian, local.gradient);
    [(at[0] + step_u).clamp(0.0, 1.0), (at[1] + step_v).clamp(0.0, 1.0)]
}

/// Projected Newton: Gauss–Newton where the Hessian is not positive definite, parameters that press outward held, a
/// step that leads farther away halved. The answer and its squared distance.
fn safeguarded(patch: &Biquadratic, mut at: [f32; 2], probe: Vec3, iterations: usize) -> ([f32; 2], f32) {
    let mut surface = patch.evaluate(at);
    let mut squared = surface.point.distance_squared(probe);
    for _ in 0..iterations {
        let step = projected_step(&Local::new(&surface, probe), at);
        if step[0].abs() <= SETTLED && step[1].abs() <= SETTLED {
            // Too short to look whether it is one: close to the answer it is.
            at = [0, 1].map(|i| (at[i] + step[i]).clamp(0.0, 1.0));
            break;
        }
        let mut length = 1.0;
        let mut moved = false;
        for _ in 0..HALVINGS {
            let next = [0, 1].map(|i| (at[i] + length * step[i]).clamp(0.0, 1.0));
            let there = patch.evaluate(next);
            let now = there.point.distance_squared(probe);
            if now < squared {
                (at, surface, squared, moved) = (next, there, now, true);
                break;
            }
            length *= 0.5;
        }
        if !moved {
            break;
        }
    }
    (at, squared)
}

fn projected_step(local: &Local, at: [f32; 2]) -> [f32; 2] {
    let is_outward = |i: usize, step: f32| (at[i] <= 0.0 && step < 0.0) || (at[i] >= 1.0 && step > 0.0);
    let [a, b, c] = local.hessian;
    let is_positive = a > 0.0 && a * c > b * b;
    let step = solve(if is_positive { local.hessian } else { local.form }, local.gradient);
    let alone = |i: usize| {
        let curved = local.hessian[2 * i];
        let slide = -local.gradient[i] / if curved > 0.0 { curved } else { local.form[2 * i] };
        if is_outward(i, slide) { 0.0 } else { slide }
    };
    match [is_outward(0, step[0]), is_outward(1, step[1])] {
        [false, false] => step,
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        // On a skewed patch one edge may be open although both were asked for.
        [true, true] => {
            let slide = alone(0);
            if slide != 0.0 { [slide, 0.0] } else { [0.0, alone(1)] }
        }
    }
}

/// The problem at a point: symmetric matrices as `[uu, uv, vv]`.
struct Local {
    gradient: [f32; 2],
    form: [f32; 3],
    hessian: [f32; 3],
}

impl Local {
    #[inline]
    fn new(surface: &Derivatives, probe: Vec3) -> Self {
        let difference = surface.point - probe;
        let [f_u, f_v] = surface.first;
        let form = [f_u.dot(f_u), f_u.dot(f_v), f_v.dot(f_v)];
        let [uu, uv, vv] = surface.second.map(|second| difference.dot(second));
        Self {
            gradient: [difference.dot(f_u), difference.dot(f_v)],
            form,
            hessian: [form[0] + uu, form[1] + uv, form[2] + vv],
        }
    }
}

/// `−M⁻¹ g`.
#[inline]
fn solve([a, b, c]: [f32; 3], [g_u, g_v]: [f32; 2]) -> [f32; 2] {
    let inverse = 1.0 / (a * c - b * b);
    [(b * g_v - c * g_u) * inverse, (b * g_u - a * g_v) * inverse]
}
