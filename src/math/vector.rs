//! Vectors, and the pose of the turning core.

/// A vector or point, in the unit that the field or argument states.
pub type V3 = nalgebra::Vector3<f64>;
/// A 3 by 3 matrix.
pub type M3 = nalgebra::Matrix3<f64>;
/// A quaternion `w + xi + yj + zk`; unit where it stands for a frame.
pub type Quat = nalgebra::Quaternion<f64>;

/// The turning core's pose: a rotation about +y by `angle` (right-handed, z towards x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// cosine of the angle
    pub c: f64,
    /// sine of the angle
    pub s: f64,
}

impl Spin {
    /// Pose at a core angle, rad.
    pub fn new(angle: f64) -> Self {
        Self {
            c: libm::cos(angle),
            s: libm::sin(angle),
        }
    }

    /// Core frame to lab frame.
    #[inline]
    pub fn to_lab(self, p: V3) -> V3 {
        V3::new(
            self.c * p.x + self.s * p.z,
            p.y,
            -self.s * p.x + self.c * p.z,
        )
    }

    /// Lab frame to core frame.
    #[inline]
    pub fn to_core(self, p: V3) -> V3 {
        V3::new(
            self.c * p.x - self.s * p.z,
            p.y,
            self.s * p.x + self.c * p.z,
        )
    }
}

/// Velocity of a point fixed to a core turning at `omega` rad/s about +y: `omega y x p`.
#[inline]
pub fn spin_velocity(omega: f64, p: V3) -> V3 {
    V3::new(omega * p.z, 0.0, -omega * p.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positive_spin_turns_z_towards_x() {
        let p = Spin::new(0.1).to_lab(V3::new(0.0, 0.0, 1.0));
        assert!(p.x > 0.0);
        let h = 1e-6;
        let q = V3::new(0.3, -0.2, 0.7);
        let v = (Spin::new(h).to_lab(q) - Spin::new(-h).to_lab(q)) / (2.0 * h);
        assert!((v - spin_velocity(1.0, q)).norm() < 1e-9);
        assert!((Spin::new(0.4).to_core(Spin::new(0.4).to_lab(q)) - q).norm() < 1e-15);
    }
}
