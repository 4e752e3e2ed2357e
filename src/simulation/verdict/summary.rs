//! The numbers that describe a whole run.

use super::product::Product;
use crate::measure::{
    BulgeLimit, Defect, DefectKind, OnTurn, STATIONS_PER_TURN, Station, TurnMeasures, Verdict,
    left_out, reasons, unfinished,
};
use crate::scene::{Core, Decision, Integrator, Preset};
use crate::simulation::Winding;
use serde::Serialize;
use std::f64::consts::TAU;

/// How much larger the mean gap of turn 2, and of a turn after it, may be at the default tolerance than at a sixteenth of it, diameters:
/// the most that was found on cores with corners (`docs/validation/tables/coils.md`).
const GAP_OF_TOLERANCE: [f64; 2] = [0.08, 0.01];

/// How much larger the largest gap may be there than at a sixty-fourth, on any core, where the nozzle presses each turn on the one before:
/// the most that was found (`docs/validation/convergence.md`).
const GAP_OF_PRESSED: f64 = 0.5;

/// Travel of the nozzle a turn below which it does so, diameters. Chosen: halfway between half a wire, where it was found, and a wire.
const PRESSES: f64 = 0.75;

/// How much smaller the gap of turn 2 that a verdict hangs on may be at the default tolerance than at a quarter of it, diameters: the most
/// that was found (`fig8_gap` at 500 rad/s, `docs/validation/convergence.md`).
const GAP_HIDDEN: f64 = 0.03;

/// Tolerance over the wire's diameter up to which gaps have settled: that of a quarter of the default, and a little more.
const FINE: f64 = 1e-3;

/// How far beyond its place beside a flange's face wire lies that leans on the edge of the rim, diameters. Chosen: wire is pressed into
/// other wire or a face by less than a fifth of that.
const RIM: f64 = 0.1;

/// What `summary.json` holds about the run itself.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// scene name
    pub scene: String,
    /// `default` or `paper`
    pub preset: &'static str,
    /// `rk4` or `verlet`
    pub integrator: &'static str,
    /// what the scene left to the program, what that took, and why
    pub skipped: Vec<Decision>,
    /// node spacing near the core and in the free span, m
    pub spacing_m: [f64; 2],
    /// last time step, s
    pub step_s: f64,
    /// time steps taken
    pub steps: u64,
    /// simulated time, s
    pub simulated_s: f64,
    /// spindle speed at the end, rad/s
    pub speed_rad_per_s: f64,
    /// spindle angle, rad
    pub spindle_angle_rad: f64,
    /// turns laid and turns at rest
    pub turns_wound: f64,
    /// turns at rest
    pub turns_settled: f64,
    /// wire paid out, m
    pub fed_length_m: f64,
    /// verdict over all settled turns, and over what the wire met
    pub verdict: String,
    /// why, in words, the gravest first
    pub reasons: Vec<String>,
    /// the coil as a product
    pub product: Product,
    /// what bulges were judged by
    pub bulge_judged: BulgeLimit,
    /// every defect found, in the order of their times
    pub defects: Vec<Defect>,
    /// energy balance
    pub energy: EnergySummary,
    /// penetration
    pub penetration: PenetrationSummary,
    /// measures per turn
    pub turns: Vec<TurnMeasures>,
}

/// Energy since the start, J. Field names carry the unit, as the JSON does.
#[allow(non_snake_case)]
#[derive(Clone, Copy, Debug, Serialize)]
pub struct EnergySummary {
    /// work of the spindle
    pub spindle_work_J: f64,
    /// work of the feed (negative: the wire pulls against the tensioner)
    pub nozzle_work_J: f64,
    /// motion energy of incoming wire
    pub inflow_J: f64,
    /// elastic energy in live wire and contact
    pub stored_J: f64,
    /// motion energy of live wire
    pub kinetic_J: f64,
    /// elastic energy locked in frozen wire
    pub frozen_stored_J: f64,
    /// motion energy handed to the core with frozen wire
    pub frozen_kinetic_J: f64,
    /// plastic work
    pub plastic_J: f64,
    /// slip against friction
    pub friction_J: f64,
    /// contact dashpots
    pub damping_J: f64,
    /// dissipation by the time steps
    pub numerical_J: f64,
    /// dissipation where the mesh of the wire changes
    pub remeshing_J: f64,
    /// what is unexplained
    pub residual_J: f64,
    /// unexplained over dissipated (plastic, friction, damping)
    pub residual_over_dissipated: f64,
    /// numerical over dissipated
    pub numerical_over_dissipated: f64,
}

/// Depth of contact, m and in wire diameters.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PenetrationSummary {
    /// deepest ever (landings)
    pub largest_m: f64,
    /// deepest of wire when it came to rest
    pub at_rest_m: f64,
    /// deepest ever over d
    pub largest_over_d: f64,
    /// deepest at rest over d
    pub at_rest_over_d: f64,
}

/// How far the place where wire is laid goes at once where it lands on the next corner of a box, turns; on other cores no farther.
const FROM_CORNER: f64 = 0.25;

impl Winding {
    /// Energy balance up to now.
    pub fn energy(&self) -> EnergySummary {
        let b = self.sys.state.balance;
        let plastic: f64 = b.plastic.iter().sum();
        let dissipated = plastic + b.friction + b.damping;
        let scale = if dissipated > 0.0 {
            1.0 / dissipated
        } else {
            0.0
        };
        EnergySummary {
            spindle_work_J: b.spindle,
            nozzle_work_J: b.nozzle,
            inflow_J: b.inflow,
            stored_J: self.sys.stored(),
            kinetic_J: self.sys.kinetic(),
            frozen_stored_J: b.frozen_stored,
            frozen_kinetic_J: b.frozen_kinetic,
            plastic_J: plastic,
            friction_J: b.friction,
            damping_J: b.damping,
            numerical_J: b.numerical,
            remeshing_J: b.remeshing,
            residual_J: self.run.outputs.energy_residual,
            residual_over_dissipated: self.run.outputs.energy_residual * scale,
            numerical_over_dissipated: b.numerical * scale,
        }
    }

    /// Why the run has its verdict, in words, the gravest first.
    pub fn reasons(&self) -> Vec<String> {
        let (defects, turns) = (self.defects(), self.turns());
        let diameter = self.scene.wire.diameter;
        let mut reasons = reasons(
            self.verdict(),
            &defects,
            &turns,
            self.bulge_limit(),
            diameter,
        );
        if !self.scene.freeze.enabled && self.verdict() == Verdict::Unsettled {
            reasons = vec![
                "No wire is judged, since freeze.enabled = false lets none come to rest".to_owned(),
            ];
        }
        reasons.extend(self.gap_of_tolerance(&defects));
        reasons.extend(self.gap_hidden_by_tolerance());
        reasons.extend(self.last_turn_without_place());
        reasons.extend(self.slipped_off());
        reasons.extend(self.wire_on_a_rim().or_else(|| self.wire_against_a_rim()));
        reasons.extend(self.thinned_wire());
        reasons.extend(self.sharply_bent());
        let outputs = &self.run.outputs;
        reasons.extend(left_out(outputs.turns_wound, outputs.turns_settled));
        let held = self.scene.nozzle_law.held();
        reasons.extend(held.and_then(|held| unfinished(outputs.turns_wound, held)));
        let limit = self.scene.window;
        let clearance = limit.and_then(|w| self.coil.clearance(w.height, w.taper));
        if let Some(beyond) = clearance.map(|clear| -clear).filter(|&beyond| beyond > 0.0) {
            reasons.push(format!(
                "No part of the verdict: the coil reaches {:.3} mm beyond its limit line",
                1e3 * beyond
            ));
        }
        reasons
    }

    /// Where wire first lies beyond the inner face of a flange, in words. It got over the rim, and what is wound there is measured as if
    /// it lay on the core.
    pub(super) fn wire_on_a_rim(&self) -> Option<String> {
        let half = 0.5 * self.scene.core.flange()?.inner_distance;
        let at = self
            .coil
            .stations()
            .position(|s| s.position.y.abs() > half)?;
        Some(format!(
            "Wire has got over the rim of a flange: it lies beyond the inner face from {} on",
            OnTurn::of_station(at)
        ))
    }

    /// Where wire first leans on the edge of a rim, in words: higher than the flange, and farther out than wire that lies beside it.
    fn wire_against_a_rim(&self) -> Option<String> {
        let d = self.scene.wire.diameter;
        let face = 0.5 * (self.scene.core.flange()?.inner_distance - d) + RIM * d;
        let leans = |s: &Station| s.position.y.abs() > face;
        let at = self.coil.stations().position(leans)?;
        Some(format!(
            "Wire lies on the edge of a flange's rim from {} on, which is lower than the coil: raise core.flange.height",
            OnTurn::of_station(at)
        ))
    }

    /// That the gaps, if nothing graver is wrong, lie so near their limit that a finer tolerance may show none.
    fn gap_of_tolerance(&self, defects: &[Defect]) -> Option<String> {
        let presses = self.presses_turns();
        let beyond = |d: &Defect| match presses {
            true => GAP_OF_PRESSED,
            false => GAP_OF_TOLERANCE[usize::from(d.turn > 2)],
        };
        let farthest = |d: &Defect| self.scene.defects.gap + beyond(d);
        let of_gaps = defects.iter().filter(|d| d.kind == DefectKind::Gap);
        let near = of_gaps
            .clone()
            .all(|d| d.size_d.is_some_and(|size| size < farthest(d)));
        let most = of_gaps.map(beyond).reduce(f64::max);
        let most = most.filter(|_| self.verdict() == Verdict::Gap);
        let hangs = self.shakes_unseen() || presses && self.steps_by_tolerance();
        // (pressed turns take a sixteenth)
        let share = if presses { 1.0 / 16.0 } else { 0.25 };
        most.filter(|_| hangs && near).map(|most| {
            let gaps = defects.iter().filter(|d| d.kind == DefectKind::Gap);
            let last = gaps.map(|d| d.turn).max().unwrap_or(0);
            format!(
                "Gaps within {most} d of their limit may come of the tolerance: see whether they stay with solver.tolerance = {:.2e}{}",
                share * self.scene.solver.tolerance,
                self.turns_that_show(last)
            )
        })
    }

    /// From where on wire at the end of the plan lies on the turn before, and how to end the coil there, unless wire rides up sooner.
    fn last_turn_without_place(&self) -> Option<String> {
        let at = self.coil.without_place_from()?;
        // (down, and to half a tenth: wire that is not laid there need not be judged there; it is laid ahead of the core, and on one with
        // corners by up to a quarter of a turn more than now)
        let o = self.outputs();
        let swing = match self.scene.core {
            Core::Cylinder { .. } => 0.0,
            _ => FROM_CORNER,
        };
        let ahead = o.turns_wound - o.spindle_angle.abs() / TAU + swing;
        let ends = (20.0 * (at as f64 / STATIONS_PER_TURN as f64 - ahead)).floor() / 20.0;
        let remedy = match self.coil.rides_up_before(at) {
            true => String::new(),
            false => format!(
                ". With spindle.turns = {ends:.2}, or inputs that end there, the coil ends before"
            ),
        };
        Some(format!(
            "From {} on wire lies on the turn before, which has crossed into its place; within half a turn of the end that is no defect{remedy}",
            OnTurn::of_station(at)
        ))
    }

    /// Whether the nozzle travels by so little that each turn lands on the one before and slides off it.
    fn presses_turns(&self) -> bool {
        let law = &self.scene.nozzle_law;
        let [from, to] = [1.0, 2.0].map(|turn| law.position(turn * TAU));
        law.jumps().is_empty() && (to - from).abs() < PRESSES * self.scene.wire.diameter
    }

    /// That the gap of turn 2, though no defect, lies so near its limit that a finer tolerance may show one.
    fn gap_hidden_by_tolerance(&self) -> Option<String> {
        let (d, limit) = (self.scene.wire.diameter, self.scene.defects.gap);
        let short = limit - self.coil.lasting_gap(2)? / d;
        let hides = self.verdict() <= Verdict::Marginal && self.shakes_unseen();
        (hides && (0.0..GAP_HIDDEN).contains(&short)).then(|| {
            format!(
                "The gap of turn 2 is {short:.3} d below its limit of {limit} d, which it may pass at a finer tolerance: see whether it does with solver.tolerance = {:.2e}{}",
                0.25 * self.scene.solver.tolerance,
                self.turns_that_show(2)
            )
        })
    }

    /// That winding less than this run has wound shows all of `turn`, in words. Wire comes to rest within a turn and a half.
    fn turns_that_show(&self, turn: u32) -> String {
        let enough = f64::from(turn) + 1.5;
        match enough < self.outputs().turns_wound - 1.0 {
            true => format!("; {enough} turns are enough for that"),
            false => String::new(),
        }
    }

    /// Whether the free span shakes faster than the tolerance lets the steps follow, so that gaps hang on it: on a core with corners.
    fn shakes_unseen(&self) -> bool {
        let round = matches!(self.scene.core, Core::Cylinder { .. });
        self.steps_by_tolerance() && !round
    }

    /// Whether the tolerance decides on the steps, and is above that at which gaps have settled.
    fn steps_by_tolerance(&self) -> bool {
        let solver = &self.scene.solver;
        let steps = self.stepper.is_implicit() && solver.features.inertia;
        steps && solver.tolerance > FINE * self.scene.wire.diameter
    }

    /// The run in numbers.
    pub fn summary(&self) -> Summary {
        let d = self.scene.wire.diameter;
        Summary {
            scene: self.scene.name.clone(),
            preset: match self.scene.preset {
                Preset::Default => "default",
                Preset::Paper => "paper",
            },
            integrator: match self.scene.solver.integrator {
                Integrator::Rk4 => "rk4",
                Integrator::Verlet => "verlet",
                Integrator::Implicit => "implicit",
            },
            skipped: self.scene.skipped.clone(),
            spacing_m: [
                self.scene.solver.spacing_near,
                self.scene.solver.spacing_free,
            ],
            step_s: self.run.last_step,
            steps: self.run.steps,
            simulated_s: self.run.time,
            speed_rad_per_s: self.sys.state.spindle.speed,
            spindle_angle_rad: self.run.outputs.spindle_angle,
            turns_wound: self.run.outputs.turns_wound,
            turns_settled: self.run.outputs.turns_settled,
            fed_length_m: self.run.outputs.fed_length,
            verdict: self.verdict().as_str().to_owned(),
            reasons: self.reasons(),
            product: self.product(),
            bulge_judged: self.bulge_limit(),
            defects: self.defects(),
            energy: self.energy(),
            penetration: PenetrationSummary {
                largest_m: self.sys.state.deepest,
                at_rest_m: self.run.rest_depth,
                largest_over_d: self.sys.state.deepest / d,
                at_rest_over_d: self.run.rest_depth / d,
            },
            turns: self.turns(),
        }
    }
}
