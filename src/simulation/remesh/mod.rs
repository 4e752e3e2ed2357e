//! Remeshing between steps: insert, refine, freeze, thaw and join.

mod coarsen;
mod refining;

pub(super) use refining::shortest_edge;

use crate::geometry::FrozenNode;
use crate::integrate::NOZZLE_TURN;
use crate::math::{Spin, polar_angle, turn_about_y, wrap_to_pi};
use crate::scene::LiveContact;
use crate::simulation::{SimError, Winding};
use std::f64::consts::TAU;

/// Steps between looks for edges to refine and values that are not finite.
const REMESH_STEPS: u64 = 32;

/// The live wire never gets shorter than this many nodes: clamp, nozzle and two between.
const FEWEST_NODES: usize = 4;
/// Cosine of the angle between edges that may be joined: 10 mrad, at which the chord of two equal edges is
/// 1.3e-5 shorter than they are.
const STRAIGHT: f64 = 0.99995;

/// Angle between edges from which on the longer one is halved, rad. Chosen: from 0.3 rad on, a split made as much energy as
/// slack wire has. A look comes after the step in which an edge bends beyond it, so halved edges bend by more.
pub(super) const BENT: f64 = NOZZLE_TURN;

/// Share of the spacing below which an edge of bent wire goes back into the nozzle whole. The chord then loses a 22nd of the spacing
/// times the square of the angle; steps take a quarter of the edge each.
const SHORTEST_BENT: f64 = 0.1;
/// Angle from which on that share goes down with its square, so that the chord loses no more, rad. Four times [`BENT`]: wire that
/// turns by more from edge to edge is folded.
const WELL_BENT: f64 = 4.0 * BENT;

/// Share of the edge after it below which the first live edge goes, which frozen wire draws on where its tension falls. Chosen: as at the
/// nozzle. The chord loses as little, and a step that takes all of an edge is never tried.
const SHORTEST_FIRST: f64 = SHORTEST_BENT;

/// Turns of live wire, the free span with them, from which on it may meet itself. Partners are sought a turn back, within 0.6 rad
/// (`WINDOW` of that search) and half of what their segment takes up.
const WHOLE: f64 = 0.85;

impl Winding {
    pub(super) fn remesh(&mut self, dt: f64) -> Result<(), SimError> {
        let look = self.stepper.is_implicit() || self.run.steps.is_multiple_of(REMESH_STEPS);
        if look {
            self.check_health()?;
            if self.run.over {
                // (the outputs are those of the instant that the end is told with)
                return Ok(());
            }
            self.sys.turn_folded_clamp();
        }
        if self.stepper.is_implicit() {
            self.follow_returning_wire();
            self.join_short_first_edge();
        }
        let insert = self.nozzle_edge_is_long();
        let refine = if look {
            self.edges_to_refine(dt)
        } else {
            Vec::new()
        };
        let s = self.sys.state.spindle;
        let due = self
            .run
            .watch
            .due(&self.run.policy, s.angle, s.speed, self.sys.state.time);
        let freeze = if due { self.nodes_to_freeze() } else { 0 };
        if due {
            self.follow_slip();
        }
        let coarsen = if due && self.scene.solver.features.coarse_settled {
            self.nodes_to_coarsen()
        } else {
            Vec::new()
        };
        if !insert && refine.is_empty() && freeze == 0 && coarsen.is_empty() {
            return Ok(());
        }
        self.shift_velocities(0.5 * dt);
        let unexplained = self.sys.energy_residual(None);
        if insert {
            let last = self.sys.state.rod.edges() - 1;
            self.split(last);
        }
        // from the nozzle down, so that the numbers of the others stay
        for j in refine.into_iter().rev() {
            self.split(j);
        }
        if look {
            self.refine_ahead_of_touch(dt);
        }
        for i in coarsen.into_iter().rev() {
            if i > freeze + 1 {
                self.join(i);
            }
        }
        if freeze > 0 {
            self.freeze(freeze);
        }
        self.sys.follow_mesh(unexplained);
        self.shift_velocities(-0.5 * dt);
        Ok(())
    }

    /// With the staggered step, brings velocities to the time of the positions and back.
    fn shift_velocities(&mut self, half: f64) {
        if self.stepper.is_staggered() {
            crate::integrate::shift_velocities(&mut self.sys, half);
        }
    }

    pub(super) fn split(&mut self, edge: usize) {
        self.sys.split(edge);
        self.run.watch.insert(edge + 1);
    }

    /// The last edge has grown to two spacings: time for a new node halfway.
    ///
    /// Where wire bends twice as much as is bent, one spacing will do, as far as the halves are no finer than the finest. The edge before
    /// is halved once it is no shorter than this one, and must not wait for it.
    fn nozzle_edge_is_long(&self) -> bool {
        let last = self.sys.state.rod.edges() - 1;
        let spacing = self.spacing_at_nozzle(BENT);
        let long = if self.is_bent_at_nozzle(2.0 * BENT) {
            spacing.max(2.0 * self.scene.solver.spacing_near)
        } else {
            2.0 * spacing
        };
        self.sys.state.rod.rest[last] >= long.min(2.0 * spacing)
    }

    /// Spacing at the nozzle, m: that of the free span, and where wire bends there by `bent` (rad) or more, that of the edge before.
    ///
    /// A long edge that comes out of the nozzle replaces an arc by its chord.
    fn spacing_at_nozzle(&self, bent: f64) -> f64 {
        let (rod, solver) = (&self.sys.state.rod, self.scene.solver);
        let free = solver.spacing_free;
        if self.is_bent_at_nozzle(bent) {
            rod.rest[rod.edges() - 2].clamp(solver.spacing_near.min(free), free)
        } else {
            free
        }
    }

    /// Whether the wire bends by more than `bent` (rad) at one of the two nodes before the nozzle.
    fn is_bent_at_nozzle(&self, bent: f64) -> bool {
        self.stepper.is_implicit() && self.least_cosine_at_nozzle() < libm::cos(bent)
    }

    /// Cosine of the larger of the angles by which the wire bends at the two nodes before the nozzle.
    fn least_cosine_at_nozzle(&self) -> f64 {
        let last = self.sys.state.rod.edges() - 1;
        (last.saturating_sub(1).max(1)..=last)
            .map(|node| self.cosine_at(node))
            .fold(1.0, f64::min)
    }

    /// Cosine of the angle between the edges at a node.
    fn cosine_at(&self, node: usize) -> f64 {
        let rod = &self.sys.state.rod;
        rod.tangent(node - 1).dot(&rod.tangent(node))
    }

    /// Whether the edges at a node turn by more than `angle`, rad.
    pub(super) fn bends_by(&self, node: usize, angle: f64) -> bool {
        self.cosine_at(node) < libm::cos(angle)
    }

    /// Height of the layers below the one that is wound, m: lengths that count from the core count from there.
    pub(super) fn layers_below(&self) -> f64 {
        f64::from(self.coil.layer() - 1) * self.scene.wire.diameter
    }

    /// How many nodes from the clamp are at rest, settled long enough and in place (eq. 8, 9).
    fn nodes_to_freeze(&mut self) -> usize {
        let angle = self.sys.state.spindle.angle;
        let spin = Spin::new(angle);
        let lift = self.lift_off();
        self.behind.clear();
        self.behind.resize(lift + 1, 0.0);
        let x = &self.sys.state.rod.x;
        let mut last = polar_angle(spin.to_core(x[lift]));
        for i in (0..lift).rev() {
            let polar = polar_angle(spin.to_core(x[i]));
            self.behind[i] = self.behind[i + 1] + wrap_to_pi(last - polar).abs();
            last = polar;
        }
        let still = self.run.watch.look(
            &self.run.policy,
            angle,
            self.sys.state.time,
            |i| spin.to_core(x[i]),
            |i| self.behind.get(i).copied().unwrap_or(0.0),
        );
        self.watch_live_wire();
        if !self.scene.freeze.enabled {
            return 0;
        }
        // the last one that is at rest becomes the clamp
        let count = still.saturating_sub(1).min(self.behind_lift_off());
        let reach = self.layers_below() + 2.0 * self.scene.wire.radius() + self.run.policy.margin;
        (0..count)
            .find(|&i| {
                let place = spin.to_core(self.sys.state.rod.x[i + 1]);
                // (what the free span draws at no more stays where it is, however far off)
                self.behind[i + 1] <= self.run.policy.patience
                    && !self.sys.is_near_core(place, reach)
            })
            .unwrap_or(count)
    }

    /// Live wire meets live wire where lift-off comes round before the wire there is at rest. A whole
    /// flat can land at once, so the pairs are watched from half a turn on.
    fn watch_live_wire(&mut self) {
        // wire too stiff for its tension stands off and touches nothing: there all of a turn counts
        let whole = self.sys.state.rod.nodes() - 1;
        let watched = match self.scene.solver.features.live_contact {
            LiveContact::Always => true,
            LiveContact::WhenHalfATurnIsLive => {
                self.angle_of_wire(self.lift_off()) > 0.5 * TAU
                    || self.angle_of_wire(whole) > WHOLE * TAU
            }
            LiveContact::Never => false,
        };
        if watched {
            self.sys.state.contact.watch_live_wire();
        }
    }

    /// Polar angle that the live wire covers from the clamp to a node, rad.
    fn angle_of_wire(&self, end: usize) -> f64 {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let x = &self.sys.state.rod.x;
        let mut last = (0.0, polar_angle(spin.to_core(x[0])));
        for x in &x[..=end] {
            let polar = polar_angle(spin.to_core(*x));
            last = (last.0 + wrap_to_pi(polar - last.1), polar);
        }
        last.0.abs()
    }

    /// The first `count` nodes become fixed geometry.
    fn freeze(&mut self, count: usize) {
        let angle = self.sys.state.spindle.angle;
        let spin = Spin::new(angle);
        let back = turn_about_y(-angle);
        let mut arc = self.sys.state.arc0;
        let told = self.run.events.len();
        if let Some(mut l) = self.sys.line_contact() {
            l.go_on(None);
        }
        for i in 0..count {
            let node = FrozenNode {
                point: spin.to_core(self.sys.state.rod.x[i]),
                frame: back * self.sys.state.rod.frame[i],
                arc,
                tension: self.sys.state.load.tension[i],
                plastic_strain: self.sys.state.rod.stretch[i].strain,
                plastic_bend: self.plastic_bend(i),
            };
            let centre = spin.to_core(self.sys.centre(i));
            let settled = self.settled(centre, arc, node.plastic_strain, node.tension);
            if i > 0 {
                self.run.rest_depth = self.run.rest_depth.max(self.sys.depth(i));
            }
            self.sys.lay_frozen(node);
            self.settle_and_tell(settled);
            arc += self.sys.state.rod.rest[i];
        }
        self.sys.freeze_front(count);
        self.run.watch.remove_front(count);
        self.join_frozen_to_live();
        self.sys.notice_laid(count);
        if self.run.events.len() > told {
            // A node that had settled counted as live as well: where a whole turn comes to rest at once, it was counted twice.
            let turn = self.layon().angle.max(0.0) / TAU;
            (self.run.events[told..].iter_mut()).for_each(|event| event.turn = turn);
        }
    }

    /// Wire that comes off the core again: frozen wire thaws near lift-off, and what goes back into the
    /// nozzle takes its nodes along.
    fn follow_returning_wire(&mut self) {
        let thaw = self.nodes_to_thaw();
        let returning = self.sys.state.feed.is_some_and(|f| f.rate < 0.0);
        let join = if returning {
            self.older_wire.measure(&self.sys);
            self.nodes_to_join()
        } else {
            Vec::new()
        };
        let short = self.nozzle_edge_is_short();
        if thaw == 0 && join.is_empty() && !short {
            return;
        }
        let unexplained = self.sys.energy_residual(None);
        for i in join.into_iter().rev() {
            self.join(i);
        }
        while self.nozzle_edge_is_short() {
            self.join(self.sys.state.rod.nodes() - 2);
        }
        if thaw > 0 {
            self.thaw(thaw);
        }
        self.sys.follow_mesh(unexplained);
    }

    /// Frozen wire that slips along itself takes up length of the first live edge. Before that is used up, the edge joins the next one.
    fn join_short_first_edge(&mut self) {
        let rod = &self.sys.state.rod;
        let is_short = rod.rest[0] < SHORTEST_FIRST * rod.rest[1];
        if !is_short || rod.nodes() <= FEWEST_NODES || self.sys.friction_at_rest().is_none() {
            return;
        }
        let unexplained = self.sys.energy_residual(None);
        if let Some(mut l) = self.sys.line_contact() {
            l.go_on(None);
        }
        self.join(1);
        self.join_frozen_to_live();
        self.sys.follow_mesh(unexplained);
    }

    fn join(&mut self, node: usize) {
        self.sys.merge(node);
        self.run.watch.remove(node);
    }

    /// The edge at the nozzle has shrunk below half a spacing, and there is wire to join it to.
    ///
    /// Where wire bends, an edge may become shorter before it goes: the chord that replaces it and its neighbour is shorter than
    /// they are by what it is long itself. A split takes a fifth off the bend, so half of it is bent still, or nodes would come and
    /// go in turns.
    fn nozzle_edge_is_short(&self) -> bool {
        let rod = &self.sys.state.rod;
        let share = if self.is_bent_at_nozzle(BENT) {
            // the square of the angle, in the small
            let bend = 2.0 * (1.0 - self.least_cosine_at_nozzle());
            SHORTEST_BENT * (WELL_BENT * WELL_BENT / bend).min(1.0)
        } else {
            0.5
        };
        rod.nodes() > FEWEST_NODES
            && rod.rest[rod.edges() - 1] < share * self.spacing_at_nozzle(0.5 * BENT)
    }

    /// Nodes of the free span that lie close together far from the core, no two of them neighbours.
    fn nodes_to_join(&self) -> Vec<usize> {
        let solver = self.scene.solver;
        let spin = Spin::new(self.sys.state.spindle.angle);
        // twice the distance at which edges are split, or it would go to and fro
        let reach = self.layers_below() + 2.0 * solver.refine_distance + self.scene.wire.radius();
        let rod = &self.sys.state.rod;
        let mut nodes = Vec::new();
        let mut i = self.lift_off() + 2;
        while i + 2 < rod.nodes() && rod.nodes() - nodes.len() > FEWEST_NODES {
            let both = rod.rest[i - 1] + rod.rest[i];
            // a kink stays: the joined edge would hide it, or be halved at once
            let straight = rod.tangent(i - 1).dot(&rod.tangent(i)) > STRAIGHT
                && [i - 1, i + 1]
                    .iter()
                    .all(|&end| !self.bends_by(end, 0.5 * BENT));
            if both < 1.2 * solver.spacing_free
                && straight
                && self.moves_with_its_chord(i)
                && rod.x[i - 1..=i + 1]
                    .iter()
                    .all(|x| !self.sys.is_near_core(spin.to_core(*x), reach))
                && !(i - 1..=i).any(|j| {
                    self.older_wire
                        .lies_near(&self.sys, j, 2.0 * solver.refine_distance)
                })
            {
                nodes.push(i);
                i += 1;
            }
            i += 1;
        }
        nodes
    }

    /// Whether a node moves as its place on the chord does, so that the wire's motion is kept where the chord takes its place.
    ///
    /// The energy of its own motion may be that of a bend which counts as straight.
    fn moves_with_its_chord(&self, node: usize) -> bool {
        let rod = &self.sys.state.rod;
        let [a, b] = [rod.rest[node - 1], rod.rest[node]];
        let chord = (rod.v[node - 1] * b + rod.v[node + 1] * a) / (a + b);
        let inertia = self.sys.model.section.mass_per_length() * 0.5 * (a + b);
        let stiffness = self.sys.model.laws.bend.modulus / (0.5 * (a + b));
        inertia * (rod.v[node] - chord).norm_squared() < stiffness * 2.0 * (1.0 - STRAIGHT)
    }

    /// How many frozen nodes come back: once less than half of the keep length is left live behind
    /// lift-off, as many as restore it. Half, so that wire does not freeze and thaw in turns.
    fn nodes_to_thaw(&self) -> usize {
        let left: f64 = self.sys.state.rod.rest[..self.lift_off()].iter().sum();
        if left >= 0.5 * self.run.policy.keep_length {
            return 0;
        }
        let mut missing = self.run.policy.keep_length - left;
        self.sys
            .frozen_lengths()
            .take_while(|length| {
                let more = missing > 0.0;
                missing -= length;
                more
            })
            .count()
    }

    /// The curve of frozen wire runs on to the middle of the first live edge, where that of live wire begins.
    fn join_frozen_to_live(&mut self) {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let (rod, arc) = (&self.sys.state.rod, self.sys.state.arc0);
        let ahead = [
            (spin.to_core(rod.x[0]), arc),
            (spin.to_core(rod.x[1]), arc + rod.rest[0]),
        ];
        if let Some(mut l) = self.sys.line_contact() {
            l.go_on(Some(ahead));
        }
    }

    /// The last `count` frozen nodes come back to life.
    fn thaw(&mut self, count: usize) {
        if let Some(mut l) = self.sys.line_contact() {
            l.go_on(None);
        }
        let count = self.sys.thaw_front(count);
        self.sys.take_up_frozen(count);
        self.join_frozen_to_live();
        self.take_back(count);
        self.run.watch.insert_front(count);
        if let Some(l) = self.sys.line_contact() {
            l.state.forget_surroundings();
        }
        // what was frozen wire to the wire on it is live wire now, and is lost sight of until it is watched
        self.watch_live_wire();
    }

    /// How many nodes from the clamp lie at least the keep length behind lift-off.
    fn behind_lift_off(&self) -> usize {
        let mut left = self.run.policy.keep_length;
        let mut i = self.lift_off();
        while i > 0 && left > 0.0 {
            i -= 1;
            left -= self.sys.state.rod.rest[i];
        }
        if left > 0.0 { 0 } else { i }
    }
}
