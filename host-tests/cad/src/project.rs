//! Feet of perpendiculars: the parameters of the point of a surface that is nearest to a point near it.

use crate::nurbs::Surface;
use glam::{DVec2, DVec3};

/// Newton's steps before giving up; from a guess on the same sheet four are usual.
const STEPS: usize = 30;

/// The tangent round a pole, as a part of the other, where a point lies on the pole: about a nanometre off it.
const AT_POLE: f64 = 1e-7;

/// Result of [`Surface::project`].
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// Its parameters; of a closed surface those near the guess, which may lie outside the range.
    pub uv: DVec2,
    /// Its position.
    pub point: DVec3,
    /// How far the point was from it.
    pub distance: f64,
}

impl Surface {
    /// The foot near a guess: Newton's method on the squared distance, Gauss's where that is not convex, halved until
    /// it falls.
    pub fn project(&self, point: DVec3, guess: DVec2) -> Foot {
        let mut uv = self.kept(guess);
        let mut jet = self.at(uv);
        let mut best = jet.point.distance_squared(point);
        for _ in 0..STEPS {
            let off = jet.point - point;
            let [su, sv] = jet.first;
            let gradient = DVec2::new(off.dot(su), off.dot(sv));
            let gauss = [su.dot(su), su.dot(sv), sv.dot(sv)];
            let newton = [0, 1, 2].map(|k| gauss[k] + off.dot(jet.second[k]));
            let Some(mut step) =
                solve(newton, gradient).or_else(|| solve(gauss, gradient)).or_else(|| slope(gauss, gradient))
            else {
                break;
            };
            // At a pole nothing holds the parameter round it but rounding, which would lead anywhere.
            for (axis, [own, other]) in [[gauss[0], gauss[2]], [gauss[2], gauss[0]]].into_iter().enumerate() {
                if own <= AT_POLE * AT_POLE * other {
                    step[axis] = 0.0;
                }
            }
            let mut share = 1.0;
            let moved = loop {
                let next = self.kept(uv - step * share);
                let there = self.at(next);
                let distance = there.point.distance_squared(point);
                if distance < best {
                    let moved = next - uv;
                    (uv, jet, best) = (next, there, distance);
                    break moved;
                }
                share *= 0.4;
                if share < 1e-4 {
                    break DVec2::ZERO;
                }
            };
            let length = jet.first[0].length() * moved.x.abs() + jet.first[1].length() * moved.y.abs();
            if length < 1e-12 * (1.0 + jet.point.length()) {
                break;
            }
        }
        Foot { uv, point: jet.point, distance: best.sqrt() }
    }

    /// The foot from nowhere: the best of a grid first.
    pub fn locate(&self, point: DVec3) -> Foot {
        let feet = self.starts(point).into_iter().take(4).map(|uv| self.project(point, uv));
        feet.min_by(|a, b| a.distance.total_cmp(&b.distance)).unwrap_or(Foot {
            uv: DVec2::ZERO,
            point: DVec3::ZERO,
            distance: f64::INFINITY,
        })
    }

    /// The foot near a guess; where that is farther off than `limit`, as on the wrong turn of a thread, the foot within
    /// it that is nearest to the guess.
    pub fn project_within(&self, point: DVec3, guess: DVec2, limit: f64) -> Foot {
        let near = self.project(point, guess);
        if near.distance <= limit {
            return near;
        }
        let around = |mut foot: Foot| {
            for axis in (0..2).filter(|axis| self.closed[*axis]) {
                foot.uv[axis] += ((guess[axis] - foot.uv[axis]) / self.period(axis)).round() * self.period(axis);
            }
            foot
        };
        let far = |foot: &Foot| {
            let way = (foot.uv - guess).abs();
            (way.x / self.period(0)).max(way.y / self.period(1))
        };
        let feet = self.starts(point).into_iter().take(64).map(|uv| around(self.project(point, uv)));
        let within = feet.filter(|foot| foot.distance <= limit);
        within.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(near)
    }

    /// A grid of parameters, those of the nearest points first.
    fn starts(&self, point: DVec3) -> Vec<DVec2> {
        let lines = [0, 1].map(|axis| {
            let knots = &self.knots[axis][self.degree[axis]..=self.counts[axis]];
            let spans = knots.windows(2).filter(|pair| pair[0] < pair[1]);
            spans
                .flat_map(|pair| (0..6).map(|k| pair[0] + (pair[1] - pair[0]) * (f64::from(k) + 0.5) / 6.0))
                .collect::<Vec<_>>()
        });
        let all = lines[0].iter().flat_map(|u| lines[1].iter().map(|v| DVec2::new(*u, *v)));
        let mut starts: Vec<_> = all.map(|uv| (self.at(uv).point.distance_squared(point), uv)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.into_iter().map(|(_, uv)| uv).collect()
    }

    /// Into the range of each parameter that does not close.
    fn kept(&self, uv: DVec2) -> DVec2 {
        let keep = |axis: usize, value: f64| {
            let [low, high] = self.range(axis);
            if self.closed[axis] { value } else { value.clamp(low, high) }
        };
        DVec2::new(keep(0, uv.x), keep(1, uv.y))
    }
}

/// The solution of a symmetric positive system, if it is one.
fn solve([a, b, c]: [f64; 3], right: DVec2) -> Option<DVec2> {
    let determinant = a * c - b * b;
    let is_positive = a > 0.0 && c > 0.0 && determinant > 1e-12 * a * c;
    is_positive.then(|| DVec2::new(c * right.x - b * right.y, a * right.y - b * right.x) / determinant)
}

/// Down the slope, each parameter by itself: all that is left beside a pole.
fn slope([a, _, c]: [f64; 3], gradient: DVec2) -> Option<DVec2> {
    let along = |square: f64, value: f64| if square > 1e-24 { value / square } else { 0.0 };
    let step = DVec2::new(along(a, gradient.x), along(c, gradient.y));
    (step != DVec2::ZERO).then_some(step)
}
