//! Forces of the production method: joints of the whole wire at once, contact along its smooth centreline.

use super::{Past, System, line_contact};
use crate::contact::{ContactPoint, LimitFrom, LineContact, MostTurn, own_wire};
use crate::math::{Spin, V3};
use crate::rod::Rod;

impl System {
    /// Makes the history of the present instant complete: at the start and after changes of the wire.
    pub(crate) fn begin_past(&mut self) {
        let nodes = self.state.rod.nodes();
        if self.state.past.q[0].len() != nodes || self.state.past.known == 0 {
            let spin = Spin::new(self.state.spindle.angle);
            self.state.past.known = 0;
            self.state.past.q[0].clear();
            self.state.past.q[0].extend(self.state.rod.x.iter().map(|x| spin.to_core(*x)));
            if let Some(f) = &self.state.feed {
                self.state.past.keep_feed(f);
                // (two instants back is the present one as well)
                self.state.past.keep_feed(f);
            }
            if self.model.twist.is_carried() {
                self.state.past.forget_rolls(self.state.rod.edges());
            }
            self.place_points();
        }
        if self.state.load.force.len() != nodes {
            self.evaluate_smooth(0.0, false);
        }
    }

    /// Time in which the nozzle goes past the wire before it by `angle` as seen along the edge there, s.
    pub(crate) fn time_to_turn_nozzle_edge(&self, angle: f64) -> f64 {
        if self.state.feed.is_none() {
            return f64::INFINITY;
        }
        let last = self.state.rod.edges() - 1;
        let edge = self.state.rod.x[last + 1] - self.state.rod.x[last];
        let way = self.state.support[1].velocity - self.state.rod.v[last];
        angle * edge.norm_squared() / edge.cross(&way).norm()
    }

    /// Forces of the present state after it was set up or changed; nothing moves on but the frames.
    pub fn refresh(&mut self) {
        if !self.model.is_for_implicit_steps() {
            return self.evaluate(Some(0.0));
        }
        self.internal_at_once(true);
        self.begin_past();
        self.place_points();
        self.touch_forces(0.0, false);
    }

    /// Begins an attempt at a step that may take the nodes to `guess` (core frame, m): lists the pairs of live wire.
    pub(crate) fn begin_attempt(&mut self, guess: &[V3]) {
        let Some(mut line) = line_contact(
            &self.model.contact,
            &mut self.state.contact,
            &mut self.scratch.contact,
        ) else {
            return;
        };
        line.begin_attempt();
        if let Some(pairs) = &mut line.state.self_contact {
            let (from, rest) = (&self.state.past.q[0], &self.state.rod.rest);
            let diameter = self.model.section.diameter;
            pairs.list(&mut line.scratch.pairs, (from, guess), rest, diameter);
        }
    }

    /// Share of the way to `guess` on which no touch turns its normal by more than `most` after it began; 1: all of it.
    /// Ways below `unseen`, m, are no matter.
    pub(crate) fn share_to_turn(&mut self, guess: &[V3], most: MostTurn, unseen: f64) -> f64 {
        let Some(mut line) = line_contact(
            &self.model.contact,
            &mut self.state.contact,
            &mut self.scratch.contact,
        ) else {
            return 1.0;
        };
        let diameter = self.model.section.diameter;
        let rest = &self.state.rod.rest;
        let mut share = 1.0_f64;
        line.list_busy_at(guess);
        for at in 0..line.scratch.busy.len() {
            let point = ContactPoint::of_number(line.scratch.busy[at] as usize);
            let own = || own_wire(point.arc(self.state.arc0, rest), diameter);
            let to = point.place(guess);
            share = share.min(line.share_to_turn(point.number(), to, own, most, unseen));
        }
        share
    }

    /// Puts the present places of the contact points on record.
    fn place_points(&mut self) {
        let Some(line) = self.state.contact.as_line_mut() else {
            return;
        };
        let q = &self.state.past.q[0];
        for point in ContactPoint::all(q.len() - 1) {
            line.place(point.number(), point.place(q));
        }
    }

    /// Forces at the present state into `load`, with contact of the line kind. `commit` moves plastic
    /// state, frames and anchors on after a step of `h`.
    pub(crate) fn evaluate_smooth(&mut self, h: f64, commit: bool) {
        self.internal_at_once(commit);
        self.touch_forces(h, commit);
    }

    /// Moment of forces on the free nodes about the core's axis, N m; what the joint at the nozzle acts on is no
    /// business of the core's.
    pub(crate) fn moment_of(&self, force: impl Fn(usize) -> V3) -> f64 {
        let free = self.free_nodes();
        let end = match self.state.feed {
            Some(_) => free.end.min(self.state.rod.nodes().saturating_sub(3)),
            None => free.end,
        };
        (free.start..end)
            .map(|i| {
                let (x, f) = (self.state.rod.x[i], force(i));
                x.z * f.x - x.x * f.z
            })
            .sum()
    }

    /// Whether the spring of contact follows its load within a step of `h`, s: that is longer than wire on it takes for a radian of its swing.
    pub(crate) fn contact_follows(&self, h: f64) -> bool {
        let stiffness =
            (self.model.contact.as_line()).map_or(f64::INFINITY, |line| line.law.stiffness);
        h * h * stiffness > self.model.section.mass_per_length()
    }

    /// Moment of momentum of the same nodes about the core's axis, N m s.
    pub(crate) fn momentum_about_core(&self) -> f64 {
        let rod = &self.state.rod;
        let density = self.model.section.mass_per_length();
        self.moment_of(|i| rod.v[i] * (density * rod.voronoi(i)))
    }

    /// Lets the core hold what Newton's method left of the forces: it is nothing that moves wire in the core's frame.
    ///
    /// Taken so, the torque is that of the nozzle's force less what turns the wire's mass. Were it summed up from stiff touches alone,
    /// what they are off by would go with the core's whole way, and that is far longer than any way on the core.
    fn hold_unbalanced(&mut self) {
        let Some(turning) = self.state.turning else {
            return;
        };
        self.state.unbalanced = self.moment_of(|i| self.state.load.force[i]) - turning;
        self.state.torque_on_core += self.state.unbalanced;
    }

    /// Adds the forces of contact to those in `load`.
    fn touch_forces(&mut self, h: f64, commit: bool) {
        let spin = Spin::new(self.state.spindle.angle);
        let mut moment = 0.0;
        if let Some(mut line) = line_contact(
            &self.model.contact,
            &mut self.state.contact,
            &mut self.scratch.contact,
        ) {
            let (rod, force) = (&self.state.rod, &mut self.state.load.force);
            let diameter = self.model.section.diameter;
            let step = if h > 0.0 { h } else { f64::INFINITY };
            line.scratch.accepted.clear();
            if commit {
                line.state.deepest = 0.0;
                line.commit_left(
                    |k| spin.to_core(ContactPoint::of_number(k).place(&rod.x)),
                    |k| ContactPoint::of_number(k).length(rod),
                );
                line.commit_idle(&rod.x, |p| spin.to_core(p));
            } else {
                line.list_busy(&rod.x, |p| spin.to_core(p));
            }
            for at in 0..line.scratch.busy.len() {
                let point = ContactPoint::of_number(line.scratch.busy[at] as usize);
                let k = point.number();
                let length = || point.length(rod);
                let own = || own_wire(point.arc(self.state.arc0, &rod.rest), diameter);
                let p = point.place(&rod.x);
                let q = spin.to_core(p);
                let f = if commit {
                    line.commit(k, q, length, own, step)
                } else {
                    line.push(k, q, length, own, step)
                        .map_or(V3::zeros(), |s| -s.gradient)
                };
                if f == V3::zeros() {
                    continue;
                }
                let f = spin.to_lab(f);
                moment -= p.z * f.x - p.x * f.z;
                point.weights().spread(&f, force);
            }
            moment += between_forces(&mut line, rod, force, &self.state.past, spin, step, commit);
            if commit {
                self.state.depth = line.state.deepest;
                self.state.deepest = self.state.deepest.max(line.state.deepest);
            }
            let pairs = line.state.self_contact.as_ref();
            let pairs = pairs.map(|pairs| pairs.loss).unwrap_or_default();
            self.state.balance.friction = line.state.loss.friction + pairs.friction;
            self.state.balance.damping = line.state.loss.damping + pairs.damping;
            self.state.balance.numerical -= std::mem::take(&mut line.scratch.lifted);
        }
        self.state.torque_on_core = moment + self.clamp_torque();
        self.hold_unbalanced();
    }
}

/// Forces of live wire on live wire; returns what they leave as a moment on the core.
///
/// Both sides of a friction force act on centrelines a diameter apart, for the couples that it puts on either wire are left
/// out, as they are where the core rubs. It is seen and held in the core's frame, so the core takes the couple.
fn between_forces(
    line: &mut LineContact<'_>,
    rod: &Rod,
    force: &mut [V3],
    past: &Past,
    spin: Spin,
    step: f64,
    commit: bool,
) -> f64 {
    let conditions = line.model.of_pairs(step, LimitFrom::Slide);
    let Some(pairs) = &mut line.state.self_contact else {
        return 0.0;
    };
    let mut moment = 0.0;
    let mut q = std::mem::take(&mut line.scratch.pairs.wire);
    q.clear();
    q.extend(rod.x.iter().map(|x| spin.to_core(*x)));
    let last = if past.q[0].len() == q.len() {
        &past.q[0]
    } else {
        &q
    };
    let length = |number| ContactPoint::of_number(number).length(rod);
    let mut used = std::mem::take(&mut line.scratch.pairs.used);
    pairs.limits(&mut used);
    let scratch = &mut line.scratch.pairs;
    pairs.evaluate(
        scratch,
        &conditions,
        (&q, last),
        length,
        |coupling, response| {
            let f = spin.to_lab(response.gradient);
            for place in [&coupling.young, &coupling.old] {
                for (node, weight) in place.iter() {
                    let (f, p) = (f * weight, rod.x[node]);
                    force[node] -= f;
                    moment += p.z * f.x - p.x * f.z;
                }
            }
        },
    );
    if commit {
        let accepted = &mut line.scratch.accepted;
        let law = (conditions.law, conditions.onset);
        pairs.commit(law, (&q, last), length, &used, accepted);
        line.state.deepest = line.state.deepest.max(pairs.deepest());
    }
    (line.scratch.pairs.wire, line.scratch.pairs.used) = (q, used);
    moment
}
