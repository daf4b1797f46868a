//! Orientations as unit quaternions: the vector, then the scalar.

use super::{Vec3, inverse_sqrt};

/// `p q`: first `q`, then `p`.
#[inline]
pub(crate) const fn product(p: &[f32; 4], q: &[f32; 4]) -> [f32; 4] {
    let ([a, b, c, s], [x, y, z, w]) = (*p, *q);
    [
        s * x + a * w + b * z - c * y,
        s * y - a * z + b * w + c * x,
        s * z + a * y - b * x + c * w,
        s * w - a * x - b * y - c * z,
    ]
}

/// `q` turned by the Cayley rotation of `half`, half an angle vector: `(half, 1) q`, of length 1 again.
#[inline]
pub(crate) fn turned_by(half: Vec3, q: &[f32; 4]) -> [f32; 4] {
    let [x, y, z, w] = product(&[half.x, half.y, half.z, 1.0], q);
    let scale = inverse_sqrt(x * x + y * y + z * z + w * w);
    [x * scale, y * scale, z * scale, w * scale]
}

/// The unit quaternion of orthonormal axes: from its largest component, which is at least a half (S. W. Shepperd,
/// *Quaternion from rotation matrix*, 1978).
pub(crate) const fn quaternion(axes: &[Vec3; 3]) -> [f32; 4] {
    let [a, b, c] = *axes;
    let trace = a.x + b.y + c.z;
    let q = if trace > a.x && trace > b.y && trace > c.z {
        [b.z - c.y, c.x - a.z, a.y - b.x, 1.0 + trace]
    } else if a.x > b.y && a.x > c.z {
        [1.0 + a.x - b.y - c.z, a.y + b.x, a.z + c.x, b.z - c.y]
    } else if b.y > c.z {
        [a.y + b.x, 1.0 - a.x + b.y - c.z, b.z + c.y, c.x - a.z]
    } else {
        [a.z + c.x, b.z + c.y, 1.0 - a.x - b.y + c.z, a.y - b.x]
    };
    let squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    let scale = const_inverse_root(squared);
    [q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale]
}

/// `1/√x` for `4 ≤ x ≤ 16`, in a constant too: Newton's steps from the chord, at most 12 % off, square the error.
const fn const_inverse_root(x: f32) -> f32 {
    let mut root = 0.583_333_3 - 0.020_833_3 * x;
    let mut round = 0;
    while round < 5 {
        root *= 1.5 - 0.5 * x * root * root;
        round += 1;
    }
    root
}
