//! The one door to a run: scene in, inputs in, outputs and events out.
//!
//! A step reads as a list of stages: move, feed, forces ([`crate::integrate`]), then keeping
//! house (insert wire at the nozzle, refine near the core, let settled wire go), then measure.

mod coarsen;
mod freezing;
mod io;
mod motion_profile;
mod quasi_static;
mod rates;
mod remeshing;
mod saved;
mod sensitivity;
mod start;
mod summary;

pub use freezing::{FreezePolicy, Watch};
pub use io::{Centreline, SimError};
pub use motion_profile::MotionProfile;
use motion_profile::ROUNDING;
pub use saved::RestoreError;
pub use start::core_surface;
pub use summary::{EnergySummary, PenetrationSummary, Summary};

use crate::contact::damping_for_restitution;
use crate::integrate;
use crate::integrate::{
    Implicit, RK4_LIMIT, Scheme, VERLET_LIMIT, highest_frequency, longest_step,
};
use crate::math::{Spin, V3, turn_about_y};
use crate::math::{polar_angle, wrap_to_pi};
use crate::measure::{Coil, SettledNode};
use crate::scene::{Integrator, Scene};
use crate::signals::{Event, EventKind, Inputs, Outputs};
use crate::system::System;
use rates::Instant;

/// Wire slower than this, m/s, on a standing core counts as quiet: in a second it would move by less than
/// the error that one step may have.
const QUIET: f64 = 1e-6;

/// Tension below which wire is slack, N: chosen as the weight of 3 cm of 0.7 mm wire, half a free span.
const SLACK: f64 = 1e-3;

/// Communication steps are solved for once they add up to this, s, the solver's own shortest step: in less,
/// wire at 5000 rpm moves by 20 nm at most and what is solved for drowns in rounding.
const WORTH_A_STEP: f64 = 1e-9;

/// Steps between looks for edges to refine and values that are not finite.
const REMESH_STEPS: u64 = 32;

/// A winding run.
#[derive(Clone, Debug)]
pub struct Simulation {
    scene: Scene,
    sys: System,
    coil: Coil,
    watch: Watch,
    policy: FreezePolicy,
    /// polar angle from each laid node to lift-off, at the last look, rad
    behind: Vec<f64>,
    motion_profile: MotionProfile,
    /// core angle at the start, rad
    angle0: f64,
    /// the implicit method, if that is the one
    implicit: Option<Implicit>,
    longest_step: f64,
    last_step: f64,
    /// length of the last communication step, s; 0: none yet
    last_span: f64,
    time: f64,
    steps: u64,
    outputs: Outputs,
    /// per s, see [`Simulation::output_rates`]
    rates: Outputs,
    /// before the last step of the method
    instant: Instant,
    /// what adding up steps has lost of `time`, s
    time_lost: f64,
    /// time passed that the wire has not, see [`WORTH_A_STEP`], s
    owed: f64,
    events: Vec<Event>,
    /// deepest penetration of wire when it came to rest, m
    rest_depth: f64,
    broken: bool,
    was_slack: bool,
    /// how long core, nozzle, tensioner and wire have been still, s
    quiet: f64,
    /// farthest that the spindle has been from where it started, rad
    farthest: f64,
    /// farthest nozzle position of this pass, m, and its direction along y
    pass: (f64, f64),
    /// steps tried so far, each counted as often as it had nodes, and how much of that may be
    work: u64,
    most_work: u64,
}

impl Simulation {
    /// Wire clamped to the core and straight to the nozzle at the set tension, everything at rest.
    pub fn new(scene: &Scene) -> Result<Self, SimError> {
        let inputs = Inputs {
            spindle_speed: 0.0,
            nozzle_position: scene.nozzle.y_start + scene.traverse.lead,
            tension_setpoint: scene.tensioner.tension,
        };
        Self::starting_with(scene, inputs)
    }

    /// The same with these inputs at the start.
    pub fn starting_with(scene: &Scene, inputs: Inputs) -> Result<Self, SimError> {
        check_finite(&inputs, 0.0)?;
        let (mut sys, coil, angle0) = start::wire(scene, &inputs)?;
        let implicit =
            (scene.solver.integrator == Integrator::Implicit).then(|| implicit_for(scene));
        let limit = match scene.solver.integrator {
            Integrator::Rk4 => RK4_LIMIT,
            Integrator::Verlet | Integrator::Implicit => VERLET_LIMIT,
        };
        let spacing = scene.solver.spacing_near.min(scene.solver.spacing_free);
        let contact = scene.contact.stiffness;
        let frequency = highest_frequency(
            &scene.wire,
            spacing,
            contact,
            scene.solver.twist.is_carried(),
        );
        let damping = damping_for_restitution(scene.contact.restitution);
        let stable = longest_step(limit, frequency, damping, contact, &scene.wire);
        let longest_step = if scene.solver.step > 0.0 {
            scene.solver.step
        } else {
            stable * scene.solver.step_share
        };
        if longest_step > stable && implicit.is_none() {
            return Err(SimError::setup(format!(
                "solver.step = {:.4e} s is too long for the explicit method: the limit of this wire at {} mm spacing is {:.4e} s",
                scene.solver.step,
                spacing * 1e3,
                stable
            )));
        }
        sys.refresh();
        sys.balance.initial = sys.stored() + sys.kinetic();
        let policy = FreezePolicy {
            window: scene.freeze.window,
            time: scene.freeze.time,
            displacement: scene.freeze.creep * scene.freeze.window,
            keep_length: if scene.freeze.keep_length > 0.0 {
                scene.freeze.keep_length
            } else {
                1.75 * (scene.wire.ei / inputs.tension_setpoint.max(0.01 * scene.tensioner.tension))
                    .sqrt()
            },
            patience: scene.freeze.patience * std::f64::consts::TAU,
            margin: scene.freeze.margin,
        };
        let mut sim = Self {
            motion_profile: MotionProfile::new(scene),
            watch: Watch::new(sys.rod.nodes(), sys.spindle.angle),
            scene: scene.clone(),
            sys,
            coil,
            policy,
            behind: Vec::new(),
            angle0,
            longest_step,
            implicit,
            last_step: longest_step,
            last_span: 0.0,
            time: 0.0,
            steps: 0,
            outputs: Outputs::default(),
            rates: Outputs::default(),
            instant: Instant::default(),
            time_lost: 0.0,
            owed: 0.0,
            events: Vec::new(),
            rest_depth: 0.0,
            broken: false,
            was_slack: false,
            quiet: 0.0,
            farthest: 0.0,
            pass: (inputs.nozzle_position, scene.traverse.per_turn.signum()),
            work: 0,
            most_work: u64::MAX,
        };
        sim.sys.spindle.speed = inputs.spindle_speed;
        sim.sys.place_supports();
        sim.reset_extremes();
        sim.update_outputs();
        Ok(sim)
    }

    /// Input values at this moment.
    pub fn inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: self.sys.spindle.speed,
            nozzle_position: self.sys.support[1].point.y,
            tension_setpoint: self.sys.set_tension,
        }
    }

    /// Lets the run end with an error once so many steps have been tried since the start, taken or not, each counted
    /// as often as it had nodes: a bound on the work that does not depend on the clock.
    pub fn limit_work(&mut self, most: u64) {
        self.most_work = most;
    }

    /// What [`Self::limit_work`] counts.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Starts over with other inputs; only before the first step.
    pub fn set_start(&mut self, inputs: Inputs) -> Result<(), SimError> {
        *self = Self::starting_with(&self.scene, inputs)?;
        Ok(())
    }

    /// Advances by `dt` with the inputs held: spindle speed and tension from now on, the nozzle
    /// moving evenly so that it reaches its position at the end (a jump would be a hammer blow).
    ///
    /// After an error the run stands where the last step ended that went through ([`Self::time`]).
    pub fn advance(&mut self, inputs: Inputs, dt: f64) -> Result<(), SimError> {
        self.advance_ramped(inputs, Inputs::HELD, dt)
    }

    /// Advances by `dt` with inputs that start at `inputs` and change evenly, at `rates` per s. The nozzle moves
    /// evenly from where it is to where its input is at the end. Steps below a nanosecond only add up until they are
    /// worth solving for.
    pub fn advance_ramped(
        &mut self,
        inputs: Inputs,
        rates: Inputs,
        dt: f64,
    ) -> Result<(), SimError> {
        let end = inputs.after(&rates, dt);
        check_finite(&inputs, self.time)?;
        check_finite(&end, self.time)?;
        let span = self.owed + dt;
        if span < WORTH_A_STEP {
            self.owed = span;
            self.pass_time(dt);
            return Ok(());
        }
        let start = if self.owed > 0.0 {
            end.after(&rates, -span)
        } else {
            inputs
        };
        self.owed = 0.0;
        self.last_span = span;
        let before = self.outputs;
        let target = end.nozzle_position;
        let travel = target - self.sys.support[1].point.y;
        self.sys.spindle.speed = start.spindle_speed;
        self.sys.spindle.acceleration = rates.spindle_speed;
        if rates != Inputs::HELD
            || inputs.spindle_speed != 0.0
            || travel != 0.0
            || inputs.tension_setpoint != self.sys.set_tension
        {
            self.quiet = 0.0;
        }
        self.sys.set_tension = start.tension_setpoint;
        self.sys.set_rate = rates.tension_setpoint;
        self.reset_extremes();
        self.sys.place_supports();
        self.sys.support[1].velocity = V3::new(0.0, travel / span, 0.0);
        let statistics_before = self.statistics();
        let gone = self.through(span, 0.0);
        self.tell_of_trouble(statistics_before);
        self.sys.support[1].velocity = V3::zeros();
        (self.sys.spindle.acceleration, self.sys.set_rate) = (0.0, 0.0);
        if gone.is_err() {
            self.stop_short();
            return gone;
        }
        self.sys.spindle.speed = end.spindle_speed;
        self.sys.set_tension = end.tension_setpoint;
        self.sys.support[1].point.y = target;
        self.pass_time(dt);
        self.finish();
        self.update_rates(&before, span);
        Ok(())
    }

    /// Adds up communication steps such that millions of them lose no more than the last digit (Kahan 1965).
    fn pass_time(&mut self, dt: f64) {
        let step = dt - self.time_lost;
        let next = self.time + step;
        self.time_lost = (next - self.time) - step;
        self.time = next;
    }

    /// The method gave up within a step: what can be read is what was reached, or what was there before if
    /// that is no state of a wire.
    fn stop_short(&mut self) {
        let rod = &self.sys.rod;
        if rod.x.iter().chain(&rod.v).flatten().all(|x| x.is_finite()) {
            (self.time, self.time_lost) = (self.sys.time, 0.0);
            self.finish();
        }
        self.rates = Outputs::default();
    }

    /// Says that the solver could not solve steps as long as it wanted to; being too long for the error is
    /// its daily bread.
    fn tell_of_trouble(&mut self, before: integrate::SolverStatistics) {
        let newton_failures = self.statistics().newton_failures - before.newton_failures;
        if newton_failures > 0 {
            let text = format!(
                "the solver found no solution {newton_failures} times and went on in shorter steps, the last of {:.2e} s",
                self.last_step
            );
            self.report(EventKind::Solver, text);
        }
    }

    /// Advances by `dt` along the scene's own spindle ramp and traverse, which are continuous.
    pub fn advance_profile(&mut self, dt: f64) -> Result<(), SimError> {
        self.reset_extremes();
        self.quiet = 0.0;
        let end = self.time + dt;
        for piece in self.motion_profile.pieces(self.time, end) {
            self.sys.spindle.speed = piece.speed;
            self.sys.spindle.acceleration = piece.acceleration;
            self.through(piece.duration, self.motion_profile.travel_per_angle)?;
        }
        self.time += dt;
        self.finish();
        Ok(())
    }

    /// Goes through `dt` in steps that the method finds fit. The nozzle follows the spindle where
    /// `per_angle` is not 0, m/rad; else it keeps its velocity.
    fn through(&mut self, dt: f64, per_angle: f64) -> Result<(), SimError> {
        if self.broken {
            self.turn_on(dt, per_angle);
            return Ok(());
        }
        if self.is_quiescent() {
            self.sys.time += dt;
            return Ok(());
        }
        if self.implicit.is_none() {
            let (count, step) = self.divide(dt);
            for _ in 0..count {
                self.guide_nozzle(step, per_angle);
                self.instant = Instant::of(self);
                self.sys.set_tension = self.sys.set_tension_after(step);
                self.step(step)?;
            }
            return Ok(());
        }
        let start = (self.sys.support[1].point.y, self.sys.spindle.angle);
        let mut left = dt;
        // (differences of times leave a rest that is none, in which nothing can be solved for)
        while left > ROUNDING * self.sys.time.max(dt) || (left == dt && dt >= WORTH_A_STEP) {
            let next = self.implicit.as_ref().map_or(left, |m| m.next);
            self.steer_nozzle(left.min(next), per_angle, start);
            self.instant = Instant::of(self);
            let taken = self.implicit_step(left.min(self.longest_return()))?;
            left = if taken >= left { 0.0 } else { left - taken };
            if self.broken {
                self.turn_on(left, per_angle);
                break;
            }
        }
        if per_angle != 0.0 {
            self.sys.support[1].point.y = start.0 + per_angle * (self.sys.spindle.angle - start.1);
        }
        Ok(())
    }

    /// Sends the nozzle to where it has to be once the spindle has turned on for `step`, by the law that
    /// `start` (nozzle and angle) lies on. The method may take another step than the one foreseen; what
    /// that leaves, of second order in the ramp, is made up for in the next.
    fn steer_nozzle(&mut self, step: f64, per_angle: f64, start: (f64, f64)) {
        if per_angle != 0.0 {
            let next = start.0 + per_angle * (self.sys.spindle.after(step).angle - start.1);
            let nozzle = &mut self.sys.support[1];
            nozzle.velocity = V3::new(0.0, (next - nozzle.point.y) / step, 0.0);
        }
    }

    /// Nothing has moved for long enough that all wire which may freeze has frozen (two windows: a
    /// vibration's turning point is over in a fraction of one), and no input has changed since: the
    /// state stays as it is until one does.
    fn is_quiescent(&self) -> bool {
        self.implicit.is_some() && self.quiet >= 2.0 * self.policy.time
    }

    /// Longest step in which wire that goes back takes no more than a quarter of the nozzle's edge, s.
    fn longest_return(&self) -> f64 {
        match (&self.sys.feed, self.sys.rod.rest.last()) {
            (Some((_, f)), Some(rest)) if f.rate < 0.0 => 0.25 * rest / -f.rate,
            _ => f64::INFINITY,
        }
    }

    /// The wire has parted: spindle and nozzle go on, all else stays as it was.
    fn turn_on(&mut self, dt: f64, per_angle: f64) {
        if dt > 0.0 {
            self.guide_nozzle(dt, per_angle);
        }
        self.sys.time += dt;
        self.sys.spindle = self.sys.spindle.after(dt);
        let support = &mut self.sys.support[1];
        support.point += support.velocity * dt;
    }

    fn guide_nozzle(&mut self, step: f64, per_angle: f64) {
        if per_angle != 0.0 {
            let s = self.sys.spindle;
            let rate = (s.after(step).angle - s.angle) / step;
            self.sys.support[1].velocity = V3::new(0.0, per_angle * rate, 0.0);
        }
    }

    fn implicit_step(&mut self, most: f64) -> Result<f64, SimError> {
        let Some(method) = &mut self.implicit else {
            return Ok(most);
        };
        let fixed = method.fixed;
        let tried =
            |m: &Implicit| m.statistics.steps + m.statistics.rejects + m.statistics.newton_failures;
        let before = tried(method);
        let taken = method.step(&mut self.sys, most).map_err(|e| SimError {
            time: self.sys.time,
            node: Some(e.node),
            reason: match fixed {
                Some(step) => format!(
                    "{e}; solver.step = {step:.4e} s allows no shorter one, 0 leaves it to the error"
                ),
                None => e.to_string(),
            },
        })?;
        self.work += (tried(method) - before) * self.sys.rod.nodes() as u64;
        self.last_step = taken;
        self.steps += 1;
        self.watch_tension();
        self.remesh(taken)?;
        if self.work > self.most_work {
            return Err(SimError {
                time: self.sys.time,
                node: None,
                reason: format!(
                    "the work allowed ({} node steps) is used up",
                    self.most_work
                ),
            });
        }
        let still =
            self.sys.spindle.speed == 0.0 && self.sys.rod.v.iter().all(|v| v.amax() < QUIET);
        self.quiet = if still { self.quiet + taken } else { 0.0 };
        Ok(taken)
    }

    /// Splits `dt` into the fewest equal steps within the stability limit.
    fn divide(&mut self, dt: f64) -> (u64, f64) {
        let count = (dt / self.longest_step).ceil().max(1.0);
        self.last_step = dt / count;
        (count as u64, self.last_step)
    }

    fn step(&mut self, dt: f64) -> Result<(), SimError> {
        if self.broken {
            self.turn_on(dt, 0.0);
            return Ok(());
        }
        match self.scene.solver.integrator {
            Integrator::Rk4 => integrate::rk4::step(&mut self.sys, dt),
            Integrator::Verlet => integrate::verlet::step(&mut self.sys, dt),
            // a broken wire was handled above; nothing else comes here
            Integrator::Implicit => {}
        }
        self.steps += 1;
        self.watch_tension();
        self.remesh(dt)
    }

    fn watch_tension(&mut self) {
        let t = self.wire_tension();
        self.outputs.wire_tension_min = self.outputs.wire_tension_min.min(t);
        self.outputs.wire_tension_max = self.outputs.wire_tension_max.max(t);
        let slack = t < SLACK;
        if slack && !self.was_slack {
            self.report(EventKind::Slack, "the wire went slack at the nozzle".into());
        }
        self.was_slack = slack;
    }

    fn wire_tension(&self) -> f64 {
        // below zero the wire hangs loose in the nozzle, which holds nothing
        self.sys
            .load
            .tension
            .last()
            .copied()
            .unwrap_or(0.0)
            .max(0.0)
    }

    fn reset_extremes(&mut self) {
        let t = self.wire_tension();
        self.outputs.wire_tension_min = t;
        self.outputs.wire_tension_max = t;
    }

    /// A new pass begins once the nozzle has come back by half a diameter; less is jitter.
    fn follow_traverse(&mut self) {
        let y = self.sys.support[1].point.y;
        let (extreme, sign) = self.pass;
        let advance = (y - extreme) * sign;
        if advance > 0.0 {
            self.pass.0 = y;
        } else if advance < -0.5 * self.scene.wire.diameter {
            self.pass = (y, -sign);
            self.coil.set_traverse(-sign);
        }
    }

    fn finish(&mut self) {
        self.follow_traverse();
        self.sys.time = self.time;
        self.update_outputs();
    }

    /// Elapsed time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The scene this run was made from.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Outputs at the last communication point.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Settled wire and its measures.
    pub fn coil(&self) -> &Coil {
        &self.coil
    }

    /// The settled wire and, taken as if it were settled, the live wire up to lift-off.
    pub fn coil_with_live_wire(&self) -> Coil {
        let spin = Spin::new(self.sys.spindle.angle);
        let lift = self.lift_off();
        let mut arc = self.sys.arc0;
        let mut extra = Vec::new();
        for i in 0..=lift {
            let p = spin.to_core(self.sys.centre(i));
            extra.push(self.settled(
                p,
                arc,
                self.sys.rod.stretch[i.min(self.sys.rod.edges() - 1)].strain,
            ));
            arc += self.sys.rod.rest.get(i).copied().unwrap_or(0.0);
        }
        self.coil.what_if(&extra)
    }

    fn settled(&self, position: V3, arc: f64, plastic_strain: f64) -> SettledNode {
        let height = match self.sys.distance_to_core(position) {
            d if d.is_finite() => d - self.scene.wire.radius(),
            _ => 0.0,
        };
        SettledNode {
            position,
            arc,
            height,
            plastic_strain,
            time: self.time,
        }
    }

    /// The programme of the scene.
    pub fn motion_profile(&self) -> &MotionProfile {
        &self.motion_profile
    }

    /// What happened since the last call.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    fn report(&mut self, kind: EventKind, text: String) {
        let turn = self.outputs.turns_wound;
        self.events.push(Event {
            time: self.sys.time,
            turn,
            angle: self.sys.spindle.angle - self.angle0,
            kind,
            text,
        });
    }

    /// Takes over the tunable parameters of another version of the scene.
    pub fn retune(&mut self, scene: &Scene) {
        if self.scene.friction != scene.friction {
            // What holds at rest with one friction may slide with another.
            self.quiet = 0.0;
        }
        self.scene.defects = scene.defects;
        self.scene.friction = scene.friction;
        self.coil.set_limits(scene.defects);
        let laws = [
            self.sys.contacts.as_mut().map(|c| &mut c.law),
            self.sys.line.as_mut().map(|l| &mut l.law),
        ];
        for law in laws.into_iter().flatten() {
            law.mu_static = scene.friction.static_;
            law.mu_kinetic = scene.friction.kinetic;
            law.slip_speed = scene.friction.slip_speed;
        }
    }

    /// Last node from the clamp that touches something: where the wire leaves the coil.
    fn lift_off(&self) -> usize {
        (1..self.sys.rod.nodes() - 1)
            .rev()
            .find(|i| self.sys.touches(*i))
            .unwrap_or(0)
    }

    /// Outputs of parted wire: it neither pulls nor moves on; measures stay those of the moment it broke.
    fn update_broken(&mut self) {
        let o = &mut self.outputs;
        o.spindle_angle = self.sys.spindle.angle - self.angle0;
        (o.wire_tension, o.spindle_torque, o.feed_speed) = (0.0, 0.0, 0.0);
    }

    fn update_outputs(&mut self) {
        if self.broken && self.outputs.defect_break {
            return self.update_broken();
        }
        let spin = Spin::new(self.sys.spindle.angle);
        let lift = self.lift_off();
        let rod = &self.sys.rod;
        // polar angle along the wire from the last settled node, or from the clamp, where the coil starts
        let mut last = self
            .coil
            .end_angle()
            .unwrap_or_else(|| (0.0, polar_angle(spin.to_core(rod.x[0]))));
        let direction = self.coil.spec().direction;
        for i in 0..=lift {
            let polar = polar_angle(spin.to_core(rod.x[i]));
            last = (last.0 + direction * wrap_to_pi(polar - last.1), polar);
        }
        let free: f64 = (lift..rod.edges())
            .map(|j| (rod.x[j + 1] - rod.x[j]).norm())
            .sum();
        let residual = self
            .sys
            .energy_residual(self.staggered().then_some(self.last_step));
        let feed = self.sys.feed.map(|(_, f)| f).unwrap_or_default();
        let flags = self.coil.flags();
        let worst = self.coil.worst();
        let tension = self.wire_tension();
        let rod = &self.sys.rod;
        let o = &mut self.outputs;
        o.wire_tension = tension;
        o.defect_bulge = flags.bulge;
        o.defect_gap = flags.gap;
        o.defect_overlap = flags.overlap;
        o.defect_break = self.broken;
        o.defect_slack = self.was_slack;
        o.defect_code = i32::from(flags.bulge)
            + 2 * i32::from(flags.gap)
            + 4 * i32::from(flags.overlap)
            + 8 * i32::from(self.broken)
            + 16 * i32::from(self.was_slack);
        o.defect_count = self.coil.defect_count() as i32;
        if let Some(d) = self.coil.last_defect() {
            o.defect_turn = f64::from(d.turn);
            o.defect_angle = d.angle;
        }
        o.bulge_height = worst.bulge_height;
        o.gap_width = worst.gap_width;
        o.overlap_depth = worst.overlap_depth;
        o.turns_wound = last.0.max(0.0) / std::f64::consts::TAU;
        o.turns_settled = self.coil.turns_settled();
        o.layer = self.coil.layer().max(1) as i32;
        o.spindle_angle = self.sys.spindle.angle - self.angle0;
        o.spindle_torque = self.sys.torque_on_core;
        o.feed_speed = feed.rate;
        o.fed_length = feed.fed;
        o.free_length = free;
        o.layon_position = rod.x[lift].y;
        o.layon_angle = last.0;
        o.coil_width = self.coil.coil_width();
        o.mean_pitch = self.coil.mean_pitch();
        o.fill_factor = self.coil.fill_factor();
        o.wire_strain = self.coil.wire_strain();
        o.solver_steps = self.steps as f64;
        o.solver_rejects = self.implicit.as_ref().map_or(0.0, |m| {
            (m.statistics.rejects + m.statistics.newton_failures) as f64
        });
        o.live_nodes = rod.nodes() as i32;
        o.penetration_max = self.sys.deepest;
        o.energy_residual = residual;
    }

    fn staggered(&self) -> bool {
        self.scene.solver.integrator == Integrator::Verlet
    }

    /// The whole wire in the core frame.
    pub fn centreline(&self) -> Centreline {
        let spin = Spin::new(self.sys.spindle.angle);
        let back = turn_about_y(-self.sys.spindle.angle);
        let rod = &self.sys.rod;
        let mut line = match &self.sys.contacts {
            Some(c) => Centreline {
                points: c.tube.points.clone(),
                frames: c.tube.frames.clone(),
                arc: c.tube.arc.clone(),
                plastic_strain: c.tube.plastic_strain.clone(),
                tension: c.tube.tension.clone(),
                frozen: c.tube.len(),
            },
            None => Centreline::default(),
        };
        let mut arc = self.sys.arc0;
        for i in 0..rod.nodes() {
            let j = i.min(rod.edges() - 1);
            line.points.push(spin.to_core(rod.x[i]));
            line.frames.push(back * rod.frame[j]);
            line.arc.push(arc);
            line.plastic_strain.push(rod.stretch[j].strain);
            line.tension.push(self.sys.load.tension[j]);
            arc += rod.rest.get(i).copied().unwrap_or(0.0);
        }
        line
    }

    /// What the implicit method took so far; nothing for an explicit one.
    pub fn statistics(&self) -> integrate::SolverStatistics {
        self.implicit
            .as_ref()
            .map_or_else(Default::default, |m| m.statistics)
    }

    /// The mechanical system, for verification and tests.
    pub fn system(&self) -> &System {
        &self.sys
    }

    /// The same, to put loads on it that no scene has (verification only).
    pub fn system_mut(&mut self) -> &mut System {
        &mut self.sys
    }
}

/// The production method for a scene.
fn implicit_for(scene: &Scene) -> Implicit {
    let solver = scene.solver;
    // a step of a nanosecond resolves any contact: what fails there fails for another reason; a tenth
    // of a second is longer than any motion of a wire takes
    let mut method = Implicit::new(Scheme::Bdf2, solver.tolerance, 1e-9, 0.1);
    method.fixed = (solver.step > 0.0).then_some(solver.step);
    method
}

fn check_finite(inputs: &Inputs, time: f64) -> Result<(), SimError> {
    for (name, value) in [
        ("spindle_speed", inputs.spindle_speed),
        ("nozzle_position", inputs.nozzle_position),
        ("tension_setpoint", inputs.tension_setpoint),
    ] {
        if !value.is_finite() {
            return Err(SimError {
                time,
                node: None,
                reason: format!("input {name} = {value} is not a finite number"),
            });
        }
    }
    if inputs.tension_setpoint < 0.0 {
        return Err(SimError {
            time,
            node: None,
            reason: format!(
                "input tension_setpoint = {} N must not be negative",
                inputs.tension_setpoint
            ),
        });
    }
    Ok(())
}
