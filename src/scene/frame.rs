//! Where a body's frame is in the scene, in the form that is cheapest to move and to ask.

use crate::math::{Vec3, quaternion, turned_by, vec3};
use crate::track::Placement;

/// A rigid motion `Q = R (q + offset) + pivot`, `q` in the body's frame: `pivot` and `offset` stay constant while the
/// body turns about its pivot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// The body's axes, the columns of `R`.
    pub axes: [Vec3; 3],
    /// Metres, in the scene.
    pub pivot: Vec3,
    /// Metres, in the body.
    pub offset: Vec3,
    /// Of the body's point that is at the scene's origin, m/s.
    pub velocity: Vec3,
    /// rad/s.
    pub angular_velocity: Vec3,
}

// By reference, as the placement's own: a frame is 84 bytes.
#[expect(clippy::wrong_self_convention, reason = "a frame is not turned into something else")]
impl Frame {
    pub fn new(placement: &Placement) -> Self {
        let Placement { axes, origin, velocity, angular_velocity } = *placement;
        let velocity = velocity - angular_velocity.cross(origin);
        Self { axes, pivot: origin, offset: Vec3::ZERO, velocity, angular_velocity }
    }

    pub fn placement(&self) -> Placement {
        let Self { axes, angular_velocity, .. } = *self;
        let origin = self.point_to_scene(Vec3::ZERO);
        Placement { axes, origin, velocity: self.velocity_at(origin), angular_velocity }
    }

    /// A direction of the body, in the scene.
    #[inline]
    pub fn to_scene(&self, direction: Vec3) -> Vec3 {
        self.axes[0] * direction.x + self.axes[1] * direction.y + self.axes[2] * direction.z
    }

    /// A direction of the scene, in the body.
    #[inline]
    pub fn to_body(&self, direction: Vec3) -> Vec3 {
        vec3(self.axes[0].dot(direction), self.axes[1].dot(direction), self.axes[2].dot(direction))
    }

    /// A point of the body, in the scene.
    #[inline]
    pub fn point_to_scene(&self, point: Vec3) -> Vec3 {
        self.to_scene(point + self.offset) + self.pivot
    }

    /// A point of the scene, in the body.
    #[inline]
    pub fn point_to_body(&self, point: Vec3) -> Vec3 {
        self.to_body(point - self.pivot) - self.offset
    }

    /// The frame after `elapsed` seconds of constant velocity: its origin on a straight line, turned about it.
    pub fn go_along(&mut self, elapsed: f32) {
        let Placement { origin, velocity, angular_velocity, .. } = self.placement();
        let turned = axes(&turned_by(angular_velocity * (0.5 * elapsed), &quaternion(&self.axes)));
        let placement = Placement { axes: turned, origin: origin + velocity * elapsed, velocity, angular_velocity };
        *self = Self::new(&placement);
    }

    /// The velocity, in the scene, of the point of the body that is at `point` of the scene.
    #[inline]
    pub fn velocity_at(&self, point: Vec3) -> Vec3 {
        self.velocity + self.angular_velocity.cross(point)
    }
}

/// The axes of a frame turned by a unit quaternion: the vector, then the scalar.
#[inline]
pub(super) fn axes(q: &[f32; 4]) -> [Vec3; 3] {
    let [x, y, z, w] = *q;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz, xy, xz, yz) = (x * x2, y * y2, z * z2, x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    let (x_of, y_of) = (1.0 - xx, 1.0 - yy);
    [vec3(y_of - zz, xy + wz, xz - wy), vec3(xy - wz, x_of - zz, yz + wx), vec3(xz + wy, yz - wx, x_of - yy)]
}
