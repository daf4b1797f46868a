//! A wall that gives way.

use palpate::body::{Soft, SoftError};
use palpate::field::Modal;
use palpate::math::Vec3;
use palpate::patch::Patch as _;
use palpate::render::Penalty;
use palpate::servo::{Carrier, SoftBody, SoftContact, Surface as _, ToolContact, Tracked as _};
use palpate::track::{Contact, Controller, Probe};

/// A body that deforms, hit along one line.
#[derive(Clone, Copy, Debug)]
pub struct SoftWall {
    body: SoftBody<'static>,
    period: f32,
    /// Where it is hit at rest, and outwards from there.
    at: Vec3,
    outward: Vec3,
}

/// It during a collision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit<'a> {
    wall: &'a SoftWall,
    state: SoftContact,
}

impl SoftWall {
    /// A body that is hit from this place outside at its closest point, for a loop of this rate, Hz.
    ///
    /// # Errors
    /// A mode that is none, or too fast for the rate.
    pub fn new(soft: Soft<'static>, motion: &[Modal], rate_hz: f32, from: Vec3) -> Result<Self, SoftError> {
        let found = soft.rest().locate(from);
        let [u, v] = found.parameters;
        let at = soft.rest().faces()[usize::from(found.face)].patch.evaluate(u, v).point;
        let body = SoftBody::new(soft, motion, rate_hz)?;
        Ok(Self { body, period: 1.0 / rate_hz, at, outward: (from - at).normalize() })
    }

    /// At rest, with the tracker on its way in front of it.
    pub(super) fn start(&self) -> Hit<'_> {
        let mut hit = Hit { wall: self, state: self.body.rest() };
        // More ticks than a search takes.
        for _ in 0..64 {
            hit.push(&Penalty { stiffness_n_per_m: 0.0, damping_n_s_per_m: 0.0, max_force_n: 0.0 }, 1e-3, 0.0);
        }
        hit
    }
}

impl Hit<'_> {
    /// The push of a tick, N, on a probe at this height over the place at rest, m, and its rate, m/s.
    pub(super) fn push(&mut self, penalty: &Penalty, height: f32, rate: f32) -> f32 {
        let SoftWall { body, period, at, outward } = *self.wall;
        let (position, velocity) = (at + outward * height, outward * rate);
        let touched = body.follow(&Controller::SecondOrder, &mut self.state, Probe { position, velocity }, period);
        let touch = ToolContact {
            gap_m: self.state.gap(),
            normal: touched.normal,
            velocity,
            carrier: Carrier::FIXED,
            period_s: period,
        };
        let touch = (self.state.contact() == Contact::Touching).then_some(touch);
        body.push(&mut self.state, penalty, touch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::named;
    use crate::zwidth::collide::collide_with;
    use crate::zwidth::{Collision, Loop, Slice, Wall, max_stiffness, max_stiffness_on};
    use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face};
    use palpate::device::VelocityMethod;
    use palpate::field::{FieldBounds, Mode, Quadratic};
    use palpate::math::vec3;

    /// A box that is squeezed along x, 1.002 m at its far end by 1 m of the mode, which has 500 N/m.
    fn squeezed(motion: Modal, rate_hz: f32) -> SoftWall {
        static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!("../../../../boards/bodies/capped_box.palp"));
        static SQUEEZE: [Mode; 1] = [Mode {
            field: Quadratic { linear: [vec3(16.7, 0.0, 0.0), Vec3::ZERO, Vec3::ZERO], ..Quadratic::ZERO },
            bump: None,
            limit: 0.006,
            bounds: FieldBounds { motion: 1.01, stretch: 16.8, bend: 0.0, twist: 0.0 },
        }];
        let (faces, edges) = (Box::leak(Box::new([Face::VACANT; 6])), Box::leak(Box::new([Edge::VACANT; 12])));
        let body = Body::from_bytes(&FILE.0, BodyBuffer { faces, edges }).unwrap();
        SoftWall::new(Soft::new(body, &SQUEEZE).unwrap(), &[motion], rate_hz, vec3(0.1, 0.02, 0.01)).unwrap()
    }

    const SERVO: Loop =
        Loop { rate: 4_000.0, delay_periods: 1.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease: None };

    #[test]
    fn a_body_that_gives_way_adds_its_compliance_and_bears_a_stiffer_wall() {
        let slice = Slice::of(named("woodenhaptics-2016").unwrap());
        let (mass_kg, stiffness_n_per_m) = (0.05, 500.0);
        let modal = Modal { mass_kg, damping_n_s_per_m: 1.0, stiffness_n_per_m };
        let soft = squeezed(modal, 4_000.0);
        let wall = Wall { stiffness: 400.0, damping: 2.0 };
        let swing = collide_with(&slice, wall, &SERVO, Collision::default(), Some(&soft));
        assert!(swing.has_decayed(), "{swing:?}");
        let compliance = 1.0 / 400.0 + 1.002 * 1.002 / 500.0;
        // Dry friction holds the probe off that by its force, and the encoder reads within a count.
        let spread = slice.coulomb * compliance + slice.resolution;
        assert!((swing.rest + compliance).abs() < spread, "{swing:?}, {compliance}");
        let [rigid, soft] = [None, Some(&soft)].map(|soft| max_stiffness_on(&slice, 1.0, &SERVO, soft));
        println!("rigid {rigid:.0} N/m, soft {soft:.0} N/m");
        assert_eq!(rigid, max_stiffness(&slice, 1.0, &SERVO));
        assert!(soft > rigid, "{soft} {rigid}");
    }
}
