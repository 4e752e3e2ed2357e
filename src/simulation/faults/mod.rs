//! What ends or spoils a run. Slack and breaks of the wire are kept as defects with their place; the verdict counts them.

mod broken;
mod collision;
mod health;
mod slipping;

use crate::feed::FeedSpec;
use crate::math::{Spin, V3, polar_angle, wrap_to_pi};
use crate::measure::{
    Defect, DefectKind, DefectPlace, KINDS, MEASURED, OnTurn, STATION_STEP, TurnMeasures, Verdict,
};
use crate::signals::EventKind;
use crate::simulation::Winding;
use crate::simulation::outputs::counts_told;
use crate::simulation::winding::SlackSince;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::Range;

/// Turn of the core within which wire that is slack again is still slack, rad.
///
/// A free span that goes slack swings, and every swing lets the tension fall to zero again. A quarter of a turn
/// lies between the corners of a core, each of which may jerk the wire again.
const SAME_SLACK: f64 = FRAC_PI_2;

/// Turn of the core in which so much wire is laid slack as a bulge or an overlap needs to count, rad: eight stations.
const SLACK_RUN: f64 = 8.0 * STATION_STEP;

/// Standard acceleration of free fall, m/s^2 (CGPM 1901).
const GRAVITY: f64 = 9.80665;

impl Winding {
    /// Keeps the extremes of the tension, and notes where the wire goes slack.
    pub(super) fn watch_tension(&mut self) {
        let t = self.wire_tension();
        self.run.outputs.meet_tension(t);
        self.run.outputs.meet_depth(self.sys.state.depth);
        self.run.slack_since = match t < self.slack_tension() {
            true => self.run.slack_since.or_else(|| Some(self.goes_slack())),
            false => None,
        };
        let slack = self.run.slack_since.filter(|since| self.lasts(since));
        if let Some(since) = slack {
            self.note_slack(&since);
        } else if self.run.slack_at.is_some_and(|at| !self.is_same_slack(at)) {
            // the core may come back to where it was
            self.run.slack_at = None;
        }
        self.run.was_slack = slack.is_some();
        self.watch_yardstick();
    }

    /// Tension below which wire is slack, N: the weight of half the free span.
    fn slack_tension(&self) -> f64 {
        let weight = GRAVITY * self.scene.wire.mass_per_length();
        weight * 0.5 * self.scene.nozzle.distance
    }

    /// The wire as it loses its tension. What has been laid may spring off before that counts, and is not where it was then.
    fn goes_slack(&self) -> SlackSince {
        let (wound, place) = self.place_of(self.laid_to());
        SlackSince {
            core: self.sys.state.spindle.angle,
            time: self.sys.state.time,
            wound,
            place: place.into(),
        }
    }

    /// Whether wire that lost its tension then is slack by now.
    ///
    /// It is once the tensioner on its line could have followed, after a radian of its swing, or once as much wire is laid so as any
    /// defect takes. A turn that snaps into its groove takes the tension away for less.
    fn lasts(&self, since: &SlackSince) -> bool {
        let radian = |feed: FeedSpec| (feed.mass / feed.line_stiffness).sqrt();
        let state = &self.sys.state;
        (state.spindle.angle - since.core).abs() >= SLACK_RUN
            || state.time - since.time >= self.sys.model.feed.map_or(0.0, radian)
    }

    /// Whether wire that is slack now is so still where it was slack with the core at this angle, rad.
    fn is_same_slack(&self, core: f64) -> bool {
        (self.sys.state.spindle.angle - core).abs() < SAME_SLACK
    }

    /// Keeps slack that began then.
    fn note_slack(&mut self, since: &SlackSince) {
        let (core, now) = (self.sys.state.spindle.angle, self.sys.state.time);
        let last = self.run.slack_at.replace(core);
        let slack = |fault: &&mut Defect| fault.kind == DefectKind::Slack;
        if last.is_some_and(|last| self.is_same_slack(last))
            && let Some(fault) = self.run.faults.iter_mut().rev().find(slack)
        {
            fault.until_s = Some(now);
            return;
        }
        self.keep_fault(
            DefectKind::Slack,
            since.time,
            since.wound,
            since.place.into(),
        );
        self.report(
            EventKind::Slack,
            format!(
                "the wire went slack at the nozzle at t = {:.6} s, in {} (tension below {} N); raise the tension (tensioner.tension, or the input tension_setpoint) or {}",
                since.time,
                OnTurn::at(since.wound),
                four_digits(self.slack_tension()),
                self.gentler()
            ),
        );
    }

    /// What shakes the wire less: the nozzle, where it moves faster than the core would at its distance, or else the spindle.
    fn gentler(&self) -> &'static str {
        let (nozzle, speed) = (self.sys.state.support[1], self.sys.state.spindle.speed);
        match nozzle.velocity.norm() > speed.abs() * self.nozzle_distance() {
            true => "move the nozzle more gently",
            false => "change the spindle's speed more gently",
        }
    }

    /// No wire can be wound after what happened at a live node; from now on it stays as it is.
    pub(super) fn note_end(&mut self, kind: DefectKind, node: usize, text: String) {
        let (angle, place) = self.place_of(node);
        if kind == DefectKind::Break {
            let before: f64 = self.sys.state.rod.rest[..node].iter().sum();
            self.run.outputs.break_position = self.sys.state.arc0 + before;
        }
        self.note_end_at(kind, angle, place, text);
    }

    /// A live edge has parted under tension: in its middle, as far as the mesh tells.
    pub(super) fn note_parted(&mut self, edge: usize) {
        let rod = &self.sys.state.rod;
        let half = 0.5 * rod.rest[edge];
        // (as it is, stretched)
        let lengths = rod.x[edge..]
            .windows(2)
            .map(|ends| (ends[1] - ends[0]).norm());
        let before_nozzle = lengths.sum::<f64>() - 0.5 * (rod.x[edge + 1] - rod.x[edge]).norm();
        let text = format!(
            "the wire broke {:.1} mm before the nozzle: {} N is above its strength of {} N; lower the tension (tensioner.tension, or the inputs tension_setpoint and brake_torque) or {}",
            1e3 * before_nozzle,
            four_digits(self.sys.state.load.tension[edge]),
            four_digits(self.scene.wire.strength),
            self.gentler()
        );
        self.note_end(DefectKind::Break, edge, text);
        self.run.outputs.break_position += half;
    }

    /// The same of what happened at an angle along the wire from the clamp, rad, at a place in the core frame, m.
    pub(super) fn note_end_at(&mut self, kind: DefectKind, angle: f64, place: V3, text: String) {
        self.keep_fault(kind, self.sys.state.time, angle, place);
        let event = match kind {
            DefectKind::Collision => EventKind::Collision,
            DefectKind::Runaway => EventKind::Runaway,
            _ => EventKind::Break,
        };
        self.report(event, text);
        self.run.over = true;
    }

    /// Angle along the wire from the clamp to a live node, rad, and its place in the core frame, m; what is not laid yet counts
    /// to the angle where wire is laid.
    fn place_of(&self, node: usize) -> (f64, V3) {
        let (angle, _) = self.wound_to(node.min(self.laid_to()));
        let spin = Spin::new(self.sys.state.spindle.angle);
        (angle, spin.to_core(self.sys.state.rod.x[node]))
    }

    /// Keeps a fault of the wire that began at this time, s, at this angle along it, rad, and place, m.
    fn keep_fault(&mut self, kind: DefectKind, time: f64, angle: f64, place: V3) {
        let angle = angle.max(0.0);
        let OnTurn { turn, angle_deg } = OnTurn::at(angle);
        self.run.faults.push(Defect {
            kind,
            turn,
            layer: self.coil.layer_at(angle),
            angle_deg,
            found_turn: turn,
            found_angle_deg: angle_deg,
            time_s: time,
            until_s: (kind == DefectKind::Slack).then_some(self.sys.state.time),
            size_m: None,
            size_d: None,
            place_m: place.into(),
        });
        self.count_defects();
    }

    /// Angle along the wire from the clamp to a live node, and its polar angle, rad.
    pub(super) fn wound_to(&self, node: usize) -> (f64, f64) {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let x = &self.sys.state.rod.x;
        // from the last settled node, or from the clamp, where the coil starts
        let start = || (0.0, polar_angle(spin.to_core(x[0])));
        let direction = self.coil.spec().direction;
        x[..=node].iter().fold(
            self.coil.end_angle().unwrap_or_else(start),
            |(angle, last), x| {
                let polar = polar_angle(spin.to_core(*x));
                (angle + direction * wrap_to_pi(polar - last), polar)
            },
        )
    }

    /// Puts the defect that was found last into the outputs, where one was found since they had the `counts` of each kind. It stays there
    /// when its wire comes loose, and one found before is the last in the settled wire.
    ///
    /// What is found later may have come to pass before: the wire beside it has to lie still too.
    pub(super) fn keep_last_defect(&mut self, counts: &[i32; KINDS]) {
        let o = &mut self.run.outputs;
        let told = counts_told(o).map(|count| *count);
        let has_more =
            |kinds: Range<usize>| kinds.into_iter().any(|kind| counts[kind] > told[kind]);
        let laid = self.coil.last_defect();
        let laid = laid.filter(|laid| has_more(0..MEASURED) || laid.time > o.defect_time);
        let fault = self.run.faults.last().filter(|_| has_more(MEASURED..KINDS));
        let fault = fault.map(|fault| DefectPlace {
            kind: fault.kind,
            size: 0.0,
            turn: fault.turn,
            angle: fault.angle_deg.to_radians(),
            time: fault.time_s,
        });
        if let Some(last) = fault.or(laid) {
            o.defect_kind = last.kind.code();
            o.defect_turn = f64::from(last.turn);
            o.defect_angle = last.angle;
            o.defect_time = last.time;
            o.defect_size = last.size;
        }
    }

    /// Every defect so far, in the order of their times: those of settled wire, slack, and a break.
    pub fn defects(&self) -> Vec<Defect> {
        let mut all = self.coil.defects();
        all.extend(
            self.run
                .faults
                .iter()
                .map(|fault| self.with_settled_layer(fault)),
        );
        all.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        all
    }

    /// A fault of wire that has settled since lies in the layer where that came to rest; until then the layer is what the nozzle lays.
    fn with_settled_layer(&self, fault: &Defect) -> Defect {
        let angle = f64::from(fault.turn - 1) * TAU + fault.angle_deg.to_radians();
        Defect {
            layer: self.coil.settled_layer_at(angle).unwrap_or(fault.layer),
            ..fault.clone()
        }
    }

    /// Measures of every turn, with the verdict of what the wire met while it was wound there. Where that befell wire of which
    /// none has come to rest, its turn and those before it have no measures.
    pub fn turns(&self) -> Vec<TurnMeasures> {
        let mut turns = self.coil.turns();
        for fault in &self.run.faults {
            while turns.len() < fault.turn as usize {
                let before = turns.last().filter(|turn| turn.layer == fault.layer);
                turns.push(TurnMeasures {
                    turn: turns.len() as u32 + 1,
                    layer: fault.layer,
                    turn_in_layer: before.map_or(1, |turn| turn.turn_in_layer + 1),
                    ..TurnMeasures::default()
                });
            }
            let turn = &mut turns[fault.turn as usize - 1];
            turn.verdict = turn.verdict.max(fault.kind.into());
        }
        turns
    }

    /// The verdict on the run: that on the coil, or what befell the wire where that is worse.
    pub fn verdict(&self) -> Verdict {
        let faults = self.run.faults.iter().map(|fault| fault.kind.into());
        faults.fold(self.coil.verdict(), Verdict::max)
    }
}

/// A number to four significant digits.
fn four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use crate::settings::SceneSettings;
    use crate::signals::{EventKind, Inputs};
    use crate::simulation::Simulation;

    /// What is told of wire that breaks when the inputs jump to these.
    fn told(jump: impl Fn(Inputs) -> Inputs) -> String {
        let settings = SceneSettings::load("fig8").expect("packed");
        let scene = settings.build().expect("valid");
        let mut sim = Simulation::new(&scene).expect("starts");
        let to = jump(sim.inputs());
        for _ in 0..100 {
            sim.advance(to, 1e-3).expect("goes on");
            let events = sim.drain_events();
            if let Some(event) = events.iter().find(|e| e.kind == EventKind::Break) {
                return event.text.clone();
            }
        }
        panic!("it does not break");
    }

    /// A nozzle that jumped tore the wire, and a gentler spindle was advised.
    #[test]
    fn wire_that_the_nozzle_tears_is_told_so() {
        let by_nozzle = told(|now| Inputs {
            nozzle_offset_x: 1.0,
            ..now
        });
        assert!(
            by_nozzle.contains("move the nozzle more gently"),
            "{by_nozzle}"
        );
        let by_pull = told(|now| Inputs {
            tension_setpoint: 200.0,
            spindle_speed: 10.0,
            ..now
        });
        assert!(
            by_pull.contains("the spindle's speed more gently"),
            "{by_pull}"
        );
    }
}
