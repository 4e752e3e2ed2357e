//! The guess of a step and what its solve starts from.

use super::lengths::voronoi;
use super::nozzle_edge::{EdgeAtStart, NozzleEdge};
use super::scheme::{Scheme, StepFormula, extrapolation};
use super::unknowns::Unknowns;
use super::work::Work;
use crate::math::Spin;
use crate::system::{Mass, Spindle, Support, System};

impl<const D: usize, U: Unknowns<D>> Work<D, U> {
    /// Fills guess, inertial target and masses for a step, and lays out the joints; rolls are without inertia where
    /// not `inert`.
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
        // (array by array: an array whose length is known is filled with nothing to check)
        let [xs, vs] = &mut w.star;
        for (star, (now, before)) in [(&mut *xs, (&rod.x, &past.x)), (vs, (&rod.v, &past.v))] {
            if step.weight[1] == 0.0 {
                star.extend_from_slice(now);
            } else {
                let both = now.iter().zip(&before[..nodes]);
                star.extend(both.map(|(now, before)| step.blend(*now, *before)));
            }
        }
        let star = w.star[0].iter().zip(&w.star[1]);
        (w.target).extend(star.map(|(xs, vs)| spin.to_core(xs + vs * step.gamma)));
        let [one, two, three] = &past.q;
        match past.known {
            0 => {
                let moved = rod.x.iter().zip(&rod.v);
                (w.guess).extend(moved.map(|(x, v)| spin.to_core(x + v * (step.share * step.h))));
            }
            1 => {
                let places = one[..nodes].iter().zip(&two[..nodes]);
                (w.guess).extend(places.map(|(one, two)| one * e[0] + two * e[1]));
            }
            _ => {
                let places = one[..nodes].iter().zip(&two[..nodes]).zip(&three[..nodes]);
                let guess =
                    places.map(|((one, two), three)| one * e[0] + two * e[1] + three * e[2]);
                w.guess.extend(guess);
            }
        }
        (w.mass).extend((0..nodes).map(|i| density * voronoi(rod, step.grown, i)));
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
        let ends = (spindle, support);
        self.unknowns.prepare(sys, step, ends, &self.guess, inert);
        self.assembly.begin(&self.target, &self.mass);
        let (spec, feed) = sys.model.feed.as_ref().zip(sys.state.feed.as_ref())?;
        let last = rod.edges() - 1;
        Some(NozzleEdge::new(
            spec,
            feed,
            past,
            step,
            EdgeAtStart {
                rest: rod.rest[last],
                pull: sys.set_tension_after(step.share * step.h),
                grip: sys.exit_grip(),
                ea: sys.model.laws.stretch.modulus,
                plastic: [
                    rod.stretch[last].strain,
                    sys.state.line_wire.next(feed.fed).strain,
                ],
            },
            &sys.line_yield(),
        ))
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

/// The supports `dt` later.
pub(super) fn moved(support: &[Support; 2], dt: f64) -> [Support; 2] {
    let mut s = *support;
    for s in &mut s {
        s.point += s.velocity * dt;
    }
    s
}
