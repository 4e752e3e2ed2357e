//! Derivatives of the outputs by the inputs of a communication step, for importers that solve loops or linearise.
//!
//! They are central differences of the step as a whole: the run is copied where the step begins, and the copies take the
//! step with inputs a little off. The tangent of the solver's last step would be cheaper, but a communication step has
//! many of those, and what one does to the next is most of the answer.

use super::{SimError, Simulation};
use crate::math::scaled;
use crate::scene::Scene;
use crate::signals::{Inputs, Outputs};

/// Change of the core's angle over the step that a difference is taken over, rad, ...
const TURN: f64 = 2e-6;
/// ... as a share of the speed where that is less, but no less than a tenth, ...
const SPEED: f64 = 1e-3;
/// ... of the nozzle's position, m, for wire of 0.7 mm, ...
const WAY: f64 = 5e-8;
/// ... and of the pull, as a share of it, by tension, brake or damper.
const PULL: f64 = 2e-4;
/// Least change of the pull, N, for wire of 0.7 mm, ...
const LEAST_PULL: f64 = 1e-4;
/// ... and of the nozzle's position, as a share of the tolerance: less than a thousandth of it counts as no change.
const LEAST_WAY: f64 = 0.02;
/// Least speed of the wire, m/s, at which a change of a damper shows in its pull.
const SLOW: f64 = 0.1;
/// Sizes of a difference over those above. What lands, slips or yields in one run of a difference and not in the other bends
/// its slope; the middle of the slopes is then another one. The sizes lie far apart: of all choices within this span they
/// came nearest to differences of any size in it.
const SIZES: [f64; 3] = [0.3, 1.0, 10.0];

/// How the outputs change with the inputs of a communication step: those of [`Outputs::SMOOTH`], and those of [`Outputs::SETTLED`],
/// which keep out that wire comes to rest in one step and not in one close by. Counts and what is kept of a defect have 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivative {
    /// the derivatives: for each output the middle of its slopes over changes of three sizes
    pub slopes: Outputs,
    /// the smallest of these slopes, ...
    pub least: Outputs,
    /// ... and the largest. Where they differ, wire lands, slips or yields otherwise for inputs close by.
    pub most: Outputs,
    /// the middle change of the inputs, as a multiple of the direction
    pub change: f64,
}

impl Derivative {
    fn of(slopes: &[Slope], change: f64) -> Self {
        let smooth = ascending(slopes.iter().map(|slope| &slope.smooth));
        let settled = ascending(slopes.iter().map(|slope| &slope.settled));
        let outputs = |value: &dyn Fn(&[f64]) -> f64| {
            Outputs::default()
                .with_smooth(std::array::from_fn(|k| value(&smooth[k])))
                .with_settled(std::array::from_fn(|k| value(&settled[k])))
        };
        Self {
            slopes: outputs(&middle),
            least: outputs(&|values| values[0]),
            most: outputs(&|values| values[values.len() - 1]),
            change,
        }
    }

    /// The same for a step in which the tension goes from `begin`, N, to that of `step`: an extreme at one end of the step follows the
    /// tension there. Changes that a difference is taken over may be larger than the swing of the tension within a step, and
    /// swap its ends.
    fn with_extremes_of(mut self, step: &Outputs, begin: f64) -> Self {
        let end = step.wire_tension;
        if begin != end {
            for slopes in [&mut self.slopes, &mut self.least, &mut self.most] {
                let at_end = slopes.wire_tension;
                for (extreme, slope) in [
                    (step.wire_tension_min, &mut slopes.wire_tension_min),
                    (step.wire_tension_max, &mut slopes.wire_tension_max),
                ] {
                    if extreme == end {
                        *slope = at_end;
                    } else if extreme == begin {
                        *slope = 0.0;
                    }
                }
            }
        }
        self
    }
}

impl Simulation {
    /// Derivatives of the outputs at the end of a communication step of `dt`, s, that begins here with `inputs` and
    /// their `rates` per s, when the inputs change in the direction `along` for all of the step.
    ///
    /// The run stays as it is. It costs seven such steps.
    ///
    /// # Errors
    ///
    /// Where no step near this one can be taken.
    pub fn step_derivative(
        &self,
        inputs: Inputs,
        rates: Inputs,
        dt: f64,
        along: Inputs,
    ) -> Result<Derivative, SimError> {
        let most = self.scene().tensioner.most_torque();
        let outcome = |by: f64| {
            let changed = inputs.after(&along, by);
            // (a brake at its largest torque is judged from below: above it, nothing changes)
            if changed.brake_torque > most.max(inputs.brake_torque) && inputs.brake_torque <= most {
                return Err(SimError::setup(
                    "the brake holds by its largest torque".to_owned(),
                ));
            }
            let mut run = self.clone();
            // left to the next step of the method, a change would do nothing in this one
            run.talk.heed_small_changes();
            run.advance_ramped(changed, rates, dt)?;
            Ok(Outcome::of(&run))
        };
        let begin = self.outputs().wire_tension;
        let reach = reach(self, &inputs, &along, dt);
        let mut slopes = Vec::with_capacity(SIZES.len());
        let mut refused = None;
        for size in SIZES {
            match slope(&outcome, reach * size) {
                Ok(slope) => slopes.push(slope),
                Err(error) => refused = Some(error),
            }
        }
        match refused {
            Some(error) if slopes.is_empty() => Err(error),
            _ => {
                let derivative = Derivative::of(&slopes, reach);
                Ok(match outcome(0.0) {
                    Ok(step) => derivative.with_extremes_of(&step.outputs, begin),
                    Err(_) => derivative,
                })
            }
        }
    }

    /// Derivatives of the outputs at the start of a run of `scene`, when the inputs of the start change in the direction
    /// `along` from `inputs`.
    ///
    /// # Errors
    ///
    /// Where the scene has no valid start near these inputs.
    pub fn start_derivative(
        scene: &Scene,
        inputs: Inputs,
        along: Inputs,
    ) -> Result<Derivative, SimError> {
        let outcome = |by: f64| {
            let mut there = inputs.after(&along, by);
            // which way round the wire lies is no smooth function of the speed
            if (there.spindle_speed < 0.0) != (inputs.spindle_speed < 0.0) {
                there.spindle_speed = inputs.spindle_speed;
            }
            Ok(Outcome::of(&Self::starting_with(scene, there)?))
        };
        let start = Self::starting_with(scene, inputs)?;
        let reach = reach(&start, &inputs, &along, 1.0);
        let slope = slope(&outcome, reach)?;
        Ok(Derivative::of(&[slope], reach))
    }
}

/// What a step led to.
struct Outcome {
    outputs: Outputs,
    /// how many places of the wire are at rest
    settled: usize,
}

impl Outcome {
    fn of(run: &Simulation) -> Self {
        Self {
            outputs: *run.outputs(),
            settled: run.winding().coil.stations().len(),
        }
    }
}

/// How the outputs that have derivatives change.
struct Slope {
    smooth: [f64; Outputs::SMOOTH.len()],
    settled: [f64; Outputs::SETTLED.len()],
}

impl Slope {
    /// From one outcome to another that is this far off.
    fn between(from: &Outcome, to: &Outcome, way: f64) -> Self {
        let [a, b] = [&from.outputs, &to.outputs];
        // wire that came to rest in one of them only is a jump
        let jump = from.settled != to.settled;
        let settled = match jump {
            true => [0.0; Outputs::SETTLED.len()],
            false => over(a.settled(), b.settled(), way),
        };
        Self {
            smooth: over(a.smooth(), b.smooth(), way),
            settled,
        }
    }
}

fn over<const N: usize>(from: [f64; N], to: [f64; N], way: f64) -> [f64; N] {
    std::array::from_fn(|k| (to[k] - from[k]) / way)
}

/// The values of each output, ascending.
fn ascending<'a, const N: usize>(
    slopes: impl Iterator<Item = &'a [f64; N]> + Clone,
) -> [Vec<f64>; N] {
    std::array::from_fn(|k| {
        let mut values: Vec<f64> = slopes.clone().map(|slope| slope[k]).collect();
        values.sort_by(f64::total_cmp);
        values
    })
}

/// How far to go in the direction `along`, so that no input of a step of `dt`, s, changes by more than its share.
fn reach(run: &Simulation, inputs: &Inputs, along: &Inputs, dt: f64) -> f64 {
    let scene = run.scene();
    let (diameter, bare) = (scene.wire.diameter, scene.wire.bare_diameter);
    let way = scaled(WAY, diameter).max(LEAST_WAY * scene.solver.tolerance);
    let least = scaled(scaled(LEAST_PULL, bare), bare);
    let turn = TURN / dt;
    let share = (SPEED * inputs.spindle_speed.abs()).max(0.1 * turn);
    let radius = scene.tensioner.radius;
    let pull = (PULL * (inputs.tension_setpoint + inputs.brake_torque / radius)).max(least);
    let passing = run.outputs().tensioner_speed.abs().max(SLOW);
    let most = [
        (along.spindle_speed, turn.min(share)),
        (along.nozzle_position, way),
        (along.nozzle_offset_x, way),
        (along.nozzle_offset_z, way),
        (along.tension_setpoint, pull),
        (along.brake_torque, pull * radius),
        (along.tensioner_damping, pull / passing),
    ];
    most.iter()
        .filter(|(along, _)| *along != 0.0)
        .map(|(along, most)| most / along.abs())
        .fold(f64::INFINITY, f64::min)
}

/// Slope from `by` on both sides; on one side where there is nothing on the other, as below a tension of 0. The step with the
/// inputs as they are is none of the two: with inputs that go on the method may step beyond it, and the difference of both
/// ways of stepping is no slope.
fn slope(outcome: &impl Fn(f64) -> Result<Outcome, SimError>, by: f64) -> Result<Slope, SimError> {
    match (outcome(by), outcome(-by)) {
        (Ok(ahead), Ok(behind)) => Ok(Slope::between(&behind, &ahead, 2.0 * by)),
        (Ok(ahead), Err(_)) => Ok(Slope::between(&ahead, &outcome(2.0 * by)?, by)),
        (Err(_), Ok(behind)) => Ok(Slope::between(&outcome(-2.0 * by)?, &behind, by)),
        (Err(error), Err(_)) => Err(error),
    }
}

/// The middle of ascending values; of an even number, the mean of the middle two.
fn middle(values: &[f64]) -> f64 {
    let half = values.len() / 2;
    match values.len() % 2 {
        1 => values[half],
        _ => 0.5 * (values[half - 1] + values[half]),
    }
}
