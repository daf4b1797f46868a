//! The pose of one body in the frame of another, and its motion.

use crate::math::{Vec3, vec3};

/// The pose of body B in the frame of body A, and its motion relative to A, in A's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// B's axes in A's frame, orthonormal and right-handed.
    pub axes: [Vec3; 3],
    /// B's origin in A's frame, metres.
    pub origin: Vec3,
    /// Velocity of B's origin, m/s.
    pub velocity: Vec3,
    /// Angular velocity of B, rad/s.
    pub angular_velocity: Vec3,
}

impl Placement {
    /// B's frame is A's.
    pub const IDENTITY: Self = Self {
        axes: [Vec3::X, Vec3::Y, Vec3::Z],
        origin: Vec3::ZERO,
        velocity: Vec3::ZERO,
        angular_velocity: Vec3::ZERO,
    };

    /// A direction of B's frame, in A's.
    #[inline]
    pub fn direction_to_a(&self, direction: Vec3) -> Vec3 {
        self.axes[0] * direction.x + self.axes[1] * direction.y + self.axes[2] * direction.z
    }

    /// A direction of A's frame, in B's.
    #[inline]
    pub fn direction_to_b(&self, direction: Vec3) -> Vec3 {
        vec3(self.axes[0].dot(direction), self.axes[1].dot(direction), self.axes[2].dot(direction))
    }

    /// A point of B's frame, in A's.
    #[inline]
    pub fn point_to_a(&self, point: Vec3) -> Vec3 {
        self.direction_to_a(point) + self.origin
    }

    /// A point of A's frame, in B's.
    #[inline]
    pub fn point_to_b(&self, point: Vec3) -> Vec3 {
        self.direction_to_b(point - self.origin)
    }

    /// The velocity, in A's frame, of the point of B that is at `point` of A's frame.
    #[inline]
    pub fn velocity_at(&self, point: Vec3) -> Vec3 {
        self.velocity + self.angular_velocity.cross(point - self.origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    #[test]
    fn points_go_there_and_back() {
        let (sine, cosine) = sin_cos(0.7);
        let placement = Placement {
            axes: [vec3(cosine, sine, 0.0), vec3(-sine, cosine, 0.0), Vec3::Z],
            origin: vec3(0.1, -0.2, 0.3),
            ..Placement::IDENTITY
        };
        let point = vec3(0.3, 0.4, -0.5);
        // Some ten roundings of numbers below 1.
        assert!((placement.point_to_b(placement.point_to_a(point)) - point).length() < 5e-7);
    }
}
