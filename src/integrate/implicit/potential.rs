//! The incremental potential of a step: its value, gradient and Gauss-Newton Hessian at an iterate.

use super::first_edge::FirstEdge;
use super::lengths::voronoi;
use super::nozzle_edge::NozzleEdge;
use super::scheme::StepFormula;
use super::unknowns::Unknowns;
use super::work::{Axial, Work};
use crate::contact::{ContactPoint, LineContact, own_wire};
use crate::math::{Spin, V3};
use crate::rod::batch::Joints;
use crate::rod::{Block, Laws, Rod, stretched, turning};
use crate::system::{Loads, Spindle, Support, System, line_contact};

/// The incremental potential of a step, and what its evaluation needs besides the iterate.
pub(super) struct Potential<'a> {
    pub(super) rod: &'a Rod,
    pub(super) laws: &'a Laws,
    pub(super) line: Option<LineContact<'a>>,
    pub(super) loads: &'a Loads,
    /// the wire at the last accepted instant, core frame
    pub(super) last: &'a [V3],
    /// tension of each edge at the last accepted instant, N
    pub(super) tension: &'a [f64],
    /// the edge after frozen wire
    pub(super) first: Option<FirstEdge<'a>>,
    pub(super) nozzle: Option<NozzleEdge>,
    /// by how much the edge at the nozzle is likely to grow, m
    pub(super) grown: f64,
    /// time over which forces act, and since the last accepted instant, s
    pub(super) gamma: f64,
    pub(super) elapsed: f64,
    pub(super) diameter: f64,
    pub(super) arc0: f64,
    /// gravity and dead forces turned into the core frame
    pub(super) back: Spin,
    /// nodes and coordinates that do not move
    pub(super) held: [[bool; 3]; 2],
    /// no node moves along z
    pub(super) flat: bool,
}

/// Value of the potential, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Value {
    /// as the line search sees it: friction limits of the iterate before, tensions that follow the
    /// update linearly
    pub(super) merit: f64,
    /// as it is
    pub(super) now: f64,
}

impl<'a> Potential<'a> {
    /// The potential of `step`.
    pub(super) fn of_step(
        sys: &'a mut System,
        step: &StepFormula,
        spindle: &Spindle,
        support: &[Support; 2],
        nozzle: Option<NozzleEdge>,
    ) -> Self {
        let friction = sys.friction_at_rest().filter(|_| step.share == 1.0);
        let (rod, stretch) = (&sys.state.rod, &sys.model.laws.stretch);
        let first = friction.and_then(|friction| {
            let pulls = &sys.state.frozen_pulls;
            FirstEdge::new(pulls, friction, stretch, (&rod.stretch[0], rod.rest[0]))
        });
        Self {
            first,
            rod: &sys.state.rod,
            laws: &sys.model.laws,
            line: line_contact(
                &sys.model.contact,
                &mut sys.state.contact,
                &mut sys.scratch.contact,
            ),
            loads: &sys.model.loads,
            last: &sys.state.past.q[0],
            tension: &sys.state.load.tension,
            nozzle,
            grown: step.grown,
            gamma: step.gamma,
            elapsed: step.share * step.h,
            diameter: sys.model.section.diameter,
            arc0: sys.state.arc0,
            back: Spin::new(spindle.angle),
            held: [support[0].hold, support[1].hold],
            flat: false,
        }
    }
}

impl Potential<'_> {
    /// Evaluates at `work.q` into `work.gradient` and `work.matrix`.
    pub(super) fn evaluate<const D: usize, U: Unknowns<D>>(
        &mut self,
        work: &mut Work<D, U>,
    ) -> Value {
        self.evaluate_with::<D, U, true>(work)
    }

    /// Evaluates at `work.q` into `work.gradient`; `work.matrix` stays what it was, yield branches are forgotten.
    pub(super) fn evaluate_forces<const D: usize, U: Unknowns<D>>(
        &mut self,
        work: &mut Work<D, U>,
    ) -> Value {
        self.evaluate_with::<D, U, false>(work)
    }

    #[inline(always)]
    fn evaluate_with<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &mut self,
        work: &mut Work<D, U>,
    ) -> Value {
        work.evaluations += 1;
        let nodes = work.q.len();
        let (rod, stretch) = self.rod_and_inertia::<D, U, HESSIAN>(work);
        let energy =
            rod + self.loads::<D, U, HESSIAN>(work) - self.shared_inertia::<D, U, HESSIAN>(work);
        let mut value = Value {
            merit: energy + stretch.merit,
            now: energy + stretch.now,
        };
        self.contact::<D, U, HESSIAN>(work, &mut value);
        let Work {
            matrix, gradient, ..
        } = work;
        self.pinned(nodes, |i, a| {
            gradient[i][a] = 0.0;
            if HESSIAN {
                matrix.pin(i, a);
            }
        });
        let matrix = HESSIAN.then_some(&mut work.matrix);
        work.unknowns.pin(matrix);
        value
    }

    /// Calls `pin` with the node and coordinate of everything that does not move.
    pub(super) fn pinned(&self, nodes: usize, mut pin: impl FnMut(usize, usize)) {
        for (end, i) in [(0, 0), (1, nodes - 1)] {
            for a in 0..3 {
                if self.held[end][a] {
                    pin(i, a);
                }
            }
        }
        if self.flat {
            for i in 0..nodes {
                pin(i, 2);
            }
        }
    }

    /// What lumped inertia has too much where mass is not lumped: `m_e / 12 |d_b - d_a|^2 / gamma^2` of an edge whose
    /// ends are `d` away from where they would fly.
    fn shared_inertia<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &self,
        work: &mut Work<D, U>,
    ) -> f64 {
        let mut energy = 0.0;
        for (j, m) in work.shared_mass.iter().enumerate() {
            let k = m / (self.gamma * self.gamma);
            let apart = (work.q[j + 1] - work.target[j + 1]) - (work.q[j] - work.target[j]);
            energy += 0.5 * k * apart.norm_squared();
            work.gradient[j] += apart * k;
            work.gradient[j + 1] -= apart * k;
            if HESSIAN {
                for a in 0..3 {
                    work.matrix.add_to_entry(j, a, -k);
                    work.matrix.add_to_entry(j + 1, a, -k);
                }
                work.matrix
                    .add(j, 1, &combine(|r, c| if r == c { k } else { 0.0 }));
            }
        }
        energy
    }

    fn loads<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &self,
        work: &mut Work<D, U>,
    ) -> f64 {
        let mut energy = 0.0;
        if self.loads.drag > 0.0 {
            // against the lab-frame velocity (x - x*) / gamma
            for i in 0..work.q.len() {
                let d = work.q[i] - self.back.to_core(work.star[0][i]);
                let k = work.mass[i] * self.loads.drag / self.gamma;
                energy += 0.5 * k * d.norm_squared();
                work.gradient[i] += d * k;
                if HESSIAN {
                    for a in 0..3 {
                        work.matrix.add_to_entry(i, a, k);
                    }
                }
            }
        }
        let matrix = HESSIAN.then_some(&mut work.matrix);
        let drag = self.loads.drag;
        energy += work.unknowns.add_inertia(self.gamma, drag, matrix);
        for (i, f) in &self.loads.nodal {
            let f = self.back.to_core(*f);
            energy -= f.dot(&work.q[*i]);
            work.gradient[*i] -= f;
        }
        for (j, m) in &self.loads.moments {
            // The work is that of turning from the guess, exact in a plane; in space a dead moment has no
            // potential. Without twist it turns the edge and does not roll it
            let m = self.back.to_core(*m);
            let d = work.q[j + 1] - work.q[*j];
            let (length, from) = (d.norm(), work.guess[j + 1] - work.guess[*j]);
            let t = d / length;
            energy -= m.dot(&turning([&(from / from.norm()), &t]));
            let (couple, rolling) = work.unknowns.couple(*j, &m, &t, length);
            energy -= rolling;
            work.gradient[j + 1] -= couple;
            work.gradient[*j] += couple;
        }
        energy
    }

    /// Stretch of all edges, into `work.axial` and the assembly; returns its energy, J.
    #[inline(always)]
    fn stretch<const D: usize, U: Unknowns<D>>(&self, work: &mut Work<D, U>) -> Value {
        let Work {
            unknowns,
            assembly,
            axial,
            expected,
            ..
        } = work;
        let mut sum = Value::default();
        let last = self.rod.edges() - 1;
        let states = self.rod.stretch.iter().zip(&self.rod.rest);
        let edges = axial.iter_mut().zip(expected.iter()).zip(states);
        for (j, ((axial, expected), (state, rest))) in edges.enumerate() {
            let (along, length, inverse) = unknowns.joints().edge(j);
            let mut expected = *expected;
            let s = match (&self.nozzle, &self.first) {
                (_, Some(first)) if j == 0 => {
                    let s = first.stretched(length, expected.length);
                    (expected.energy, expected.tension) = (s.energy, s.tension);
                    expected.length = length;
                    s
                }
                (Some(nozzle), _) if j == last => {
                    let s = nozzle.stretched(length);
                    // it gives way and can go slack: nothing to straighten out there
                    (expected.energy, expected.tension) = (s.energy, s.tension);
                    expected.length = length;
                    s
                }
                // a spike of tension that the update is about to straighten out is no reason to yield
                _ => stretched(&self.laws.stretch, state, *rest, length, expected.length),
            };
            sum.now += s.energy;
            sum.merit += expected.energy + expected.tension * (length - expected.length);
            *axial = Axial {
                along,
                length,
                tension: s.tension,
                stiffness: s.stiffness,
                energy: s.energy,
            };
            // a pressed edge would turn over: its geometric part is left out
            let across = expected.tension.max(0.0) * inverse;
            assembly.stretch(j, s.tension, s.stiffness, across);
        }
        sum
    }

    /// Energy of inertia, gravity and joints, and of stretch.
    fn rod_and_inertia<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &self,
        work: &mut Work<D, U>,
    ) -> (f64, Value) {
        work.yield_branches.clear();
        let wire = (self.rod, self.laws, self.grown);
        let branches = &mut work.yield_branches;
        let mut energy = (work.unknowns).respond::<HESSIAN>(wire, &work.q, branches);
        let axial = self.stretch(work);
        let weight = 1.0 / (self.gamma * self.gamma);
        let gravity = self.back.to_core(self.loads.gravity);
        let Work {
            assembly,
            q,
            gradient,
            matrix,
            unknowns,
            yield_branches,
            ..
        } = work;
        energy += assembly.gather::<D, U, HESSIAN>(
            q,
            (weight, gravity),
            &mut yield_branches.bending,
            (gradient, unknowns, matrix),
        );
        (energy, axial)
    }

    /// Adds the touches of the wire.
    fn contact<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &mut self,
        work: &mut Work<D, U>,
        value: &mut Value,
    ) {
        // taken out while it changes along with the rest of the potential at hand
        let Some(mut line) = self.line.take() else {
            return;
        };
        line.begin();
        line.keep_busy(&work.q);
        for at in 0..line.scratch.busy.len() {
            let point = ContactPoint::of_number(line.scratch.busy[at] as usize);
            self.contact_of::<D, U, HESSIAN>(point, &mut line, work, value);
        }
        self.contact_of_pairs::<D, U, HESSIAN>(&mut line, work, value);
        self.line = Some(line);
    }

    /// Adds the touches of one contact point.
    #[inline(always)]
    fn contact_of<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &self,
        point: ContactPoint,
        line: &mut LineContact<'_>,
        work: &mut Work<D, U>,
        value: &mut Value,
    ) {
        let rest = &self.rod.rest;
        let p = point.place(&work.q);
        let own = || own_wire(point.arc(self.arc0, rest), self.diameter);
        let length = || point.length_with(rest, |i| voronoi(self.rod, self.grown, i));
        if let Some(response) = line.push(point.number(), p, length, own, self.elapsed) {
            value.merit += response.energy_lagged;
            value.now += response.energy;
            let weights = point.weights();
            weights.spread(&response.gradient, &mut work.gradient);
            if HESSIAN {
                weights.spread_block(&response.hessian, &mut work.matrix);
            }
        }
    }

    /// Adds the touches of live wire with live wire.
    fn contact_of_pairs<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &self,
        line: &mut LineContact<'_>,
        work: &mut Work<D, U>,
        value: &mut Value,
    ) {
        let conditions = line.model.of_pairs(self.elapsed, line.state.limit_from);
        let Some(pairs) = &mut line.state.self_contact else {
            return;
        };
        let Work {
            q,
            gradient,
            matrix,
            ..
        } = work;
        pairs.evaluate(
            &mut line.scratch.pairs,
            &conditions,
            (q, self.last),
            |point| ContactPoint::of_number(point).length(self.rod),
            |coupling, response| {
                value.merit += response.energy_lagged;
                value.now += response.energy;
                for place in [&coupling.young, &coupling.old] {
                    place.spread(&response.gradient, gradient);
                    if HESSIAN {
                        place.spread_block(&response.hessian, matrix);
                    }
                }
            },
        );
    }
}

#[inline(always)]
fn combine(entry: impl Fn(usize, usize) -> f64) -> Block {
    std::array::from_fn(|r| std::array::from_fn(|c| entry(r, c)))
}
