//! What can be read of a run: outputs at a communication point, the coil, the wire's centreline.

mod layon;
mod machine;
mod rates;

pub(super) use rates::{rates_of, speeds_of};

use crate::math::{Quat, Spin, V3, turn_about_y};
use crate::measure::{Coil, DefectKind, KINDS, SettledNode};
use crate::signals::Outputs;
use crate::simulation::Winding;
use crate::simulation::verdict::strain_outside;

/// The wire's centreline in the core frame, clamp first, nozzle last.
#[derive(Clone, Debug, Default)]
pub struct Centreline {
    /// node positions, m
    pub points: Vec<V3>,
    /// material frame of the edge leaving each node (the last repeats), body z along the edge
    pub frames: Vec<Quat>,
    /// unstretched length from the clamp, m
    pub arc: Vec<f64>,
    /// plastic stretch of the edge leaving each node
    pub plastic_stretch: Vec<f64>,
    /// largest plastic strain in the section at each node: the plastic stretch and what the plastic curvature adds at the
    /// surface of the bare wire
    pub plastic_strain: Vec<f64>,
    /// tension of the edge leaving each node, N
    pub tension: Vec<f64>,
    /// the first `frozen` nodes are fixed geometry, the rest is live
    pub frozen: usize,
}

impl Winding {
    pub(super) fn wire_tension(&self) -> f64 {
        // below zero the wire hangs loose in the nozzle, which holds nothing
        self.sys
            .state
            .load
            .tension
            .last()
            .copied()
            .unwrap_or(0.0)
            .max(0.0)
    }

    /// Starts the extremes and flags of a communication step with what holds now.
    pub(super) fn reset_extremes(&mut self) {
        let t = if self.run.over {
            0.0
        } else {
            self.wire_tension()
        };
        let mut outputs = self.run.outputs;
        (outputs.wire_tension_min, outputs.wire_tension_max) = (t, t);
        outputs.penetration_max = self.sys.state.depth;
        self.lower_flags(&mut outputs);
        self.run.outputs = outputs;
    }

    /// Leaves up only those flags whose defect holds now, and their code.
    pub(super) fn lower_flags(&self, o: &mut Outputs) {
        let (flags, code) = (self.coil.flags(), self.present_code());
        (o.defect_bulge, o.defect_gap, o.defect_overlap) = (flags.bulge, flags.gap, flags.overlap);
        o.defect_slack = self.run.was_slack;
        o.defect_code = code;
    }

    /// Raises the flags of what is wrong now: one that falls again within the communication step is up at its end.
    pub(super) fn raise_flags(&mut self) {
        let mut now = self.run.outputs;
        self.lower_flags(&mut now);
        raise_as(&mut self.run.outputs, &now);
    }

    /// What is wrong now, as a sum of [`DefectKind::code`].
    fn present_code(&self) -> i32 {
        let laid = self.coil.flags().kinds();
        let slack = self.run.was_slack.then_some(DefectKind::Slack);
        let faults = self.run.faults.iter().map(|fault| fault.kind);
        let over = faults.filter(|kind| kind.ends_winding());
        laid.chain(slack).chain(over).map(DefectKind::code).sum()
    }

    /// The settled wire and, taken as if it were settled, the live wire up to lift-off.
    pub fn coil_with_live_wire(&self) -> Coil {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let lift = self.lift_off();
        let mut arc = self.sys.state.arc0;
        let mut extra = Vec::new();
        for i in 0..=lift {
            let p = spin.to_core(self.sys.centre(i));
            extra.push(self.settled(
                p,
                arc,
                self.sys.state.rod.stretch[i.min(self.sys.state.rod.edges() - 1)].strain,
                self.sys.state.load.tension[i.min(self.sys.state.rod.edges() - 1)],
            ));
            arc += self.sys.state.rod.rest.get(i).copied().unwrap_or(0.0);
        }
        self.coil.what_if(&extra)
    }

    /// Signed distance of a point from what wire is wound on, without flanges, core frame, m.
    pub(super) fn distance_to_wound(&self, p: V3) -> f64 {
        match (&self.scene.core, &self.sys.model.core) {
            (core, Some(surface)) if core.may_have_flanges() => self
                .sys
                .distance_to_wound(p)
                .unwrap_or_else(|| surface.height_over_flank(p)),
            _ => self.sys.distance_to_core(p),
        }
    }

    /// Way along y from wire at a place in the core frame, m, to the flange beside it, m, negative towards -y; none where there is none.
    pub(super) fn flange_beside(&self, place: V3) -> Option<f64> {
        let line = self.sys.model.contact.as_line();
        match line.and_then(|line| line.flanges.as_ref()) {
            Some(flanges) => flanges.beside(place, self.scene.wire.radius()),
            None => {
                let surface = self.sys.model.core.as_ref();
                let surface = surface.filter(|_| self.scene.core.may_have_flanges());
                surface.and_then(|surface| surface.flange_beside(place))
            }
        }
    }

    pub(super) fn settled(
        &self,
        position: V3,
        arc: f64,
        plastic_strain: f64,
        tension: f64,
    ) -> SettledNode {
        let height = self.distance_to_wound(position);
        let height = if height.is_finite() {
            height - self.scene.wire.radius()
        } else {
            0.0
        };
        SettledNode {
            flange: self.flange_beside(position),
            position,
            arc,
            height,
            plastic_strain,
            tension,
            time: self.sys.state.time,
        }
    }

    /// Last node from the clamp that touches something: where the wire leaves the coil.
    pub(super) fn lift_off(&self) -> usize {
        (1..self.sys.state.rod.nodes() - 1)
            .rev()
            .find(|i| self.sys.touches(*i))
            .unwrap_or(0)
    }

    /// The last node of laid wire: that behind which wire lifts off, or one that live wire up to there carries.
    pub(super) fn laid_to(&self) -> usize {
        self.sys.carried_by(self.lift_off())
    }

    /// Angle at the nozzle between the free span and the plane across the axis, rad; positive towards larger y.
    fn nozzle_angle(&self) -> f64 {
        let x = &self.sys.state.rod.x;
        let along = x[x.len() - 2] - x[x.len() - 1];
        libm::atan2(along.y, libm::hypot(along.x, along.z))
    }

    pub(super) fn update_outputs(&mut self) {
        if self.run.over && std::mem::replace(&mut self.run.told_over, true) {
            return self.update_broken();
        }
        self.raise_flags();
        // a flag that holds in the step in which winding ends holds no longer after it
        self.run.was_slack &= !self.run.over;
        let layon = self.layon();
        let pull = self.pull();
        let residual = self
            .sys
            .energy_residual(self.stepper.is_staggered().then_some(self.run.last_step));
        let feed = self.sys.state.feed.unwrap_or_default();
        let tension = self.wire_tension();
        self.count_defects();
        let nozzle_angle = self.nozzle_angle();
        let began = self.run.time > 0.0;
        let nozzle_was = began.then_some(self.run.outputs.nozzle_y);
        self.watch_nozzle(nozzle_was);
        self.watch_even_law(nozzle_was);
        let machine = self.for_the_machine(&layon);
        let rod = &self.sys.state.rod;
        let o = &mut self.run.outputs;
        // A change of the mesh may have moved it since the last look.
        o.meet_tension(tension);
        o.turns_wound = layon.angle.max(0.0) / std::f64::consts::TAU;
        o.turns_settled = self.coil.turns_settled();
        o.spindle_angle = self.sys.state.spindle.angle - self.run.angle0;
        o.fed_length = feed.fed;
        o.free_length = layon.free_length;
        o.layon_position = layon.point.y;
        o.layon_angle = layon.angle;
        o.tensioner_position = feed.paid - self.run.paid0;
        o.nozzle_angle = nozzle_angle;
        o.wire_length = layon.arc;
        o.nozzle_y = self.sys.state.support[1].point.y;
        machine.write(o);
        o.coil_width = self.coil.coil_width();
        o.mean_pitch = self.coil.mean_pitch();
        o.fill_factor = self.coil.fill_factor();
        o.wire_strain = self.coil.wire_strain();
        o.solver_steps = self.run.steps as f64;
        let statistics = self.stepper.statistics();
        o.solver_rejects = (statistics.rejects + statistics.newton_failures) as f64;
        o.live_nodes = rod.nodes() as i32;
        o.energy_residual = residual;
        pull.write(&mut self.run.outputs);
        if self.run.over {
            self.let_go();
        }
        self.watch_for_doubt(residual);
    }

    /// Defects found so far, by the limits that hold now, and the largest values of the last turn.
    pub(super) fn count_defects(&mut self) {
        let worst = self.coil.worst();
        let counts = self.defects_by_kind();
        self.keep_last_defect(&counts);
        let o = &mut self.run.outputs;
        o.defect_break = counts[DefectKind::Break as usize] > 0;
        o.defect_count = counts.iter().sum();
        for (told, count) in counts_told(o).into_iter().zip(counts) {
            *told = count;
        }
        o.bulge_height = worst.bulge_height;
        o.gap_width = worst.gap_width;
        o.overlap_depth = worst.overlap_depth;
    }

    /// How many defects of each kind there are by now, in the order of the kinds.
    fn defects_by_kind(&self) -> [i32; KINDS] {
        let mut counts = [0; KINDS];
        for (count, raised) in counts.iter_mut().zip(self.coil.raised()) {
            *count = raised as i32;
        }
        for fault in &self.run.faults {
            counts[fault.kind as usize] += 1;
        }
        counts
    }

    /// Plastic curvature at a live node, 1/m.
    pub(super) fn plastic_bend(&self, node: usize) -> f64 {
        let [a, b] = self.sys.state.rod.bend[node].curvature;
        libm::hypot(a, b)
    }

    /// The whole wire in the core frame.
    pub fn centreline(&self) -> Centreline {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let back = turn_about_y(-self.sys.state.spindle.angle);
        let rod = &self.sys.state.rod;
        let frozen = &self.sys.state.frozen;
        let mut line = Centreline {
            points: frozen.points.clone(),
            frames: frozen.frames.clone(),
            arc: frozen.arc.clone(),
            plastic_stretch: frozen.plastic_strain.clone(),
            plastic_strain: Vec::new(),
            tension: frozen.tension.clone(),
            frozen: frozen.len(),
        };
        let diameter = self.scene.wire.bare_diameter;
        let largest = |stretch, bend| strain_outside(stretch, bend, diameter);
        let at_rest = frozen.plastic_strain.iter().zip(&frozen.plastic_bend);
        line.plastic_strain
            .extend(at_rest.map(|(stretch, bend)| largest(*stretch, *bend)));
        let loose = self.first_loose_edge();
        let mut arc = self.sys.state.arc0;
        for i in 0..rod.nodes() {
            let j = i.min(rod.edges() - 1);
            line.points.push(spin.to_core(rod.x[i]));
            line.frames.push(back * rod.frame[j]);
            line.arc.push(arc);
            line.plastic_stretch.push(rod.stretch[j].strain);
            line.plastic_strain
                .push(largest(rod.stretch[j].strain, self.plastic_bend(i)));
            line.tension.push(match j < loose {
                true => self.sys.state.load.tension[j],
                false => 0.0,
            });
            arc += rod.rest.get(i).copied().unwrap_or(0.0);
        }
        line
    }
}

/// How many defects of each kind the outputs tell of, in the order of the kinds.
pub(super) fn counts_told(o: &mut Outputs) -> [&mut i32; KINDS] {
    [
        &mut o.defect_count_bulge,
        &mut o.defect_count_gap,
        &mut o.defect_count_overlap,
        &mut o.defect_count_double_turn,
        &mut o.defect_count_skipped_groove,
        &mut o.defect_count_early_jump,
        &mut o.defect_count_late_jump,
        &mut o.defect_count_loose_turn,
        &mut o.defect_count_overstretch,
        &mut o.defect_count_slack,
        &mut o.defect_count_collision,
        &mut o.defect_count_runaway,
        &mut o.defect_count_break,
    ]
}

/// Raises the flags that are up in `other`, and the code with them.
pub(super) fn raise_as(o: &mut Outputs, other: &Outputs) {
    o.defect_bulge |= other.defect_bulge;
    o.defect_gap |= other.defect_gap;
    o.defect_overlap |= other.defect_overlap;
    o.defect_slack |= other.defect_slack;
    o.defect_code |= other.defect_code;
}

/// Gives `o` the extremes and flags that a master was told of.
pub(super) fn keep_told(o: &mut Outputs, told: &Outputs) {
    (o.wire_tension_min, o.wire_tension_max) = (told.wire_tension_min, told.wire_tension_max);
    o.penetration_max = told.penetration_max;
    (o.defect_bulge, o.defect_gap) = (told.defect_bulge, told.defect_gap);
    (o.defect_overlap, o.defect_slack) = (told.defect_overlap, told.defect_slack);
    o.defect_code = told.defect_code;
}
