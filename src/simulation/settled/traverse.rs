//! Which way the nozzle went while wire was laid: where passes begin, and which way the core winds.

use crate::math::wrap_to_pi;
use crate::signals::EventKind;
use crate::simulation::Winding;
use crate::simulation::start::WOUND_AFTER;
use crate::simulation::winding::{Found, Traverse};
use std::f64::consts::TAU;

/// Way back along y from which on the nozzle has turned, wire diameters; less is jitter. Chosen: half of the
/// smallest pitch.
const TURNED: f64 = 0.5;

/// Turn of the core the other way round beyond its start from which on it winds that way, rad. Chosen: a
/// twentieth of a turn, less than a corner of any core takes.
pub const OTHER_WAY: f64 = 0.05 * TAU;

impl Winding {
    /// Follows core and nozzle after a step: which way wire is wound, and where the nozzle turned.
    ///
    /// A pass is begun at the wire that was laid when the nozzle turned, not at the wire that has come to rest by then.
    pub(in crate::simulation) fn follow_traverse(&mut self) {
        let turn = self.sys.state.spindle.angle - self.run.angle0;
        let direction = self.coil.spec().direction;
        if turn * direction < -OTHER_WAY {
            self.coil_mut().set_direction(-direction);
            while self.coil.passes() > 1 {
                self.coil_mut().take_back_pass();
            }
            self.run.traverse = Traverse::new(self.sys.state.support[1].point.y);
            self.tell_of_changes("the core winds the other way round");
            self.tell_of_other_way(-direction);
        }
        let core = turn * self.coil.spec().direction;
        let y = self.sys.state.support[1].point.y;
        let turned = TURNED * self.scene.wire.diameter;
        let found = self.run.traverse.look(y, core, turned);
        if found != Found::Nothing || self.run.traverse.just_left().next().is_some() {
            let ahead = self.wound_to(self.lift_off()).0 - core;
            for end in self.run.traverse.just_left() {
                end.ahead = Some(ahead);
            }
            match found {
                Found::Nothing => {}
                Found::First(sense) => self.coil_mut().set_first_sense(sense),
                Found::Turned(turn, sense) => {
                    let (from, place) = (turn.laid(ahead), turn.place());
                    self.coil_mut().begin_pass_at(from, sense, place);
                }
                Found::TakenBack => self.coil_mut().take_back_pass(),
            }
            if found != Found::Nothing {
                self.tell_of_changes("the nozzle has turned since");
            }
        }
    }

    /// Tells once that the planned layers are wound and the spindle goes on, after it had turned `before`, rad, at the farthest.
    pub(in crate::simulation) fn tell_of_full_layers(&mut self, before: f64) {
        let law = &self.scene.nozzle_law;
        let Some(held) = law.held().filter(|_| self.run.nozzle_by_law) else {
            return;
        };
        let end = (held + WOUND_AFTER) * TAU;
        if before < end && end <= self.run.farthest {
            let text = format!(
                "the layers hold {held} turns, and the spindle has turned {WOUND_AFTER} more: what is wound now has no place but on the last one; stop the spindle, or plan more turns or layers"
            );
            self.report(EventKind::Judgement, text);
        }
    }

    /// Tells that the core winds in this direction now, 1 or -1. It stood for one of the two at the start.
    fn tell_of_other_way(&mut self, now: f64) {
        let axis = |direction: f64| if direction < 0.0 { "-y" } else { "+y" };
        let nozzle = self.sys.state.support[1].point;
        let facing = libm::atan2(-nozzle.z, nozzle.x);
        let ahead = wrap_to_pi(self.run.angle0 - facing);
        if ahead * now > 0.0 {
            let message = format!("the core winds about {} again, as at the start", axis(now));
            return self.report(EventKind::Judgement, message);
        }
        let idle = 2.0 * ahead.abs().to_degrees();
        let law = match self.run.nozzle_by_law {
            true => ", for which the traverse law does not wait",
            false => "",
        };
        let (now, stood_for) = (axis(now), axis(-now));
        self.report(
            EventKind::Judgement,
            format!(
                "the core winds about {now}, and stood for winding about {stood_for} at the start: it lays wire only after {idle:.0} degrees{law}; set spindle.direction = {now} to begin this way round"
            ),
        );
    }
}
