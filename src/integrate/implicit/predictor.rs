//! The guess of a step and what its solve starts from.

use super::lengths::{set_share, voronoi};
use super::scheme::{Scheme, StepFormula, extrapolation};
use super::tensioner::NozzleEdge;
use super::work::Work;
use crate::math::{Quat, Spin, V3, align, rotate, turn_about_y};
use crate::rod::Joint;
use crate::system::{Mass, Spindle, Support, System};

impl<const D: usize> Work<D> {
    /// Fills guess, inertial target, masses, and plastic curvature or frames for a step; rolls are
    /// without inertia where not `inert`.
    #[inline(never)]
    pub(super) fn prepare(
        &mut self,
        sys: &System,
        step: &StepFormula,
        spindle: &Spindle,
        support: &[Support; 2],
        inert: bool,
    ) -> Option<NozzleEdge> {
        let w = &mut *self;
        let (rod, past) = (&sys.state.rod, &sys.state.past);
        let nodes = rod.nodes();
        let spin = Spin::new(spindle.angle);
        let e = extrapolation(step.share * step.h, past);
        let density = sys.model.section.mass_per_length();
        w.guess.clear();
        w.target.clear();
        w.mass.clear();
        w.shared_mass.clear();
        if sys.model.mass == Mass::Consistent {
            w.shared_mass
                .extend((0..rod.edges()).map(|j| sys.mass_between(j)));
        }
        for s in &mut w.star {
            s.clear();
        }
        for i in 0..nodes {
            let (x, v) = (rod.x[i], rod.v[i]);
            let (xs, vs) = if step.weight[1] == 0.0 {
                (x, v)
            } else {
                (step.blend(x, past.x[i]), step.blend(v, past.v[i]))
            };
            w.star[0].push(xs);
            w.star[1].push(vs);
            w.target.push(spin.to_core(xs + vs * step.gamma));
            w.guess.push(match past.known {
                0 => spin.to_core(x + v * (step.share * step.h)),
                1 => past.q[0][i] * e[0] + past.q[1][i] * e[1],
                _ => past.q[0][i] * e[0] + past.q[1][i] * e[1] + past.q[2][i] * e[2],
            });
            w.mass.push(density * voronoi(rod, step.grown, i));
        }
        for (end, i) in [(0, 0), (1, nodes - 1)] {
            let s = &support[end];
            if s.turning && s.holds_all() {
                w.guess[i] = s.point;
            } else {
                let mut lab = spin.to_lab(w.guess[i]);
                for a in 0..3 {
                    if s.hold[a] {
                        lab[a] = s.point[a];
                    }
                }
                w.guess[i] = spin.to_core(lab);
            }
        }
        w.q.clone_from(&w.guess);
        if Self::ROLLS {
            self.rolls.prepare(sys, step, spindle, support, inert);
            self.rolls.lay_out(&mut self.assembly.rolling);
            let (state, ends) = ((&rod.bend[..], &rod.twist[..]), self.rolls.joints());
            (self.assembly.rolling).lay(&sys.model.laws, state, ends, |j| {
                (voronoi(rod, step.grown, j), set_share(rod, step.grown, j))
            });
        } else {
            self.turn_plastic_curvature(sys, spindle, support, step.grown);
            let clamps = clamp_directions(support, spindle);
            self.assembly.plain.begin(rod.edges(), clamps);
        }
        self.assembly.begin(&self.target, &self.mass);
        let (spec, feed) = sys.model.feed.as_ref().zip(sys.state.feed.as_ref())?;
        let last = rod.edges() - 1;
        Some(NozzleEdge::new(
            spec,
            feed,
            past,
            step,
            (
                rod.rest[last],
                sys.set_tension_after(step.share * step.h),
                sys.exit_grip(),
                sys.model.laws.stretch.modulus,
                [
                    rod.stretch[last].strain,
                    sys.state.line_wire.next(feed.fed).strain,
                ],
            ),
        ))
    }

    /// Plastic curvature of each joint as a vector in the core frame, turned along with the guess.
    pub(super) fn turn_plastic_curvature(
        &mut self,
        sys: &System,
        spindle: &Spindle,
        support: &[Support; 2],
        grown: f64,
    ) {
        let w = &mut *self;
        let rod = &sys.state.rod;
        let back = turn_about_y(-spindle.angle);
        w.set.clear();
        w.set.resize(rod.nodes(), V3::zeros());
        for i in 0..rod.nodes() {
            let k = rod.bend[i].curvature;
            if k == [0.0; 2] {
                continue;
            }
            let frame = |j: usize| {
                let d = w.guess[j + 1] - w.guess[j];
                align(&(back * rod.frame[j]), &(d / d.norm()), 0.0)
            };
            let clamp = |s: &Support| s.frame.map(|f| if s.turning { f } else { back * f });
            let before = if i > 0 {
                Some(frame(i - 1))
            } else {
                clamp(&support[0])
            };
            let after = if i < rod.edges() {
                Some(frame(i))
            } else {
                clamp(&support[1])
            };
            let (Some(p), Some(n)) = (before, after) else {
                continue;
            };
            w.set[i] = mid_frame_vector(&p, &n, k) * set_share(rod, grown, i);
        }
    }
}

/// The step of `h` from the present instant.
pub(super) fn step_of(sys: &System, scheme: Scheme, h: f64) -> StepFormula {
    let step = StepFormula::new(scheme, &sys.state.past, h);
    match (&sys.state.feed, sys.state.rod.rest.last()) {
        (Some(feed), Some(rest)) => step.with_feed(&sys.state.past, feed.fed, *rest),
        _ => step,
    }
}

/// A vector with components `k` in the frame half-way between the frames of two edges.
fn mid_frame_vector(p: &Quat, n: &Quat, k: [f64; 2]) -> V3 {
    let joint = Joint::between(p, n);
    let half = crate::math::relative([0.5 * joint.bend[0], 0.5 * joint.bend[1]], 0.0);
    let (s, c) = (libm::sin(0.25 * joint.twist), libm::cos(0.25 * joint.twist));
    let mid = p * Quat::new(c, 0.0, 0.0, s) * half;
    rotate(&mid, &V3::new(k[0], k[1], 0.0))
}

/// The supports `dt` later.
pub(super) fn moved(support: &[Support; 2], dt: f64) -> [Support; 2] {
    let mut s = *support;
    for s in &mut s {
        s.point += s.velocity * dt;
    }
    s
}

/// Directions of the clamped ends in the core frame.
fn clamp_directions(support: &[Support; 2], spindle: &Spindle) -> [Option<V3>; 2] {
    let spin = Spin::new(spindle.angle);
    let of = |s: &Support| {
        s.frame.map(|f| {
            let t = rotate(&f, &V3::z());
            if s.turning { t } else { spin.to_core(t) }
        })
    };
    [of(&support[0]), of(&support[1])]
}
