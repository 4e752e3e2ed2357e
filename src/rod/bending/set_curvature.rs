//! Plastic curvature of a joint as a vector that goes along with the wire.

use super::FOLD;
use crate::math::V3;

/// The plastic curvature of a joint of wire that carries no twist.
///
/// It is known in the frame half-way between the two edges, as [`Joint`](crate::rod::Joint) has it. Edges turn without
/// a roll of their own. This frame then turns with the direction half-way, the shortest way, and about that direction as
/// both edges turn about their common normal differently.
#[derive(Clone, Copy, Debug)]
pub struct SetCurvature {
    /// the vector where it is known, 1/m
    vector: V3,
    /// direction half-way between the edges there
    along: V3,
    /// difference of their directions there, before less after
    apart: V3,
}

impl SetCurvature {
    /// `vector` (1/m) where the edges have the unit directions `t`.
    pub fn new(vector: V3, t: [&V3; 2]) -> Self {
        Self {
            vector,
            along: half_way(t),
            apart: t[0] - t[1],
        }
    }

    /// The vector with the edges along `t`, 1/m; exact up to the square of the turn since it was known.
    #[inline]
    pub fn at(&self, t: [&V3; 2]) -> V3 {
        let along = half_way(t);
        let turned = self.vector
            - (self.along + along) * (along.dot(&self.vector) / (1.0 + self.along.dot(&along)));
        let way = t[0] - t[1] - self.apart;
        turned + along.cross(&turned) * spin_per_way(t).dot(&way)
    }
}

/// Direction half-way between two unit directions.
pub(super) fn half_way(t: [&V3; 2]) -> V3 {
    let sum = t[0] + t[1];
    sum / sum.norm_squared().max(FOLD).sqrt()
}

/// Turn of the frame half-way about its own direction, rad, over the change of the difference of the unit directions `t`.
///
/// An edge that leaves the plane of both takes its frame along without a roll. Seen from half-way this frame rolls, by half the
/// binormal of half the turning angle times the way. The frame half-way takes half of what both edges' frames roll.
#[inline]
pub(super) fn spin_per_way(t: [&V3; 2]) -> V3 {
    let f = 2.0 / (1.0 + t[0].dot(t[1])).max(FOLD);
    t[1].cross(t[0]) * (0.25 * f / (1.0 + f.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Quat, align, relative, rotate};
    use crate::rod::mid_frame_vector;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn follows_the_frame_half_way(bend in prop::array::uniform2(-1.0..1.0f64), twist in -1.0..1.0f64,
            k in prop::array::uniform2(-300.0..300.0f64), turn in prop::array::uniform6(-1.0..1.0f64)) {
            let p = Quat::identity();
            let n = p * relative(bend, twist);
            let along = |q: &Quat| rotate(q, &V3::z());
            let t = [along(&p), along(&n)];
            let set = SetCurvature::new(mid_frame_vector(&p, &n, k), [&t[0], &t[1]]);
            let size = libm::hypot(k[0], k[1]);
            for (far, off) in [(1e-3, 3e-6), (1e-2, 3e-4)] {
                let a = (t[0] + V3::new(turn[0], turn[1], turn[2]) * far).normalize();
                let b = (t[1] + V3::new(turn[3], turn[4], turn[5]) * far).normalize();
                let want = mid_frame_vector(&align(&p, &a, 0.0), &align(&n, &b, 0.0), k);
                let got = set.at([&a, &b]);
                prop_assert!((got - want).norm() <= off * size, "{got} {want}");
            }
        }
    }
}
