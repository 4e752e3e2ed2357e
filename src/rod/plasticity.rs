//! Laws with isotropic hardening in straight pieces, per unit length of wire.
//!
//! A trial force beyond the yield limit returns to it along the elastic stiffness. The limit
//! rises by the hardening modulus `H = E Ep / (E - Ep)` times the plastic strain, so that the
//! tangent of the loading branch is exactly `Ep`. A bilinear law has one such piece; others go on with flatter ones. The return
//! is exact for a straight strain path. State advances only where the caller commits it.

use super::pieces::{PIECES, Pieces};
use serde::{Deserialize, Serialize};

/// Elastic modulus, hardening in straight pieces, yield limit, optional cap on the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// elastic modulus, force per strain: N, or N m^2 for moments over curvatures
    pub modulus: f64,
    /// hardening modulus H from the yield limit on, unit of `modulus`
    pub hardening: f64,
    /// yield limit of virgin material, N or N m
    pub limit: f64,
    /// value that the limit never exceeds, N or N m
    pub cap: f64,
    /// pieces after the first: rise of the limit at which each begins, infinite for none, and its hardening modulus
    later: [[f64; 2]; PIECES - 1],
}

impl Law {
    /// Law with tangent `plastic` above `limit`, and the limit held below `cap`.
    pub fn new(modulus: f64, plastic: f64, limit: f64, cap: f64) -> Self {
        let hardening = if plastic < modulus {
            hardening_for(modulus, plastic)
        } else {
            f64::INFINITY
        };
        // no difference between the branches: nothing ever yields
        let limit = if hardening.is_finite() {
            limit
        } else {
            f64::INFINITY
        };
        let hardening = if hardening.is_finite() {
            hardening
        } else {
            0.0
        };
        Self {
            modulus,
            hardening,
            limit,
            cap: cap.max(limit),
            later: [[f64::INFINITY, 0.0]; PIECES - 1],
        }
    }

    /// Law that follows `pieces`, and the limit held below `cap`.
    pub fn in_pieces(modulus: f64, pieces: &Pieces, cap: f64) -> Self {
        let limit = pieces.limit();
        let mut law = Self::new(modulus, pieces.tangents[0], limit, cap);
        for (k, later) in law.later.iter_mut().enumerate() {
            let hardening = hardening_for(modulus, pieces.tangents[k + 1]);
            *later = [pieces.loads[k + 1] - limit, hardening];
        }
        law
    }

    /// Largest rise of the limit, where it has met its cap.
    #[inline]
    fn most(&self) -> f64 {
        self.cap - self.limit
    }

    /// Tangent of the loading branch once the limit has risen by `rise`: none at the cap.
    #[inline]
    pub fn tangent(&self, rise: f64) -> f64 {
        if rise >= self.most() {
            0.0
        } else {
            let begun = self.later.iter().take_while(|piece| piece[0] <= rise);
            let hardening = begun.last().map_or(self.hardening, |piece| piece[1]);
            self.modulus * hardening / (self.modulus + hardening)
        }
    }

    /// Plastic multiplier, rise of the limit afterwards and plastic work for a trial force of norm
    /// `trial` at rise `q`.
    #[inline]
    fn flow(&self, trial: f64, q: f64) -> (f64, f64, f64) {
        let (mut trial, mut q, mut hardening) = (trial, q, self.hardening);
        // plastic strain and work over the pieces that the limit leaves behind on the way
        let (mut passed, mut spent) = (0.0, 0.0);
        let most = self.most().max(q);
        for [end, next] in self.later {
            if end >= most {
                break;
            }
            if end > q {
                let way = (end - q) / hardening;
                if trial - (self.limit + q) <= (self.modulus + hardening) * way {
                    break;
                }
                passed += way;
                spent += (self.limit + 0.5 * (q + end)) * way;
                trial -= self.modulus * way;
                q = end;
            }
            hardening = next;
        }
        let over = trial - (self.limit + q);
        let dg = over / (self.modulus + hardening);
        let dq = hardening * dg;
        let room = most - q;
        if dq <= room {
            let work = (self.limit + q + 0.5 * dq) * dg;
            return (passed + dg, q + dq, spent + work);
        }
        // the limit meets its cap on the way: from there on it is ideally plastic
        let cap = self.limit + most;
        let dg = (trial - cap) / self.modulus;
        // on the first part of the way the limit was lower, by half the room on average
        let hardened = room / hardening;
        let work = cap * dg - 0.5 * room * hardened;
        (passed + dg, most, spent + work)
    }
}

impl Law {
    /// Plastic strain and plastic work (J/m for forces and moments per length) while the limit rises from one value to another.
    #[cfg(feature = "lab")]
    pub fn hardened(&self, from: f64, to: f64) -> (f64, f64) {
        let (mut rise, mut hardening) = (from, self.hardening);
        let (mut strain, mut work) = (0.0, 0.0);
        for [end, next] in self.later.into_iter().chain([[f64::INFINITY, 0.0]]) {
            let stop = end.min(to);
            if stop > rise {
                let way = (stop - rise) / hardening;
                strain += way;
                work += (self.limit + 0.5 * (rise + stop)) * way;
                rise = stop;
            }
            if end >= to {
                break;
            }
            hardening = next;
        }
        (strain, work)
    }
}

/// Hardening modulus of a branch with this tangent: `E Ep / (E - Ep)`.
fn hardening_for(modulus: f64, tangent: f64) -> f64 {
    modulus * tangent / (modulus - tangent)
}

/// Plastic state of a scalar law (stretch, twist).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    /// plastic strain: stretch, or twist per length in 1/m
    pub strain: f64,
    /// rise of the yield limit, N or N m
    pub rise: f64,
}

impl Scalar {
    /// State of wire of which a `share` is in the state `other`; where both are the same it stays that, to the bit.
    pub(crate) fn mixed(&self, other: &Self, share: f64) -> Self {
        Self {
            strain: self.strain + (other.strain - self.strain) * share,
            rise: self.rise + (other.rise - self.rise) * share,
        }
    }
}

/// Force at a total strain (N, or N m for twist), the plastic state there, and the plastic work
/// done on the way, J/m.
#[inline]
pub fn respond_scalar(law: &Law, state: &Scalar, strain: f64) -> (f64, Scalar, f64) {
    let trial = law.modulus * (strain - state.strain);
    if trial.abs() <= law.limit + state.rise {
        return (trial, *state, 0.0);
    }
    let (dg, rise, work) = law.flow(trial.abs(), state.rise);
    let next = Scalar {
        strain: state.strain + dg.copysign(trial),
        rise,
    };
    (law.modulus * (strain - next.strain), next, work)
}

/// Plastic `work` of a step (J/m) less the work of the mean of the forces `before` and `after` it
/// on the increment `way` of plastic strain.
///
/// The energy balance needs it: its sums over a step take forces as that mean, which is exact while
/// the law is elastic. Where a step ends yielding against the way in which it began, the mean
/// vanishes although plastic work is done.
#[inline]
pub fn beyond<const N: usize>(before: [f64; N], after: [f64; N], way: [f64; N], work: f64) -> f64 {
    let mean = |k: usize| 0.5 * (before[k] + after[k]) * way[k];
    work - (0..N).map(mean).sum::<f64>()
}

/// Plastic state of bending, in the joint's mid frame; the norm of the moment yields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bend {
    /// plastic curvature, 1/m
    pub curvature: [f64; 2],
    /// rise of the yield moment, N m
    pub rise: f64,
}

impl Bend {
    /// State of wire of which a `share` is in the state `other`; where both are the same it stays that, to the bit.
    pub(crate) fn mixed(&self, other: &Self, share: f64) -> Self {
        let [a, b] = self.curvature;
        Self {
            curvature: [
                a + (other.curvature[0] - a) * share,
                b + (other.curvature[1] - b) * share,
            ],
            rise: self.rise + (other.rise - self.rise) * share,
        }
    }
}

/// Moment (N m) at a total curvature (1/m), both in the mid frame; the plastic state there, and the
/// plastic work, J/m.
#[inline]
pub fn respond_bend(law: &Law, state: &Bend, curvature: [f64; 2]) -> ([f64; 2], Bend, f64) {
    let trial = [
        law.modulus * (curvature[0] - state.curvature[0]),
        law.modulus * (curvature[1] - state.curvature[1]),
    ];
    let n2 = trial[0] * trial[0] + trial[1] * trial[1];
    let limit = law.limit + state.rise;
    if n2 <= limit * limit {
        return (trial, *state, 0.0);
    }
    let n = n2.sqrt();
    let (dg, rise, work) = law.flow(n, state.rise);
    let dir = [trial[0] / n, trial[1] / n];
    let next = Bend {
        curvature: [
            state.curvature[0] + dg * dir[0],
            state.curvature[1] + dg * dir[1],
        ],
        rise,
    };
    let left = n - law.modulus * dg;
    ([left * dir[0], left * dir[1]], next, work)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn law() -> Law {
        Law::new(3.06e-3, 1.13e-4, 5.72e-3, f64::INFINITY)
    }

    fn capped() -> Law {
        Law::new(3.06e-3, 1.13e-4, 5.72e-3, 0.0126)
    }

    /// Pieces of 1e-3 N m each, flatter by a third from one to the next; the cap cuts off those after the eighth.
    fn in_pieces() -> Law {
        let loads = std::array::from_fn(|k| 4e-3 + 1e-3 * k as f64);
        let tangents = std::array::from_fn(|k| 2e-3 * 1.5_f64.powi(-(k as i32)));
        Law::in_pieces(3.06e-3, &Pieces { loads, tangents }, 11.2e-3)
    }

    /// The slope of the moment along its path, within pieces and at the cap.
    #[test]
    fn tangent_of_pieces_is_the_slope_of_the_moment() {
        let l = in_pieces();
        let h = 1e-6;
        let mut tangents = std::collections::BTreeSet::new();
        for k in 1..800 {
            let k = f64::from(k) * 0.0503;
            let at = |k: f64| respond_scalar(&l, &Scalar::default(), k);
            let (m, next, _) = at(k);
            let slope = (at(k + h).0 - at(k - h).0) / (2.0 * h);
            let expected = if next.rise > 0.0 {
                l.tangent(next.rise)
            } else {
                l.modulus
            };
            assert!(
                (slope - expected).abs() < 1e-6 * l.modulus,
                "{k} {m}: {slope} {expected}"
            );
            tangents.insert((1e9 * expected).round() as u64);
        }
        assert_eq!(
            tangents.len(),
            1 + 8 + 1,
            "elastic, eight pieces and the cap: {tangents:?}"
        );
    }

    /// The invariant of `stress` tells work and plastic strain from the rise alone.
    #[cfg(feature = "lab")]
    #[test]
    fn the_rise_tells_plastic_strain_and_work() {
        for l in [law(), in_pieces()] {
            let mut before = Scalar::default();
            for k in [2.5, 3.0, 4.5, 6.0] {
                let (_, after, work) = respond_scalar(&l, &before, k);
                let (strain, told) = l.hardened(before.rise, after.rise);
                assert!(
                    (strain - (after.strain - before.strain)).abs() < 1e-12 * k,
                    "{k}"
                );
                assert!((told - work).abs() <= 1e-12 * work, "{k}: {told} {work}");
                before = after;
            }
        }
    }

    #[test]
    fn loading_branch_is_bilinear() {
        let l = law();
        let k = 100.0;
        let ky = l.limit / l.modulus;
        let (m, s, _) = respond_scalar(&l, &Scalar::default(), k);
        assert!((m - (l.limit + 1.13e-4 * (k - ky))).abs() < 1e-15);
        // unloading is elastic, reverse yield at the raised limit
        let (m2, _, w) = respond_scalar(&l, &s, k - 2.0 * m / l.modulus * 0.999);
        assert!(w == 0.0 && (m2 + m * 0.998).abs() < 1e-12);
    }

    #[test]
    fn cap_bounds_the_moment() {
        let l = Law {
            cap: 0.0126,
            ..law()
        };
        let mut s = Bend::default();
        for k in [1.0, 10.0, 60.0, 100.0, 400.0, -400.0] {
            let (m, n, w) = respond_bend(&l, &s, [k, 0.0]);
            assert!(m[0].abs() <= 0.0126 * (1.0 + 1e-12) && w >= 0.0);
            s = n;
        }
        assert!((s.rise + l.limit - 0.0126).abs() < 1e-12);
    }

    #[test]
    fn equal_branches_never_yield() {
        let l = Law::new(1.0, 1.0, 0.5, f64::INFINITY);
        assert_eq!(respond_scalar(&l, &Scalar::default(), 7.0).0, 7.0);
    }

    proptest! {
        #[test]
        fn bend_along_a_line_is_the_scalar_law(path in prop::collection::vec(-200.0..200.0f64, 1..8), a in 0.0..6.0f64) {
            let l = law();
            let (mut s, mut b) = (Scalar::default(), Bend::default());
            for k in path {
                let (m, n, w) = respond_scalar(&l, &s, k);
                let (m2, n2, w2) = respond_bend(&l, &b, [k * a.cos(), k * a.sin()]);
                prop_assert!((m2[0] - m * a.cos()).abs() + (m2[1] - m * a.sin()).abs() < 1e-14);
                prop_assert!((w - w2).abs() < 1e-12 * (1.0 + w));
                s = n;
                b = n2;
            }
        }

        #[test]
        fn plastic_work_is_never_negative(path in prop::collection::vec(prop::array::uniform2(-300.0..300.0f64), 1..12)) {
            let mut b = Bend::default();
            for k in path {
                let (m, n, w) = respond_bend(&law(), &b, k);
                prop_assert!(w >= 0.0 && n.rise >= b.rise);
                let norm = (m[0] * m[0] + m[1] * m[1]).sqrt();
                prop_assert!(norm <= (law().limit + n.rise) * (1.0 + 1e-12));
                b = n;
            }
        }

        /// The committed response loses exactly the stored energy plus the plastic work.
        #[test]
        fn work_balances_on_a_fine_path(k in 5.0..300.0f64) {
            let l = law();
            let (mut s, mut done, mut plastic, mut last) = (Scalar::default(), 0.0, 0.0, 0.0);
            let n = 4000;
            for i in 1..=n {
                let kk = k * i as f64 / n as f64;
                let (m, next, w) = respond_scalar(&l, &s, kk);
                done += 0.5 * (m + last) * k / n as f64;
                plastic += w;
                s = next;
                last = m;
            }
            let stored = 0.5 * last * last / l.modulus;
            prop_assert!((done - stored - plastic).abs() < 1e-3 * done);
        }

        /// One step that meets the cap on its way did the plastic work of all small steps on that way.
        #[test]
        fn work_of_a_step_to_the_cap_is_that_of_small_steps(k in 5.0..300.0f64, worn in 0.0..1.0f64, set in -30.0..30.0f64, a in 0.0..6.0f64) {
            for l in [capped(), in_pieces()] {
            let mut state = Bend { curvature: [set * a.cos(), set * a.sin()], rise: worn * (l.cap - l.limit) };
            let start = Scalar { strain: set, rise: state.rise };
            let (m, next, work) = respond_scalar(&l, &start, set + k);
            let (mut scalar, mut sum, mut sum_bend) = (start, 0.0, 0.0);
            let n = 4000;
            for i in 1..=n {
                let kk = set + k * f64::from(i) / f64::from(n);
                let (_, after, w) = respond_scalar(&l, &scalar, kk);
                let (_, bend, w_bend) = respond_bend(&l, &state, [kk * a.cos(), kk * a.sin()]);
                sum += w;
                sum_bend += w_bend;
                scalar = after;
                state = bend;
            }
            let scale = work + 0.5 * m * m / l.modulus;
            prop_assert!((work - sum).abs() < 1e-9 * scale, "{work} in one step, {sum} in {n}");
            prop_assert!((work - sum_bend).abs() < 1e-9 * scale);
            prop_assert!((next.strain - scalar.strain).abs() < 1e-9 * k);
            }
        }

        /// Stored energy and plastic work together are the potential of the moment, whatever the branch.
        #[test]
        fn moment_is_the_derivative_of_energy_and_work(
            k in prop::array::uniform2(-300.0..300.0f64), set in prop::array::uniform2(-30.0..30.0f64), worn in 0.0..1.0f64,
        ) {
            for l in [capped(), in_pieces()] {
            let state = Bend { curvature: set, rise: worn * (l.cap - l.limit) };
            let potential = |k: [f64; 2]| {
                let (m, _, work) = respond_bend(&l, &state, k);
                0.5 * (m[0] * m[0] + m[1] * m[1]) / l.modulus + work
            };
            let (m, ..) = respond_bend(&l, &state, k);
            let h = 1e-3;
            for a in 0..2 {
                let at = |by: f64| {
                    let mut k = k;
                    k[a] += by;
                    potential(k)
                };
                let slope = (at(h) - at(-h)) / (2.0 * h);
                // (a branch that changes within h bends the potential by E h)
                prop_assert!((slope - m[a]).abs() < l.modulus * h, "{slope} {}", m[a]);
            }
            }
        }

        /// A limit that has met its cap rests there, whatever was rounded on its way.
        #[test]
        fn no_hardening_is_left_at_the_cap(rise in 0.0..1.0f64, limit in 1e-3..6e-3f64, over in 1.01..3.0f64) {
            let l = Law::new(3.06e-3, 1.13e-4, limit, limit * over);
            let start = Scalar { strain: 0.0, rise: rise * (l.cap - l.limit) };
            let (m, next, _) = respond_scalar(&l, &start, 1e4);
            prop_assert_eq!(l.tangent(next.rise), 0.0, "{} {:?}", m, next);
        }
    }
}
