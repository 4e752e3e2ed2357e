//! A load over a deformation in straight pieces: hardening that follows a curve.

/// Pieces beyond yield. Chosen: moment and torque of a round section of soft copper are within 1.2 % of the exact ones.
pub const PIECES: usize = 12;

/// Places at which pieces are compared with the exact law. Chosen: a kink lies at a handful of places.
const COMPARED: u32 = 400;

/// A load that is elastic up to its limit and then goes on in straight pieces, each flatter than the one before. The last goes on
/// without end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pieces {
    /// load at which each begins, the first at the limit
    pub loads: [f64; PIECES],
    /// load over deformation in each
    pub tangents: [f64; PIECES],
}

impl Pieces {
    /// Chords of the concave law `exact` from the deformation `from`, where it ceases to be straight, to the deformation `end`, and
    /// their largest difference to it, as a share of the load there.
    ///
    /// Each knot is where the chords before it are farthest off, so that a sharp bend gets more of them.
    pub(super) fn of(from: f64, end: f64, exact: impl Fn(f64) -> f64) -> (Self, f64) {
        let step = libm::log(end / from) / f64::from(COMPARED);
        let samples: Vec<[f64; 2]> = (0..=COMPARED)
            .map(|k| match k {
                0 => from,
                COMPARED => end,
                k => from * libm::exp(f64::from(k) * step),
            })
            .map(|at| [at, exact(at)])
            .collect();
        let mut knots = vec![0, COMPARED as usize];
        while knots.len() <= PIECES {
            knots.push(farthest(&samples, &knots).0);
            knots.sort_unstable();
        }
        let error = farthest(&samples, &knots).1;
        let mut pieces = Self {
            loads: [0.0; PIECES],
            tangents: [0.0; PIECES],
        };
        for (piece, pair) in knots.windows(2).enumerate() {
            let [a, b] = [samples[pair[0]], samples[pair[1]]];
            pieces.loads[piece] = a[1];
            pieces.tangents[piece] = (b[1] - a[1]) / (b[0] - a[0]);
        }
        (pieces, error)
    }

    /// The load where yield begins.
    pub fn limit(&self) -> f64 {
        self.loads[0]
    }

    /// This share of the load at every deformation.
    pub fn scaled(&self, share: f64) -> Self {
        Self {
            loads: self.loads.map(|load| share * load),
            tangents: self.tangents.map(|tangent| share * tangent),
        }
    }
}

/// The sample that lies farthest over its chord, not at a knot, and by which share of its load.
fn farthest(samples: &[[f64; 2]], knots: &[usize]) -> (usize, f64) {
    let mut worst = (0, f64::NEG_INFINITY);
    for pair in knots.windows(2) {
        let [a, b] = [samples[pair[0]], samples[pair[1]]];
        let slope = (b[1] - a[1]) / (b[0] - a[0]);
        for (k, sample) in samples.iter().enumerate().take(pair[1]).skip(pair[0] + 1) {
            let over = (1.0 - (a[1] + slope * (sample[0] - a[0])) / sample[1]).abs();
            if over > worst.1 {
                worst = (k, over);
            }
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::super::flow_curve::{FlowCurve, InPieces};
    use super::super::plasticity::{Bend, Law, Scalar, respond_bend, respond_scalar};

    const R: f64 = 0.35e-3;
    const E: f64 = 115e9;
    const G: f64 = 43e9;
    const POINTS: [[f64; 2]; 4] = [[70e6 / E, 70e6], [0.02, 110e6], [0.1, 180e6], [0.3, 220e6]];

    /// Stress of a fibre that is drawn for the first time.
    fn stress(strain: f64) -> f64 {
        let mut before = [0.0, 0.0];
        for point in POINTS {
            if strain <= point[0] {
                let share = (strain - before[0]) / (point[0] - before[0]);
                return before[1] + share * (point[1] - before[1]);
            }
            before = point;
        }
        before[1]
    }

    /// Moment of a bent section, summed over strips; each has the stress of its strain.
    fn moment_of_strips(curvature: f64) -> f64 {
        const STRIPS: u32 = 20_000;
        let h = R / f64::from(STRIPS);
        let strip = |k: u32| {
            let y = (f64::from(k) + 0.5) * h;
            4.0 * stress(curvature * y) * y * (R * R - y * y).sqrt() * h
        };
        (0..STRIPS).map(strip).sum()
    }

    /// Torque of a twisted section, summed over rings: each is sheared by the von Mises rule.
    fn torque_of_rings(twist: f64) -> f64 {
        const RINGS: u32 = 20_000;
        let h = R / f64::from(RINGS);
        let root = 3.0_f64.sqrt();
        let ring = |k: u32| {
            let r = (f64::from(k) + 0.5) * h;
            let shear = twist * r;
            // tau / G + sqrt(3) * plastic strain rises with tau
            let (mut low, mut high) = (0.0, 0.35);
            for _ in 0..60 {
                let strain = 0.5 * (low + high);
                let tau = stress(strain) / root;
                let reached = tau / G + root * (strain - stress(strain) / E);
                *(if reached < shear { &mut low } else { &mut high }) = strain;
            }
            std::f64::consts::TAU * r * r * stress(low) / root * h
        };
        (0..RINGS).map(ring).sum()
    }

    fn law_of(in_pieces: bool) -> [Law; 2] {
        let curve = FlowCurve::new(POINTS.to_vec()).expect("a curve");
        let asked = InPieces {
            bend: in_pieces,
            twist: in_pieces,
        };
        let laws = curve.round(R, G, asked);
        let open = f64::INFINITY;
        let bilinear =
            |law: super::super::Bilinear, cap| Law::new(law.elastic, law.tangent, law.limit, cap);
        match (laws.hardening.bend, laws.hardening.twist) {
            (Some(bend), Some(twist)) => [
                Law::in_pieces(laws.bend.elastic, &bend, laws.moment_cap),
                Law::in_pieces(laws.twist.elastic, &twist, open),
            ],
            _ => [
                bilinear(laws.bend, laws.moment_cap),
                bilinear(laws.twist, open),
            ],
        }
    }

    /// Moment and what stays of a curvature after the moment is let go, against strips that are let go elastically.
    #[test]
    fn bending_and_spring_back_are_those_of_a_section_of_strips() {
        let [law, _] = law_of(true);
        let [bilinear, _] = law_of(false);
        let mut state = Bend::default();
        let (mut worst, mut worst_bilinear): (f64, f64) = (0.0, 0.0);
        for radius in [100e-3, 30e-3, 10e-3, 5e-3, 2e-3, 1.2e-3] {
            let curvature = 1.0 / (radius + R);
            let exact = moment_of_strips(curvature);
            let (moment, next, _) = respond_bend(&law, &state, [curvature, 0.0]);
            let stays = curvature - moment[0] / law.modulus;
            let stays_exactly = curvature - exact / law.modulus;
            let at = format!("{radius}: {moment:?} {exact}, stays {stays} {stays_exactly}");
            assert!((moment[0] / exact - 1.0).abs() < 0.012, "{at}");
            assert!(
                (stays - stays_exactly).abs() < 0.012 * exact / law.modulus,
                "{at}"
            );
            assert_eq!(next.curvature[1], 0.0);
            let (released, ..) = respond_bend(&law, &next, [stays, 0.0]);
            assert!(
                released[0].abs() < 1e-12 * exact,
                "no moment is left: {released:?}"
            );
            worst = worst.max((moment[0] / exact - 1.0).abs());
            let (rough, ..) = respond_bend(&bilinear, &Bend::default(), [curvature, 0.0]);
            worst_bilinear = worst_bilinear.max((rough[0] / exact - 1.0).abs());
            // on from there, as a wire that is wound tighter
            state = next;
        }
        assert!(worst_bilinear > 10.0 * worst, "{worst} {worst_bilinear}");
    }

    #[test]
    fn torsion_is_that_of_a_section_of_rings() {
        let [_, law] = law_of(true);
        for rim in [1e-3, 3e-3, 0.01, 0.1, 0.4] {
            let exact = torque_of_rings(rim / R);
            let (torque, ..) = respond_scalar(&law, &Scalar::default(), rim / R);
            assert!(
                (torque / exact - 1.0).abs() < 0.012,
                "{rim}: {torque} {exact}"
            );
        }
    }

    #[test]
    fn pieces_say_how_far_off_they_are_and_get_flatter() {
        let curve = FlowCurve::new(POINTS.to_vec()).expect("a curve");
        let asked = InPieces {
            bend: true,
            twist: true,
        };
        let laws = curve.round(R, G, asked);
        for (law, pieces) in [
            (laws.bend, laws.hardening.bend),
            (laws.twist, laws.hardening.twist),
        ] {
            let pieces = pieces.expect("pieces");
            assert!(law.error > 1e-4 && law.error < 0.012, "{law:?}");
            assert!(pieces.tangents[0] < law.elastic);
            assert!(
                pieces
                    .tangents
                    .windows(2)
                    .all(|pair| pair[0] > pair[1] && pair[1] > 0.0)
            );
            assert!(pieces.loads.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}
