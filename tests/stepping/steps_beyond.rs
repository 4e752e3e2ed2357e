//! Steps of the method that reach beyond communication points: what a master reads must not depend on how finely it steps.

use crate::common::fig8;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const END: f64 = 0.016;
const TENSION: f64 = 15.0;

fn held(speed: f64, nozzle: f64) -> Inputs {
    Inputs {
        spindle_speed: speed,
        nozzle_position: nozzle,
        tension_setpoint: TENSION,
        ..Inputs::HELD
    }
}

fn start(beyond: bool) -> Simulation {
    let mut sim = Simulation::starting_with(&fig8(&[]), held(0.0, 0.0)).expect("starts");
    sim.step_beyond(beyond);
    sim
}

/// Winds at 100 rad/s in `count` equal steps.
fn wound(count: u32, beyond: bool) -> Simulation {
    let mut sim = start(beyond);
    for _ in 0..count {
        let step = END / f64::from(count);
        sim.advance(held(100.0, 0.0), step).expect("a step");
    }
    sim
}

#[test]
fn held_inputs_give_the_same_bits_in_steps_of_any_length() {
    let one = {
        let mut sim = wound(2, true);
        sim.catch_up().expect("a step");
        sim
    };
    for count in [16, 160, 1600, 16_000] {
        let mut fine = wound(count, true);
        assert!((fine.time() - END).abs() < 1e-15);
        fine.catch_up().expect("a step");
        let (a, b) = (one.centreline(), fine.centreline());
        assert_eq!(one.statistics(), fine.statistics(), "{count} steps");
        let far = a.points.iter().zip(&b.points).map(|(a, b)| (a - b).norm());
        let far = far.fold(0.0, f64::max);
        // the last step ends where the sum of the communication steps does
        assert!(far < 1e-12, "{far} m in {count} steps");
    }
}

#[test]
fn fine_steps_cost_no_solves() {
    let (free, fine) = (wound(2, true), wound(16_000, true));
    let steps = |sim: &Simulation| sim.statistics().steps;
    assert!(steps(&fine) <= steps(&free) + 2);
    assert!(steps(&wound(1600, false)) >= 1600);
}

/// Speed and rate at a time: a ramp to 100 rad/s in 5 ms.
fn ramped(t: f64) -> (Inputs, Inputs) {
    let rate = if t < 5e-3 - 1e-9 { 2e4 } else { 0.0 };
    let rates = Inputs {
        spindle_speed: rate,
        ..Inputs::HELD
    };
    (held((2e4 * t).min(100.0), 0.0), rates)
}

/// Outputs between the ends of steps, against those of a step that ends there, and against steps of 1 us.
#[test]
fn outputs_between_steps_are_those_of_short_steps() {
    let (mut coarse, mut fine) = (start(true), start(false));
    let points = 2500;
    let (mut worst, mut mean) = ([[0.0f64; 4]; 2], [[0.0; 4]; 2]);
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    let values = |o: &Outputs| [o.wire_tension, o.spindle_torque, o.fed_length, o.feed_speed];
    for point in 0..points {
        let step = |sim: &mut Simulation, t: f64, dt: f64| {
            let (inputs, rates) = ramped(t);
            sim.advance_ramped(inputs, rates, dt).expect("a step");
        };
        let t = 2e-5 * f64::from(point);
        step(&mut coarse, t, 2e-5);
        for k in 0..20 {
            step(&mut fine, t + 1e-6 * f64::from(k), 1e-6);
        }
        let mut there = coarse.clone();
        there.catch_up().expect("a step");
        let read = values(coarse.outputs());
        let exact = [values(there.outputs()), values(fine.outputs())];
        for k in 0..4 {
            for twin in 0..2 {
                let off = (read[k] - exact[twin][k]).abs();
                worst[twin][k] = worst[twin][k].max(off);
                mean[twin][k] += off * off / f64::from(points);
            }
            range[k] = [range[k][0].min(exact[1][k]), range[k][1].max(exact[1][k])];
        }
        let angle = coarse.outputs().spindle_angle - fine.outputs().spindle_angle;
        assert!(angle.abs() < 1e-9, "{angle}");
    }
    for (k, range) in range.iter().enumerate() {
        let share = |x: f64| 100.0 * x / (range[1] - range[0]);
        let [ends_there, short] =
            [0, 1].map(|twin| (share(mean[twin][k].sqrt()), share(worst[twin][k])));
        println!(
            "{k}: off by {ends_there:.2?} and {short:.2?} % of {range:.3?} (root mean square, most)"
        );
        // a landing within a step is seen at its end; what short steps change is the method's own error
        assert!(ends_there.0 < 2.0, "{k}");
    }
}

/// Inputs that change at every point, in the middle of steps ahead, and hold again.
fn shaken(sim: &mut Simulation, from: u32, to: u32) {
    for k in from..to {
        let speed = match k % 50 {
            0..10 => 60.0 + f64::from(k % 7),
            _ => 60.0,
        };
        let tension = if k % 90 < 80 { TENSION } else { 12.0 };
        let inputs = Inputs {
            tension_setpoint: tension,
            ..held(speed, 1e-6 * f64::from(k / 40))
        };
        sim.advance(inputs, 2e-5).expect("a step");
    }
}

#[test]
fn a_saved_state_with_a_step_ahead_goes_on_to_the_bit() {
    let mut sim = start(true);
    for (from, to) in [
        (0, 7),
        (7, 55),
        (55, 130),
        (130, 131),
        (131, 333),
        (333, 400),
    ] {
        shaken(&mut sim, from, to);
        let bytes = sim.to_bytes().expect("bytes");
        let mut other = Simulation::from_bytes(sim.scene(), &bytes).expect("a state");
        other.step_beyond(true);
        assert!(other.to_bytes().expect("bytes") == bytes);
        let mut copy = sim.clone();
        shaken(&mut copy, to, to + 100);
        shaken(&mut other, to, to + 100);
        assert_eq!(copy.outputs(), other.outputs());
        assert!(copy.to_bytes().expect("bytes") == other.to_bytes().expect("bytes"));
    }
}

/// The flag and the bound were forgotten where a step ahead was under way, as in a run that goes on from a saved state.
#[test]
fn a_run_with_a_step_ahead_stops_at_a_flag_that_it_is_given_then() {
    let mut sim = wound(1600, true);
    let wait = |sim: &mut Simulation| sim.advance(held(100.0, 0.0), 1e-5).expect("a step");
    while sim.winding().time() >= sim.time() {
        wait(&mut sim);
    }
    let bytes = sim.to_bytes().expect("bytes");
    let restored = || {
        let mut sim = Simulation::from_bytes(sim.scene(), &bytes).expect("a state");
        sim.step_beyond(true);
        sim
    };
    let refused = |mut sim: Simulation| {
        let error = sim.advance(held(100.0, 0.0), 0.01).expect_err("an end");
        error.to_string()
    };
    for mut sim in [restored(), sim.clone()] {
        sim.stop_on(Arc::new(AtomicBool::new(true)));
        let told = refused(sim);
        assert!(told.contains("interrupted"), "{told}");
    }
    let mut bounded = restored();
    bounded.limit_work(1);
    let told = refused(bounded);
    assert!(told.contains("the work allowed"), "{told}");
}

/// A controller that corrects the tension by a few hundredths of a newton at every fifth communication point.
fn corrected(sim: &mut Simulation, from: u32, to: u32) {
    for k in from..to {
        let set_anew = f64::from(k / 5);
        let inputs = Inputs {
            tension_setpoint: TENSION + 0.2 * (0.05 * set_anew).sin(),
            ..held(30.0, 0.0)
        };
        sim.advance(inputs, 2e-5).expect("a step");
    }
}

/// Winds for 0.25 s at 30 rad/s with the nozzle at a `distance`, m. The tension is measured and set anew every 0.1 ms, with as much
/// of what it is off by as `gain` says.
fn controlled(beyond: bool, gain: f64, distance: &str) -> (Simulation, f64) {
    let scene = fig8(&[("nozzle.distance", distance)]);
    let mut sim = Simulation::starting_with(&scene, held(0.0, 0.0)).expect("starts");
    sim.step_beyond(beyond);
    let (mut integral, mut set, mut off) = (0.0, TENSION, 0.0);
    for k in 0..12_500 {
        if k % 5 == 0 {
            let error = TENSION - sim.outputs().wire_tension;
            integral += 0.1 * gain * error;
            set = TENSION + gain * error + integral;
            off += error * error / 2500.0;
        }
        let inputs = Inputs {
            tension_setpoint: set,
            ..held(30.0, 0.0)
        };
        sim.advance(inputs, 2e-5).expect("a step");
    }
    (sim, off.sqrt())
}

/// Every change of an input once dropped the step under way, and a controller had three to six times the solves of constant tension.
#[test]
fn a_controller_costs_less_than_twice_a_constant_tension() {
    // (landings scatter fed wire by some um, so the mean of three coils is judged)
    let (mut sums, distances) = ([0.0; 2], ["0.0597", "0.06", "0.0603"]);
    for distance in distances {
        let [
            (sim, off),
            (plain, off_plain),
            (constant, _),
            (constant_plain, _),
        ] = [(true, 0.3), (false, 0.3), (true, 0.0), (false, 0.0)]
            .map(|(beyond, gain)| controlled(beyond, gain, distance));
        let counts = [&sim, &plain, &constant];
        let [taken, to_each, held] = counts.map(|sim| sim.statistics().evaluations);
        let fed = [(&sim, &plain), (&constant, &constant_plain)]
            .map(|(a, b)| a.outputs().fed_length - b.outputs().fed_length);
        println!("{taken} evaluations, {to_each} to each point, {held} at a constant tension");
        println!("tension off by {off:.3} and {off_plain:.3} N, fed wire by {fed:?} m");
        assert!(taken < 2 * held, "{taken} against {held}");
        assert!(off < 1.2 * off_plain, "{off} against {off_plain}");
        sums = [sums[0] + fed[0], sums[1] + fed[1]];
    }
    // (short steps lessen the method's own error, also at a constant tension)
    let [fed, fed_at_constant] = sums;
    let ratio = (fed - fed_at_constant).abs() / fed_at_constant.abs();
    assert!(ratio < 1.0, "{fed} against {fed_at_constant}");
}

#[test]
fn a_state_saved_between_small_corrections_goes_on_to_the_bit() {
    let mut sim = start(true);
    for (from, to) in [(0, 203), (203, 208), (208, 214), (214, 301), (301, 333)] {
        corrected(&mut sim, from, to);
        let bytes = sim.to_bytes().expect("bytes");
        let mut other = Simulation::from_bytes(sim.scene(), &bytes).expect("a state");
        other.step_beyond(true);
        let mut copy = sim.clone();
        corrected(&mut copy, to, to + 100);
        corrected(&mut other, to, to + 100);
        assert_eq!(copy.outputs(), other.outputs());
        assert!(copy.to_bytes().expect("bytes") == other.to_bytes().expect("bytes"));
    }
}

/// A correction that comes last is taken up, however small: the wire comes to rest at the tension that is set.
#[test]
fn the_last_small_correction_is_taken_up() {
    let mut sim = start(true);
    corrected(&mut sim, 0, 500);
    for _ in 0..500 {
        let inputs = Inputs {
            tension_setpoint: TENSION + 0.03,
            ..held(0.0, 0.0)
        };
        sim.advance(inputs, 1e-4).expect("a step");
    }
    let tension = sim.outputs().wire_tension;
    assert!((tension - TENSION - 0.03).abs() < 1e-3, "{tension}");
}

#[test]
fn what_inputs_did_is_kept_when_they_change() {
    let (mut ahead, mut plain) = (start(true), start(false));
    shaken(&mut ahead, 0, 400);
    shaken(&mut plain, 0, 400);
    ahead.catch_up().expect("a step");
    let (a, b) = (ahead.outputs(), plain.outputs());
    assert!((a.spindle_angle - b.spindle_angle).abs() < 1e-12);
    assert!((ahead.inputs().nozzle_position - plain.inputs().nozzle_position).abs() < 1e-15);
    let fed = a.fed_length - b.fed_length;
    assert!(fed.abs() < 1e-5, "{fed}");
    // where they change at every point, stepping beyond gives up
    let (mut ahead, mut plain) = (start(true), start(false));
    for k in 0..400 {
        let inputs = held(60.0 + 1e-3 * f64::from(k), 0.0);
        for sim in [&mut ahead, &mut plain] {
            sim.advance(inputs, 2e-5).expect("a step");
        }
    }
    let steps = |sim: &Simulation| sim.statistics().steps;
    assert!(steps(&ahead) <= steps(&plain) + 10, "{}", steps(&ahead));
}

#[test]
fn standing_still_is_never_behind() {
    let mut sim = start(true);
    for _ in 0..100 {
        sim.advance(held(0.0, 0.0), 0.05).expect("a step");
    }
    let before = sim.statistics();
    for _ in 0..1000 {
        sim.advance(held(0.0, 0.0), 0.05).expect("a step");
    }
    assert_eq!(sim.statistics(), before);
    assert!((sim.time() - 55.0).abs() < 1e-9);
    sim.advance(held(5.0, 0.0), 0.01).expect("a step");
    assert!((sim.outputs().spindle_angle - 0.05).abs() < 1e-12);
}

/// The motion of the scene begins where the inputs ended, not where the last step did.
#[test]
fn the_scenes_own_motion_goes_on_from_the_point() {
    let mut sim = start(true);
    for _ in 0..37 {
        sim.advance(held(100.0, 0.0), 2e-5).expect("a step");
    }
    let (time, angle) = (sim.time(), sim.outputs().spindle_angle);
    assert!(sim.winding().time() < time, "no step reaches beyond");
    sim.advance_profile(1e-4).expect("a step");
    assert!((sim.time() - time - 1e-4).abs() < 1e-12);
    assert!(sim.outputs().spindle_angle >= angle);
}

/// The scene's own motion until `end`, s, read at `count` points.
fn along_the_scene(scene: &Scene, end: f64, count: u32, beyond: bool) -> (Simulation, [f64; 2]) {
    let mut sim = Simulation::new(scene).expect("starts");
    sim.step_beyond(beyond);
    let mut tension = [f64::INFINITY, f64::NEG_INFINITY];
    for k in 1..=count {
        let next = end * f64::from(k) / f64::from(count);
        sim.advance_profile(next - sim.time()).expect("goes on");
        let o = sim.outputs();
        tension = [
            tension[0].min(o.wire_tension_min),
            tension[1].max(o.wire_tension_max),
        ];
    }
    (sim, tension)
}

/// Steps end where the ramp ends and where the nozzle turns, and nowhere for a point that is read.
#[test]
fn rows_change_nothing_along_the_scenes_own_motion() {
    for (name, settings) in [
        ("fig8", vec![("spindle.turns", "1")]),
        (
            "bobbin",
            vec![
                ("traverse.mode", "orthocyclic"),
                ("winding.turns_per_layer", "1"),
                ("winding.layers", "2"),
                ("solver.tolerance_um", "20"),
            ],
        ),
    ] {
        let mut given = SceneSettings::load(name).expect("packed");
        for (name, value) in settings {
            given.set_text(name, value).expect("a setting");
        }
        let scene = given.build().expect("valid");
        let end = Simulation::new(&scene)
            .expect("starts")
            .motion_profile()
            .end();
        let (one, extremes) = along_the_scene(&scene, end, 1, true);
        for count in [7, 300, 3000] {
            let (mut rows, tension) = along_the_scene(&scene, end, count, true);
            assert_eq!(tension, extremes, "{name}, {count} rows");
            rows.catch_up().expect("a step");
            assert_eq!(one.statistics(), rows.statistics(), "{name}, {count} rows");
            let (a, b) = (one.centreline(), rows.centreline());
            let far = a.points.iter().zip(&b.points).map(|(a, b)| (a - b).norm());
            let far = far.fold(0.0, f64::max);
            assert!(far < 1e-12, "{name}: {far} m in {count} rows");
        }
        let (profile, at_end) = (one.motion_profile(), one.inputs());
        assert!((at_end.nozzle_position - profile.nozzle(end)).abs() < 1e-12);
        assert!((one.outputs().spindle_angle.abs() - profile.angle(end).abs()).abs() < 1e-9);
        let (short, _) = along_the_scene(&scene, end, 300, false);
        let steps = |sim: &Simulation| sim.statistics().steps;
        assert!(steps(&one) < steps(&short));
    }
}

#[test]
fn a_saved_state_within_the_scenes_own_motion_goes_on_to_the_bit() {
    let scene = fig8(&[("spindle.turns", "1")]);
    let mut sim = Simulation::new(&scene).expect("starts");
    sim.step_beyond(true);
    let end = sim.motion_profile().end();
    let mut behind = 0;
    for _ in 0..20 {
        for _ in 0..25 {
            sim.advance_profile(end / 500.0).expect("goes on");
        }
        behind += u32::from(sim.winding().time() < sim.time());
        let bytes = sim.to_bytes().expect("bytes");
        let mut other = Simulation::from_bytes(&scene, &bytes).expect("a state");
        other.step_beyond(true);
        let mut copy = sim.clone();
        for run in [&mut copy, &mut other] {
            for _ in 0..60 {
                run.advance_profile(end / 500.0).expect("goes on");
            }
        }
        assert_eq!(copy.outputs(), other.outputs());
        assert!(copy.to_bytes().expect("bytes") == other.to_bytes().expect("bytes"));
    }
    assert!(behind > 10, "{behind}");
}

/// Inputs begin where the scene's own motion ended, and a copy that caught up leaves the run as it is.
#[test]
fn inputs_go_on_from_the_point_of_the_scenes_own_motion() {
    let mut sim = Simulation::new(&fig8(&[])).expect("starts");
    sim.step_beyond(true);
    let end = 0.4 * sim.motion_profile().end();
    for _ in 0..173 {
        sim.advance_profile(end / 173.0).expect("a step");
    }
    let (time, inputs, angle) = (sim.time(), sim.inputs(), sim.outputs().spindle_angle);
    assert!(sim.winding().time() < time, "no step reaches beyond");
    let there = sim.caught_up().expect("a step");
    assert_eq!(there.winding().time(), time);
    assert!((there.outputs().spindle_angle - angle).abs() < 1e-9);
    assert!(sim.winding().time() < time);
    sim.advance(inputs, 2e-5).expect("a step");
    assert!((sim.time() - time - 2e-5).abs() < 1e-15);
    let turned = sim.outputs().spindle_angle - angle;
    assert!(
        (turned - 2e-5 * inputs.spindle_speed).abs() < 1e-9,
        "{turned}"
    );
}

/// A core stood, its wire came to rest on the way to the first step of another tension, and that tension was never taken up: 100 N broke no
/// wire until the core turned.
#[test]
fn wire_that_comes_to_rest_takes_up_another_tension() {
    for stood in (20..140).step_by(10) {
        let mut sim = start(true);
        let mut stand = |tension: f64, steps: u32| {
            let inputs = Inputs {
                tension_setpoint: tension,
                ..held(0.0, 0.0)
            };
            for _ in 0..steps {
                sim.advance(inputs, 1e-3).expect("a step");
            }
            sim.outputs().wire_tension
        };
        let told = [(TENSION, stood), (25.0, 250), (TENSION, 250)].map(|(t, n)| stand(t, n) - t);
        assert!(
            told.iter().all(|off| off.abs() < 0.05),
            "{stood} ms: {told:?}"
        );
    }
}

/// Wire hung slack, all of it was at rest, and the tensioner that coasts was told a speed and no way.
#[test]
fn a_tensioner_that_coasts_gets_on() {
    for beyond in [false, true] {
        let mut sim = start(beyond);
        let slack = Inputs {
            tension_setpoint: 0.0,
            ..held(0.0, 0.0)
        };
        let mut stand = || {
            for _ in 0..300 {
                sim.advance(slack, 1e-3).expect("a step");
            }
            *sim.outputs()
        };
        let (before, after) = (stand(), stand());
        let way = after.tensioner_position - before.tensioner_position;
        assert!(before.tensioner_speed > 0.1, "{before:?}");
        assert!(
            (way - 0.3 * after.tensioner_speed).abs() < 1e-3,
            "{way} {after:?}"
        );
    }
}
