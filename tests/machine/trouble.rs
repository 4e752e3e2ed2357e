//! What machines do besides winding evenly: stop, stand, reverse, pull too much or not at all.

use crate::common::fig8;
use coilwind::math::V3;
use coilwind::measure::{DefectKind, Verdict};
use coilwind::settings::SceneSettings;
use coilwind::signals::{Event, EventKind, Inputs, Outputs};
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

/// A machine that runs the simulation from outside, step by step.
struct Machine {
    sim: Simulation,
    inputs: Inputs,
    /// communication step, s
    step: f64,
    events: Vec<Event>,
    lowest: f64,
}

impl Machine {
    fn new(changes: &[(&str, &str)]) -> Self {
        let sim = Simulation::new(&fig8(changes)).expect("the scene starts");
        Self {
            inputs: sim.inputs(),
            sim,
            step: 2.5e-4,
            events: Vec::new(),
            lowest: f64::INFINITY,
        }
    }

    fn out(&self) -> &Outputs {
        self.sim.outputs()
    }

    fn wait(&mut self, steps: usize) {
        for _ in 0..steps {
            self.sim
                .advance(self.inputs, self.step)
                .expect("the run goes on");
            self.events.extend(self.sim.drain_events());
            let o = self.out();
            assert!(o.wire_tension_min >= 0.0 && o.wire_tension_min <= o.wire_tension_max);
            assert!(o.free_length.is_finite() && o.fed_length.is_finite());
            self.lowest = self.lowest.min(o.wire_tension_min);
        }
    }

    /// Turns the spindle by this many turns at this speed, the nozzle along with it.
    fn turn(&mut self, turns: f64, speed: f64) {
        let pieces = (turns * TAU / (speed.abs() * self.step)).ceil();
        self.inputs.spindle_speed = speed;
        for _ in 0..pieces as usize {
            self.inputs.nozzle_position += 0.7e-3 * speed * self.step / TAU;
            self.wait(1);
        }
    }

    /// Changes the speed evenly over a time, s.
    fn ramp(&mut self, speed: f64, time: f64) {
        let from = self.inputs.spindle_speed;
        let pieces = (time / self.step).ceil();
        for k in 1..=pieces as usize {
            self.inputs.spindle_speed = from + (speed - from) * k as f64 / pieces;
            self.inputs.nozzle_position += 0.7e-3 * self.inputs.spindle_speed * self.step / TAU;
            self.wait(1);
        }
    }

    fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|e| e.kind == kind).count()
    }
}

/// Laid wire that froze and comes back is what it was before, to rounding; so is the energy balance.
#[test]
fn thawing_undoes_freezing() {
    for twist in ["off", "quasi-static", "dynamic"] {
        freeze_and_thaw(Machine::new(&[("solver.twist", twist)]));
    }
}

fn freeze_and_thaw(mut m: Machine) {
    m.ramp(100.0, 0.02);
    m.turn(0.6, 100.0);
    let before = m.sim.system().clone();
    let mut sys = before.clone();
    let frozen = sys.frozen_lengths().count();
    assert!(frozen > 10, "some wire lies frozen: {frozen}");
    sys.freeze_front(6);
    sys.freeze_front(3);
    sys.refresh();
    assert_eq!(sys.state.rod.nodes() + 9, before.state.rod.nodes());
    assert_eq!(sys.thaw_front(5) + sys.thaw_front(4), 9);
    sys.refresh();
    assert_eq!(sys.frozen_lengths().count(), frozen);
    let (a, b) = (&before.state.rod, &sys.state.rod);
    assert_eq!(a.rest, b.rest);
    for i in 0..a.nodes() {
        // live wire in the middle of yielding may go on by rounding each time it is looked at
        let (p, q) = (a.bend[i], b.bend[i]);
        let moved = (0..2).map(|k| (p.curvature[k] - q.curvature[k]).abs());
        assert!(
            moved.fold(0.0, f64::max) < 1e-6 && (p.rise - q.rise).abs() < 1e-9,
            "{p:?} {q:?}"
        );
    }
    assert_eq!((&a.stretch, &a.twist), (&b.stretch, &b.twist));
    for i in 0..a.nodes() {
        assert!((a.x[i] - b.x[i]).norm() < 1e-15, "node {i}");
        if i < a.edges() {
            let turned = (a.frame[i].conjugate() * b.frame[i]).imag().norm();
            assert!(turned < 1e-12, "edge {i}: {turned:.1e}");
            let pull = before.state.load.tension[i] - sys.state.load.tension[i];
            assert!(pull.abs() < 1e-6, "edge {i}: {pull:.1e} N");
        }
        // thawed wire comes back at rest on the turning core, whatever was left of its motion; the rest goes on
        let x = b.x[i];
        let carried = V3::new(x.z, 0.0, -x.x) * sys.state.spindle.speed;
        let expected = if i <= 9 { carried } else { a.v[i] };
        let nozzle = i + 1 == a.nodes();
        assert!(nozzle || (b.v[i] - expected).norm() < 1e-12, "node {i}");
    }
    for (x, y) in before
        .state
        .load
        .force
        .iter()
        .zip(&sys.state.load.force)
        .skip(1)
    {
        assert!(
            (x - y).norm() < 1e-6,
            "contact and friction are as they were"
        );
    }
    assert!((before.state.arc0 - sys.state.arc0).abs() < 1e-15);
    let moment = |s: &coilwind::system::System| s.clamp_frame(0).expect("clamped");
    let turned = (moment(&before).conjugate() * moment(&sys)).imag().norm();
    assert!(turned < 1e-12, "the clamp is as it was: {turned:.1e}");
    let (x, y) = (before.energy_residual(None), sys.energy_residual(None));
    // what little the frozen wire still moved by is gone: 0.3 % of 4 uJ
    assert!((x - y).abs() < 5e-8, "{x} {y}");
    assert!((before.state.balance.frozen_stored - sys.state.balance.frozen_stored).abs() < 1e-12);
    assert!((before.state.balance.frozen_kinetic - sys.state.balance.frozen_kinetic).abs() < 1e-12);
}

#[test]
fn a_reversed_spindle_unwinds_the_coil() {
    for twist in ["off", "quasi-static", "dynamic"] {
        wind_and_unwind(Machine::new(&[("solver.twist", twist)]));
    }
}

fn wind_and_unwind(mut m: Machine) {
    m.ramp(100.0, 0.02);
    m.turn(2.1, 100.0);
    m.ramp(0.0, 0.02);
    let (wound, settled) = (m.out().turns_wound, m.out().turns_settled);
    assert!(wound > 2.2 && settled > 1.2, "{wound} {settled}");
    m.ramp(-100.0, 0.02);
    let mut last = settled;
    for _ in 0..8 {
        m.turn(0.3, -100.0);
        let o = m.out();
        // wire at the end of the ramp may still have come to rest
        assert!(o.turns_settled < last + 0.05 && o.turns_settled <= o.turns_wound);
        last = o.turns_settled;
        assert!(
            o.live_nodes < 250,
            "what comes off does not pile up: {}",
            o.live_nodes
        );
        let e = m.sim.energy();
        assert!(e.residual_over_dissipated.abs() < 0.01, "{e:?}");
        assert!(e.numerical_over_dissipated.abs() < 0.02, "{e:?}");
    }
    let o = m.out();
    assert_eq!((o.turns_wound, o.turns_settled), (0.0, 0.0));
    assert!(m.sim.coil().is_empty() && m.sim.centreline().frozen == 0);
    // all wire that had passed the nozzle has gone back but for kinks and stretch
    assert!(o.fed_length.abs() < 0.01, "{}", o.fed_length);
    // and it winds again
    m.ramp(100.0, 0.04);
    m.turn(1.0, 100.0);
    let o = m.out();
    assert!(
        o.turns_wound > 0.75 && o.turns_settled > 0.2,
        "{} wound, {} settled",
        o.turns_wound,
        o.turns_settled
    );
}

/// Standing still costs one evaluation a communication step, and wire there comes to rest by time.
#[test]
fn a_standing_spindle_lets_wire_settle_and_costs_nothing() {
    let mut m = Machine::new(&[]);
    m.ramp(100.0, 0.02);
    m.turn(1.0, 100.0);
    m.ramp(0.0, 0.02);
    let settled = m.out().turns_settled;
    m.wait(200);
    assert!(m.out().turns_settled > settled + 0.05, "rest by time");
    m.step = 0.1;
    m.wait(10);
    let (statistics, place) = (m.sim.statistics(), m.sim.centreline().points);
    let clock = std::time::Instant::now();
    m.wait(100);
    let took = clock.elapsed().as_secs_f64();
    let after = m.sim.statistics();
    eprintln!(
        "{:.0} steps for 10 s in {took:.4} s, {} solves",
        after.steps - statistics.steps,
        after.solves - statistics.solves
    );
    assert!(
        after.steps - statistics.steps <= 100,
        "the longest step there is"
    );
    assert!(after.solves - statistics.solves <= 20, "nothing to solve");
    for (p, q) in place.iter().zip(&m.sim.centreline().points) {
        assert!((p - q).norm() < 1e-6, "nothing creeps");
    }
    assert!((m.out().wire_tension - 15.0).abs() < 0.01);
}

/// A friction coefficient that is tuned between steps counts from the next step on.
#[test]
fn tuned_friction_moves_the_wire() {
    let mut plain = Machine::new(&[]);
    let mut tuned = Machine::new(&[]);
    for m in [&mut plain, &mut tuned] {
        m.turn(0.35, 100.0);
    }
    let rough = fig8(&[("friction.static", "0.6"), ("friction.kinetic", "0.5")]);
    tuned.sim.retune(&rough).expect("nothing is owed");
    assert_eq!(plain.out(), tuned.out());
    for m in [&mut plain, &mut tuned] {
        m.turn(0.25, 100.0);
    }
    assert_ne!(plain.out().spindle_torque, tuned.out().spindle_torque);
    assert_ne!(plain.out().fed_length, tuned.out().fed_length);
}

#[test]
fn slack_wire_is_told_and_taken_up_again() {
    let mut m = Machine::new(&[]);
    m.ramp(100.0, 0.02);
    m.turn(0.5, 100.0);
    assert_eq!(m.count(EventKind::Slack), 0);
    // the tensioner still comes with the speed it had, and little holds it back
    m.inputs.tension_setpoint = 0.5;
    m.ramp(0.0, 5e-4);
    // the slack lasts for 40 ms, give or take one with the tolerance, and ends in a jerk
    m.wait(30);
    assert!(m.count(EventKind::Slack) > 0 && m.lowest == 0.0);
    let o = m.out();
    assert!(
        o.wire_tension < 2.0 && !o.defect_break,
        "{}",
        o.wire_tension
    );
    assert_eq!(o.defect_code & 16 != 0, o.defect_slack);
    let points = m.sim.centreline().points;
    assert!(points.iter().all(|p| p.norm() < 0.1), "nothing flies away");
    m.inputs.tension_setpoint = 15.0;
    m.wait(200);
    assert!((m.out().wire_tension - 15.0).abs() < 0.5 && !m.out().defect_slack);
    m.ramp(100.0, 0.02);
    m.turn(0.5, 100.0);
    assert!(m.out().turns_wound > 1.0);
}

/// Slack that had passed left neither a defect nor a trace in the summary.
#[test]
fn slack_that_has_passed_stays_a_defect() {
    let mut m = Machine::new(&[]);
    m.ramp(100.0, 0.02);
    m.turn(0.5, 100.0);
    assert_eq!((m.out().defect_count, m.sim.defects().len()), (0, 0));
    let before = m.sim.time();
    m.inputs.tension_setpoint = 0.5;
    m.ramp(0.0, 5e-4);
    m.wait(40);
    m.inputs.tension_setpoint = 15.0;
    m.wait(200);
    m.ramp(100.0, 0.02);
    m.turn(1.0, 100.0);
    assert!(!m.out().defect_slack, "it has passed");
    let [slack] = &m.sim.defects()[..] else {
        panic!("one spell of slack: {:?}", m.sim.defects());
    };
    assert_eq!(
        (slack.kind, slack.turn, slack.layer),
        (DefectKind::Slack, 1, 1)
    );
    assert_eq!(m.count(EventKind::Slack), 1);
    assert!(slack.time_s > before && slack.until_s > Some(slack.time_s));
    // the angle is that of the place
    let [x, _, z] = slack.place_m;
    let polar = libm::atan2(z, x).to_degrees().rem_euclid(360.0);
    assert!((slack.angle_deg - polar).abs() < 1.0, "{slack:?}");
    let radius = libm::hypot(slack.place_m[0], slack.place_m[2]);
    assert!((6e-3..20e-3).contains(&radius), "on the core: {slack:?}");
    assert_eq!(m.out().defect_count, 1);
    assert_eq!(m.out().defect_turn, 1.0);
    assert!((m.out().defect_angle - slack.angle_deg.to_radians()).abs() < 1e-12);
    let summary = m.sim.summary();
    assert_eq!(
        (summary.verdict.as_str(), &summary.defects[0]),
        ("slack", slack)
    );
    assert_eq!(m.sim.turns()[0].verdict, Verdict::Slack);
    let bytes = m.sim.to_bytes().expect("a state");
    let again = Simulation::from_bytes(m.sim.scene(), &bytes).expect("the state is read");
    assert_eq!(again.defects(), m.sim.defects());
}

#[test]
fn unwinding_without_tension_survives() {
    let mut m = Machine::new(&[]);
    m.ramp(100.0, 0.02);
    m.turn(0.7, 100.0);
    m.ramp(0.0, 0.02);
    m.inputs.tension_setpoint = 0.0;
    m.ramp(-30.0, 0.02);
    m.turn(0.3, -30.0);
    assert!(m.count(EventKind::Slack) > 0);
    assert!(m.out().defect_slack && m.out().wire_tension < 1e-3);
}

#[test]
fn a_sudden_stop_pushes_nothing_out() {
    let mut m = Machine::new(&[]);
    m.ramp(300.0, 0.02);
    m.turn(1.0, 300.0);
    m.inputs.spindle_speed = 0.0;
    let fed = m.out().fed_length;
    m.wait(400);
    assert!(m.count(EventKind::Slack) > 0, "8 m/s on 1 g overruns 15 N");
    let o = m.out();
    // the tensioner's motion energy over its pull: 1 g at 6 m/s goes 1.2 mm, and its line as far again
    assert!(o.fed_length - fed < 4e-3, "{}", o.fed_length - fed);
    assert!((o.wire_tension - 15.0).abs() < 0.2 && !o.defect_slack);
    m.ramp(300.0, 0.02);
    m.turn(0.3, 300.0);
    assert!(m.sim.energy().residual_over_dissipated.abs() < 0.01);
}

#[test]
fn tension_above_yield_stretches_the_wire_for_good() {
    // table1 yields at 38.5 N
    let mut m = Machine::new(&[("tensioner.tension", "45")]);
    let start = m.sim.centreline().plastic_stretch;
    assert!(
        start.iter().all(|e| *e > 1e-3),
        "stretched before it starts"
    );
    m.ramp(100.0, 0.02);
    m.turn(1.0, 100.0);
    let o = m.out();
    assert!(o.wire_strain > 1e-3, "{}", o.wire_strain);
    assert!(!o.defect_break && (o.wire_tension - 45.0).abs() < 5.0);
    let line = m.sim.centreline();
    let fed = line.plastic_stretch.last().expect("wire");
    assert!(*fed > 1e-3, "wire that comes in has yielded too: {fed}");
    // raised on the way, the wire that comes later is stretched more
    m.inputs.tension_setpoint = 50.0;
    m.turn(0.3, 100.0);
    assert!(m.sim.centreline().plastic_stretch.last() > Some(fed));
}

/// Copper that is bent round the corners of a core yields there without any stretch: it was shown as wire that never yielded.
#[test]
fn wire_bent_round_corners_has_plastic_strain() {
    let mut m = Machine::new(&[("wire.material", "copper"), ("wire.elastic", "false")]);
    m.ramp(100.0, 0.02);
    m.turn(1.5, 100.0);
    let line = m.sim.centreline();
    assert_eq!(line.plastic_stretch, vec![0.0; line.points.len()]);
    let of = |nodes: &[f64]| nodes.iter().copied().fold(0.0, f64::max);
    // 0.35 mm over 2.35 mm where the wire lies on a corner of 2 mm; a joint between straight edges bends up to a sixth more
    let (rest, live) = line.plastic_strain.split_at(line.frozen);
    for largest in [of(rest), of(live)] {
        assert!((0.05..0.175).contains(&largest), "{largest}");
    }
    let straight = line.plastic_strain.iter().filter(|strain| **strain < 0.01);
    assert!(straight.count() > line.points.len() / 4, "flats");
}

/// Only the wire of the line has seen the peak; what the tensioner lets in later has not.
#[test]
fn a_peak_of_tension_stretches_the_line_and_no_wire_after_it() {
    let mut m = Machine::new(&[("tensioner.line_length", "0.03")]);
    let at_nozzle = |m: &Machine| *m.sim.centreline().plastic_stretch.last().expect("wire");
    let wind = |m: &mut Machine, length: f64| {
        let end = m.out().fed_length + length;
        while m.out().fed_length < end {
            m.wait(1);
        }
    };
    m.ramp(60.0, 0.01);
    m.inputs.tension_setpoint = 60.0;
    m.wait(8);
    m.inputs.tension_setpoint = 15.0;
    m.wait(4);
    let stretched = at_nozzle(&m);
    assert!(stretched > 5e-3, "{stretched}");
    wind(&mut m, 0.015);
    let line = at_nozzle(&m);
    assert!((line / stretched - 1.0).abs() < 0.2, "{line}");
    // the line is through, and the edge at the nozzle, of two free spacings, filled nine times over
    wind(&mut m, 0.075);
    let virgin = at_nozzle(&m);
    assert!(virgin < 1e-3 * stretched, "{virgin}");
    let energy = m.sim.energy();
    assert!(energy.residual_over_dissipated.abs() < 0.01, "{energy:?}");
}

#[test]
fn broken_wire_is_told_once_and_the_spindle_turns_on() {
    let mut m = Machine::new(&[]);
    m.ramp(100.0, 0.02);
    m.turn(0.3, 100.0);
    m.inputs.tension_setpoint = 200.0;
    m.turn(0.3, 100.0);
    let then = *m.out();
    assert!(then.defect_break && then.defect_code & 8 == 8);
    assert_eq!((then.wire_tension, then.spindle_torque), (0.0, 0.0));
    m.turn(0.5, 100.0);
    assert_eq!(m.count(EventKind::Break), 1, "{:?}", m.events);
    let now = *m.out();
    assert!((now.spindle_angle - then.spindle_angle - 0.5 * TAU).abs() < 0.05);
    let still = Outputs {
        spindle_angle: then.spindle_angle,
        nozzle_y: then.nozzle_y,
        layon_x: then.layon_x,
        layon_z: then.layon_z,
        ..now
    };
    assert_eq!(still, then, "all else stays");
    // no wire of it had come to rest, and no row of the table said that it broke
    let turns = m.sim.turns();
    let last = turns.last().expect("the turn that broke");
    assert_eq!(last.verdict, Verdict::Break, "{turns:?}");
    assert!(
        turns
            .iter()
            .zip(1..)
            .all(|(turn, number)| turn.turn == number)
    );
    assert_eq!(m.sim.inputs().nozzle_position, m.inputs.nozzle_position);
}

#[test]
fn a_jumping_nozzle_is_followed() {
    let mut m = Machine::new(&[]);
    m.ramp(100.0, 0.02);
    m.turn(0.5, 100.0);
    for way in [2e-3, -4e-3, 3e-3] {
        m.inputs.nozzle_position += way;
        m.turn(0.1, 100.0);
    }
    assert!(m.out().wire_tension > 5.0);
}

#[test]
fn a_step_that_fails_says_where_and_why_and_keeps_the_last_state() {
    // a hundredth of a second at 300 rad/s is half a turn
    let scene = fig8(&[("solver.step", "0.01")]);
    let mut sim = Simulation::new(&scene).expect("a fixed step is taken as it is");
    let inputs = Inputs {
        spindle_speed: 300.0,
        ..sim.inputs()
    };
    let error = loop {
        match sim.advance(inputs, 0.01) {
            Ok(()) => assert!(sim.time() < 1.0, "half a turn a step cannot go on"),
            Err(e) => break e,
        }
    };
    let text = error.to_string();
    for part in [
        "at t = ",
        "live node",
        "update",
        "solver.step",
        "1.0000e-2 s",
    ] {
        assert!(text.contains(part), "{text}");
    }
    assert!(error.node.is_some());
    let o = sim.outputs();
    assert!(o.wire_tension.is_finite() && o.free_length > 0.0 && o.solver_steps >= 0.0);
    assert!(sim.centreline().points.iter().all(|p| p.norm() < 0.1));
}

/// Springy wire on a thin core under little tension: its coil opens and shoots wire out of the nozzle. The line behind it
/// has no inertia, so nothing would ever stop that.
#[test]
fn wire_that_runs_away_from_the_nozzle_ends_the_run() {
    let scene = fig8(&[
        ("wire.material", "copper"),
        ("wire.elastic", "true"),
        ("wire.diameter", "0.0008"),
        ("core.width_x", "0.0021"),
        ("core.height_z", "0.006"),
        ("core.length_y", "0.034"),
        ("core.corner_radius", "0.0003"),
        ("nozzle.distance", "0.0073"),
        ("nozzle.y_start", "0.0006"),
        ("start.clamp_y", "0.0023"),
        ("tensioner.tension", "5.4"),
        ("tensioner.mass", "4e-5"),
        ("traverse.per_turn", "0"),
    ]);
    let mut sim = Simulation::new(&scene).expect("the scene starts");
    let inputs = Inputs {
        spindle_speed: 127.0,
        ..sim.inputs()
    };
    let code = DefectKind::Runaway.code();
    while sim.outputs().defect_code & code == 0 {
        assert!(sim.time() < 0.1, "{:?}", sim.outputs());
        sim.advance(inputs, 5e-5).expect("goes on");
    }
    let events = sim.drain_events();
    let told = events.iter().find(|e| e.kind == EventKind::Runaway);
    let text = told.expect("an event").to_string();
    for part in ["t = ", "runs away", "m/s", "N", "come in"] {
        assert!(text.contains(part), "{text}");
    }
    let o = sim.outputs();
    assert!(o.fed_length > 0.1 && o.fed_length < 0.3, "{}", o.fed_length);
}

#[test]
fn values_out_of_range_are_refused_with_the_range() {
    for (name, value, range) in [
        ("solver.tolerance", "-1e-6", "0 to 0.001 m"),
        ("solver.tolerance", "0.1", "0 to 0.001 m"),
        ("solver.spacing_near", "0.1", "to 0.05 m"),
        ("solver.step", "-1", "0 to 0.01 s"),
        ("freeze.time", "-1", "0 to 1e6 s"),
    ] {
        let mut settings = SceneSettings::load("fig8").expect("packed");
        let error = settings.set_text(name, value).expect_err(name).to_string();
        assert!(error.contains(name) && error.contains(range), "{error}");
    }
}

/// The end of the ramp and a sum of communication steps are the same time but for rounding.
#[test]
fn an_interval_may_end_where_the_ramp_does() {
    let changes = [("spindle.speed", "300"), ("spindle.turns", "1")];
    let mut sim = Simulation::new(&fig8(&changes)).expect("the scene starts");
    let dt = sim.motion_profile().end() / 200.0;
    for _ in 0..200 {
        sim.advance_profile(dt).expect("the run goes on");
    }
    assert!((sim.outputs().spindle_angle - TAU).abs() < 1e-9);
}

/// A run that left four times its dissipation unexplained was judged like any other.
#[test]
fn a_run_whose_balance_does_not_close_is_in_doubt() {
    let mut machine = Machine::new(&[("spindle.speed", "100")]);
    machine.turn(0.5, 100.0);
    assert_eq!(machine.sim.doubt(), None);
    let balance = &mut machine.sim.system_mut().state.balance;
    balance.inflow += 0.1 * (balance.spindle.abs() + balance.nozzle.abs());
    machine.turn(0.1, 100.0);
    let doubt = machine.sim.doubt().expect("a doubt");
    assert!(
        doubt.contains("J unexplained") && doubt.contains("solver.tolerance"),
        "{doubt}"
    );
    let events = machine.events.iter();
    let told =
        events.filter(|event| event.kind == EventKind::Judgement && doubt.ends_with(&event.text));
    assert_eq!(told.count(), 1, "{:?}", machine.events);
}

#[test]
fn a_run_with_wire_deep_in_what_it_touches_is_in_doubt() {
    let mut machine = Machine::new(&[("spindle.speed", "100")]);
    machine.turn(0.2, 100.0);
    let d = machine.sim.scene().wire.diameter;
    machine.sim.system_mut().state.deepest = 0.49 * d;
    machine.wait(1);
    assert_eq!(machine.sim.doubt(), None);
    machine.sim.system_mut().state.deepest = 0.51 * d;
    machine.wait(1);
    let doubt = machine.sim.doubt().expect("a doubt");
    assert!(doubt.contains("(0.51 d) deep"), "{doubt}");
}
