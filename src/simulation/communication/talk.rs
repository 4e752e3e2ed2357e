//! What was said at communication points, and what the inputs are taken to go on as.

use super::ahead::between;
use crate::signals::{Event, Inputs, Outputs};
use crate::simulation::Winding;
use crate::simulation::motion::{Course, MasterInputs, check_finite};
use crate::simulation::outputs::{keep_told, raise_as};
use crate::simulation::winding::ROUNDING;
use serde::{Deserialize, Serialize};

/// Communication steps with inputs that go on, after which at the latest a step ahead is tried again.
pub(super) const LONGEST_WAIT: u32 = 64;

/// Small changes in a row from which on a master is taken for a controller, at the least.
const AGAIN: u32 = 3;

/// What has been said at communication points, and what the inputs are taken to go on as.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(in crate::simulation) struct Talk {
    /// inputs of the last communication step as a master gave them; none where it did not
    pub(super) given: Option<MasterInputs>,
    /// what the inputs are taken to go on as
    pub(super) course: Option<Course>,
    /// the same from the next step of the method on, where it differs by too little to drop the one under way
    pub(super) turned: Option<Course>,
    /// how long the last course went on, s
    pub(super) lasted: f64,
    /// changes in a row that were too small to drop a step for
    small: u32,
    /// how many of them it takes beyond [`AGAIN`] until the next is taken to be small
    doubt: u32,
    /// mean velocity of the nozzle over the last communication step, m/s, and its length, s
    pub(super) travel: Option<(f64, f64)>,
    /// whether the winding has taken a step along the course, and none since by another way
    pub(super) underway: bool,
    /// communication steps to go on as before, until a step ahead is tried
    pub(super) wait: u32,
    /// how many there were to wait for after the last step ahead that was dropped
    pub(super) waited: u32,
    /// what the master reads, where the winding is not at the communication point
    pub(super) served: Option<CommunicationPoint>,
    /// what happened since events were last taken
    pub(super) events: Vec<Event>,
}

/// A communication point that has been answered.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct CommunicationPoint {
    /// s
    pub(super) time: f64,
    /// what adding up steps has lost of `time`, s
    pub(super) time_lost: f64,
    pub(super) inputs: Inputs,
    pub(super) outputs: Outputs,
    /// per s
    pub(super) rates: Outputs,
}

impl Talk {
    /// What the inputs were last taken to go on as.
    pub(super) fn newest(&self) -> Option<Course> {
        self.turned.or(self.course)
    }

    /// Whether the next change of the inputs is taken to be small.
    fn trusts(&self) -> bool {
        self.small >= AGAIN + self.doubt
    }

    /// Forgets how often the set tension has changed by little: the next change acts at once.
    pub(in crate::simulation) fn heed_small_changes(&mut self) {
        self.small = 0;
    }

    /// Takes notice of a change of the inputs that was small or not, while a step was `ahead` or none. Whether it may be left to the
    /// next step.
    pub(super) fn may_wait(&mut self, small: bool, ahead: bool) -> bool {
        let in_vain = ahead && self.trusts() && self.turned.is_none();
        if in_vain && !small {
            self.doubt = (2 * self.doubt).clamp(1, LONGEST_WAIT);
        }
        self.small = if small {
            self.small.saturating_add(1)
        } else {
            0
        };
        small && self.trusts()
    }

    /// Takes the course of the next step of the method, where it is another.
    pub(super) fn turn(&mut self) {
        if let Some(turned) = self.turned.take() {
            (self.course, self.underway) = (Some(turned), false);
        }
    }

    /// Takes notice of a step ahead that has been kept to its end.
    pub(super) fn kept(&mut self) {
        self.waited /= 2;
        if self.turned.is_some() {
            self.doubt /= 2;
        }
        self.turn();
    }

    /// Whether it goes with a winding, and with a step ahead of it or none; bytes from elsewhere may say anything.
    pub(in crate::simulation) fn is_sound(&self, winding: &Winding, ahead: bool) -> bool {
        let served = match &self.served {
            Some(served) => {
                let inputs = check_finite(&served.inputs, 0.0).is_ok();
                inputs
                    && served.time.is_finite()
                    && served.time >= winding.run.time * (1.0 - ROUNDING)
            }
            None => !ahead,
        };
        let course = self.course.as_ref().map_or(!ahead, Course::is_sound);
        let turned = self.turned.as_ref().is_none_or(|c| ahead && c.is_sound());
        let given = self.given.as_ref().is_none_or(MasterInputs::is_sound);
        served
            && course
            && turned
            && given
            && self.wait <= LONGEST_WAIT
            && self.waited <= LONGEST_WAIT
            && self.doubt <= LONGEST_WAIT
    }
}

impl CommunicationPoint {
    /// The communication point at which the winding stands.
    pub(super) fn at(winding: &Winding) -> Self {
        Self {
            time: winding.run.time,
            time_lost: winding.run.time_lost,
            inputs: winding.inputs(),
            outputs: winding.run.outputs,
            rates: winding.run.rates,
        }
    }

    /// Begins a communication step of `dt`, s: extremes and flags are those of now.
    pub(super) fn begin(&mut self, dt: f64, now: &Winding) {
        let step = dt - self.time_lost;
        let next = self.time + step;
        self.time_lost = (next - self.time) - step;
        self.time = next;
        let o = &mut self.outputs;
        (o.wire_tension_min, o.wire_tension_max) = (o.wire_tension, o.wire_tension);
        o.penetration_max = now.sys.state.depth;
        now.lower_flags(o);
    }

    /// Takes note of the end of a step within the communication step.
    pub(super) fn pass(&mut self, winding: &Winding) {
        let o = &winding.run.outputs;
        [o.wire_tension, winding.wire_tension()]
            .into_iter()
            .for_each(|tension| self.outputs.meet_tension(tension));
        self.outputs.meet_depth(winding.sys.state.depth);
        raise_as(&mut self.outputs, &winding.run.outputs);
    }

    /// Reads the outputs between the winding and the `end` of the step ahead of it, with the inputs at this point and the mean
    /// acceleration of the spindle, rad/s2, since the one before.
    pub(super) fn read(
        &mut self,
        now: &Winding,
        end: Option<&Winding>,
        course: &Course,
        (inputs, acceleration): (Inputs, f64),
    ) {
        let start = &now.run.outputs;
        let angle = start.spindle_angle + course.turned(now.run.time, self.time);
        let mut outputs = match end {
            Some(end) => {
                let share = (self.time - now.run.time) / (end.run.time - now.run.time);
                let winds = end.coil.spec().direction;
                between([start, &end.until_it_parted()], share, (angle, winds))
            }
            None => *start,
        };
        outputs.spindle_angle = angle;
        outputs.spindle_torque_total = outputs.spindle_torque - outputs.coil_inertia * acceleration;
        self.outputs.meet_tension(outputs.wire_tension);
        outputs.nozzle_y = inputs.nozzle_position;
        keep_told(&mut outputs, &self.outputs);
        (self.outputs, self.inputs) = (outputs, inputs);
    }
}
