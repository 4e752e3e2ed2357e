//! Wire that is drawn over an edge: how far it bends there, what set stays, and what that costs.
//!
//! Wire moves steadily from one straight span over the edge into another. Bending it to the edge's curvature and straightening
//! it again takes work. The pull behind the edge has to do it, so the tension rises by the work per length (H. W. Swift, Plastic
//! bending under tension, Engineering 166, 1948). Of ideally plastic wire with the moment M that is 2 M over the radius where the
//! radius is small.
//!
//! Under little tension, or at a small angle, the wire does not lie on the edge; it bends no further than its tension bends it.
//! In a span under the tension T only the ends carry load. With the angle a to its far end, T sin(a) is the slope of the moment.
//! T (1 - cos(a)) is the area beside the moment's curve over the curvature (the elastica, for any law of bending).

use super::Law;
use super::plasticity::{Scalar, respond_scalar};

/// Halvings of the range of curvatures. Chosen: to more digits than any message shows.
const HALVINGS: usize = 40;

/// What bending to a curvature and straightening again does to wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitBend {
    /// largest curvature, 1/m
    pub curvature: f64,
    /// curvature that stays once nothing holds the wire straight, 1/m, in the direction of the bend
    pub set: f64,
    /// what bending and straightening takes, J/m: by so much the tension rises, N
    pub work: f64,
    /// what bending alone takes, J/m
    bending: f64,
    /// moment at the largest curvature, N m
    moment: f64,
}

impl ExitBend {
    /// Straight wire with this law of bending, bent to `curvature` (1/m) and straightened again.
    pub fn to(law: &Law, curvature: f64) -> Self {
        let stored = |moment: f64| 0.5 * moment * moment / law.modulus;
        let (moment, bent, spent) = respond_scalar(law, &Scalar::default(), curvature);
        let (left, straight, back) = respond_scalar(law, &bent, 0.0);
        Self {
            curvature,
            set: straight.strain,
            work: spent + back + stored(left),
            bending: spent + stored(moment),
            moment,
        }
    }

    /// Wire that a pull of `tension` (N) draws over an edge that bends it to `edge` (1/m) at most and turns it by `angle`, rad.
    pub fn over(law: &Law, edge: f64, angle: f64, tension: f64) -> Self {
        let whole = Self::to(law, edge);
        if tension <= 0.0 {
            return Self::to(law, 0.0);
        }
        if whole.angle_under(tension) <= angle {
            return whole;
        }
        let (mut low, mut high) = (0.0, edge);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match Self::to(law, middle).angle_under(tension) <= angle {
                true => low = middle,
                false => high = middle,
            }
        }
        Self::to(law, low)
    }

    /// Angle, rad, that wire turns by under a pull of `tension` (N) where it just bends so far: that before the bend and that
    /// after it.
    fn angle_under(&self, tension: f64) -> f64 {
        let before = self.moment * self.curvature - self.bending;
        let after = before + self.work;
        let turned = |area: f64, tension: f64| libm::acos((1.0 - area / tension).max(-1.0));
        turned(before, tension) + turned(after, tension + self.work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const EI: f64 = 1.2e-3;
    const LIMIT: f64 = 5e-3;

    fn ideal() -> Law {
        Law::new(EI, 1e-12 * EI, LIMIT, LIMIT)
    }

    /// The closed formulas of ideally plastic wire: what it takes, and what stays.
    #[test]
    fn ideally_plastic_wire_takes_twice_its_moment_over_the_radius() {
        let yields = LIMIT / EI;
        for times in [2.5, 6.0, 40.0] {
            let bend = ExitBend::to(&ideal(), times * yields);
            let exact = LIMIT * (2.0 * times - 2.5) * yields;
            assert!((bend.work / exact - 1.0).abs() < 1e-9, "{bend:?} {exact}");
            // straight again it carries its full moment back
            assert!((bend.set / yields - 1.0).abs() < 1e-9, "{bend:?}");
            assert!((bend.work / (2.0 * LIMIT * bend.curvature) - 1.0).abs() < 1.3 / times);
        }
        // straightened without yielding
        let bend = ExitBend::to(&ideal(), 1.6 * yields);
        assert!((bend.set / (0.6 * yields) - 1.0).abs() < 1e-9);
        let exact = LIMIT * yields * (0.6 + 0.5 * 0.36);
        assert!((bend.work / exact - 1.0).abs() < 1e-9, "{bend:?} {exact}");
    }

    #[test]
    fn elastic_wire_takes_nothing_and_bends_as_the_elastica() {
        let law = Law::new(EI, EI, f64::INFINITY, f64::INFINITY);
        let tension = 7.0;
        for angle in [0.1, 0.7, 1.5] {
            let bend = ExitBend::over(&law, 1e4, angle, tension);
            assert!(bend.set == 0.0 && bend.work < 1e-9 * tension, "{bend:?}");
            let exact = 2.0 * libm::sin(0.25 * angle) * (tension / EI).sqrt();
            assert!(
                (bend.curvature / exact - 1.0).abs() < 1e-5,
                "{bend:?} {exact}"
            );
        }
    }

    /// The moment on the way through bend and back, summed up in small steps.
    #[test]
    fn work_is_the_area_of_the_loop() {
        let law = Law::new(EI, 0.1 * EI, LIMIT, 3.0 * LIMIT);
        for curvature in [10.0, 60.0, 300.0] {
            let bend = ExitBend::to(&law, curvature);
            let (mut state, mut last, mut sum) = (Scalar::default(), 0.0, 0.0);
            let steps = 20_000;
            let mut at = 0.0;
            for k in 1..=2 * steps {
                let up = k.min(2 * steps - k);
                let next = curvature * f64::from(up) / f64::from(steps);
                let (moment, after, _) = respond_scalar(&law, &state, next);
                sum += 0.5 * (moment + last) * (next - at);
                (state, last, at) = (after, moment, next);
            }
            assert!((bend.work / sum - 1.0).abs() < 1e-4, "{bend:?} {sum}");
            assert!((bend.set - state.strain).abs() < 1e-9 * curvature);
        }
    }

    proptest! {
        #[test]
        fn wire_bends_no_further_than_edge_angle_and_tension_allow(
            edge in 1.0..2000.0f64, angle in 0.0..1.5f64, tension in 1e-6..50.0f64,
        ) {
            let law = Law::new(EI, 0.05 * EI, LIMIT, 2.0 * LIMIT);
            let bend = ExitBend::over(&law, edge, angle, tension);
            prop_assert!((0.0..=edge).contains(&bend.curvature));
            // behind the bend it takes T' cos(a) of T' to hold the wire against T
            let most = tension * (1.0 / libm::cos(angle) - 1.0);
            prop_assert!(bend.work >= 0.0 && bend.work <= most * (1.0 + 1e-9), "{bend:?}");
            let tighter = ExitBend::over(&law, edge, angle, 1.5 * tension);
            let wider = ExitBend::over(&law, edge, 1.1 * angle, tension);
            prop_assert!(tighter.curvature >= bend.curvature * (1.0 - 1e-6));
            prop_assert!(wider.curvature >= bend.curvature * (1.0 - 1e-6));
        }
    }
}
