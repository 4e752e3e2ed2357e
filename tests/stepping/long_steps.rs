//! What happens in a long communication step is told with the time, place and turn at which it happened.

use coilwind::measure::DefectKind;
use coilwind::settings::SceneSettings;
use coilwind::signals::{EventKind, Inputs};
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

fn fig8() -> Simulation {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    settings
        .set_text("solver.tolerance", "1e-5")
        .expect("a setting");
    Simulation::new(&settings.build().expect("valid")).expect("starts")
}

/// A step of 0.2 s that sent the nozzle into the core had its collision at 0 s, and wound nothing on the way.
#[test]
fn a_collision_is_told_when_the_nozzle_gets_there() {
    let met = |dt: f64| {
        let mut sim = fig8();
        let way = -52e-3 / 0.2;
        let mut inputs = sim.inputs();
        inputs.spindle_speed = 60.0;
        let count = (0.2 / dt).round() as u32;
        for k in 1..=count {
            inputs.nozzle_offset_x = way * dt * f64::from(k);
            inputs.nozzle_position += 0.7e-3 * 60.0 * dt / TAU;
            sim.advance(inputs, dt).expect("goes on");
        }
        let o = *sim.outputs();
        assert_eq!(o.defect_count_collision, 1);
        (o.defect_time, o.turns_wound)
    };
    let (start, core, d) = (60e-3, libm::hypot(4e-3, 13e-3) + 2e-3, 0.7e-3);
    // it meets wire on the core first, and has half a wire left to the core itself
    let [wire, bare] = [core + d, core + 0.5 * d].map(|reach| (start - reach) / 0.26);
    for dt in [0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.001] {
        let (time, turns) = met(dt);
        assert!((wire..bare).contains(&time), "{dt} s: {time}");
        assert!((1.5..1.9).contains(&turns), "{dt} s: {turns}");
    }
}

/// A nozzle that flies through the circle within a step, and stands outside of it at the end, has met the core as well.
#[test]
fn a_nozzle_that_goes_right_through_the_core_meets_it() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    inputs.nozzle_offset_x = -2.0 * sim.scene().nozzle.distance;
    sim.advance(inputs, 0.01).expect("goes on");
    assert_eq!(sim.outputs().defect_count_collision, 1);
}

/// By 1.3 mm a turn at 100 rad/s, in steps of this length, s.
fn wide(dt: f64) -> Simulation {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 100.0;
    for _ in 0..(0.3 / dt).round() as u32 {
        inputs.nozzle_position += 1.3e-3 * 100.0 * dt / TAU;
        sim.advance(inputs, dt).expect("goes on");
    }
    sim
}

/// A step of 0.3 s had its gap at 0 s, and a message that wire of turn 4 had come to rest in turn 0.2.
#[test]
fn a_defect_is_told_with_the_time_at_which_its_wire_came_to_rest() {
    let of = |dt: f64| wide(dt).defects().first().map(|gap| gap.time_s);
    let [fine, coarse] = [1e-3, 0.3].map(|dt| of(dt).expect("a gap"));
    // (looks for rest are 1/15 of a turn apart at most)
    assert!((fine - coarse).abs() < 5e-3, "{fine} and {coarse}");
    assert!(coarse > 0.05);
    let mut sim = wide(0.3);
    let rest = |event: &&coilwind::signals::Event| event.kind == EventKind::Turn;
    let events = sim.drain_events();
    let turns: Vec<f64> = events.iter().filter(rest).map(|event| event.turn).collect();
    assert!(turns.len() >= 3, "{events:?}");
    for (k, turn) in turns.iter().enumerate() {
        assert!(*turn > (k + 1) as f64, "{turns:?}");
    }
}

/// A collision's message had the turns of the communication point before.
#[test]
fn the_end_of_a_run_is_told_with_the_turns_wound_by_then() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 60.0;
    inputs.nozzle_offset_x = -52e-3;
    inputs.nozzle_position += 0.7e-3 * 60.0 * 0.2 / TAU;
    sim.advance(inputs, 0.2).expect("goes on");
    let events = sim.drain_events();
    let end = events.iter().find(|e| e.kind == EventKind::Collision);
    let turn = end.expect("a collision").turn;
    assert!((turn - sim.outputs().turns_wound).abs() < 0.05, "{turn}");
    assert!(turn > 1.5);
}

/// The core went on through the wire that had not come to rest: turns lay inside it in the files of the run.
#[test]
fn wire_goes_round_with_the_core_after_the_end() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 100.0;
    sim.advance(inputs, 0.1).expect("goes on");
    inputs.nozzle_offset_x = -sim.scene().nozzle.distance;
    sim.advance(inputs, 1e-3).expect("goes on");
    assert_eq!(sim.outputs().defect_count_collision, 1);
    let (before, angle) = (sim.centreline(), sim.outputs().spindle_angle);
    sim.advance(inputs, 0.05).expect("goes on");
    assert!((sim.outputs().spindle_angle - angle - 5.0).abs() < 1e-6);
    let after = sim.centreline();
    let (old, new) = (&before.points, &after.points);
    assert_eq!(old.len(), new.len());
    let far = old.iter().zip(new).map(|(a, b)| (a - b).norm());
    assert!(far.fold(0.0, f64::max) < 1e-12);
    let frames = before.frames.iter().zip(&after.frames);
    assert!(frames.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) < 1e-12);
}

/// What happened to wire of the second layer, while that of the first was coming to rest, was of the first.
#[test]
fn a_fault_is_of_the_layer_that_is_being_laid() {
    let mut settings = SceneSettings::load("bobbin").expect("packed");
    for (key, value) in [
        ("solver.tolerance", "1e-5"),
        ("core.flange.inner_distance_mm", "2.5"),
        ("nozzle.y_start_mm", "-0.9"),
        ("start.clamp_y_mm", "-0.9"),
        ("winding.turns_per_layer", "3"),
        ("winding.layers", "3"),
    ] {
        settings.set_text(key, value).expect("a setting");
    }
    let scene = settings.build().expect("valid");
    for (turns, layer) in [(2.3, 1), (3.6, 2), (6.6, 3)] {
        let mut sim = Simulation::new(&scene).expect("starts");
        let until = sim.motion_profile().time_at(turns * TAU);
        sim.advance_profile(until).expect("goes on");
        let mut inputs = sim.inputs();
        inputs.nozzle_offset_x = -sim.scene().nozzle.distance;
        sim.advance(inputs, 1e-3).expect("goes on");
        let defects = sim.defects();
        let end = defects.iter().find(|d| d.kind == DefectKind::Collision);
        assert_eq!(end.expect("a collision").layer, layer, "{turns} turns");
    }
}

/// A gap in wire that came to rest and loose again within a step raised its flag, and left kind, turn and time at 0.
#[test]
fn a_defect_that_is_unwound_within_its_step_is_the_last_one() {
    let wind = |parts: u32| {
        let mut sim = fig8();
        let mut inputs = sim.inputs();
        let dt = 1e-3;
        for k in 0..108 {
            inputs.spindle_speed = (f64::from(k) * 10.0).min(100.0);
            inputs.nozzle_position += 1.3e-3 * inputs.spindle_speed * dt / TAU;
            sim.advance(inputs, dt).expect("goes on");
        }
        assert_eq!(sim.outputs().defect_count, 0);
        let (rate, long) = (-2600.0, 0.1 / f64::from(parts));
        for k in 0..parts {
            inputs.spindle_speed = 100.0 + rate * long * f64::from(k);
            let rates = Inputs {
                spindle_speed: rate,
                ..Inputs::HELD
            };
            sim.advance_ramped(inputs, rates, long).expect("goes on");
        }
        *sim.outputs()
    };
    let [long, short] = [1, 200].map(wind);
    assert_eq!((long.defect_count, short.defect_count), (0, 0), "unwound");
    assert!(long.defect_gap);
    let gap = DefectKind::Gap.code();
    assert_eq!((long.defect_kind, short.defect_kind), (gap, gap));
    assert_eq!(long.defect_turn, short.defect_turn);
    assert!((long.defect_time - short.defect_time).abs() < 1e-3);
    assert!(long.defect_size > 0.0);
}

/// Where a step ended between steps of the method, the next one's extremes could leave out the tension that had been told there.
#[test]
fn extremes_hold_the_tension_at_both_ends() {
    let mut sim = fig8();
    sim.step_beyond(true);
    let mut inputs = sim.inputs();
    let mut random: u32 = 1;
    for k in 0..600 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let dt = libm::exp10(-6.0 + 3.2 * f64::from(random >> 8) / f64::from(1 << 24));
        let before = sim.outputs().wire_tension;
        inputs.spindle_speed = 120.0;
        inputs.nozzle_position += 0.7e-3 * 120.0 * dt / TAU;
        if random >> 30 == 0 {
            inputs.tension_setpoint = 15.0 + 0.1 * f64::from(random >> 27 & 7);
        }
        sim.advance(inputs, dt).expect("goes on");
        let o = sim.outputs();
        for told in [before, o.wire_tension] {
            assert!(
                (o.wire_tension_min..=o.wire_tension_max).contains(&told),
                "step {k}: {told} N outside {} to {} N",
                o.wire_tension_min,
                o.wire_tension_max
            );
        }
    }
}

/// Slack in the step in which wire broke stayed up for good.
#[test]
fn slack_ends_with_the_wire() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 300.0;
    for _ in 0..30 {
        sim.advance(inputs, 1e-3).expect("goes on");
    }
    inputs.spindle_speed = -1500.0;
    sim.advance(inputs, 4e-3).expect("goes on");
    inputs.nozzle_offset_x = -sim.scene().nozzle.distance;
    sim.advance(inputs, 1e-3).expect("goes on");
    let o = *sim.outputs();
    assert!(o.defect_count_slack > 0 && o.defect_count_collision > 0);
    sim.advance(inputs, 1e-3).expect("goes on");
    assert!(!sim.outputs().defect_slack);
}

/// A controller that set the tension every 0.1 ms made each of the master's steps of 20 us a step of the solver.
#[test]
fn inputs_that_change_in_even_intervals_do_not_end_every_step() {
    let mut sim = fig8();
    sim.step_beyond(true);
    let mut inputs = sim.inputs();
    let (dt, each) = (2e-5, 5);
    let count = 5000;
    let mut before = 0;
    for k in 0..count {
        inputs.spindle_speed = 30.0;
        inputs.nozzle_position += 0.7e-3 * 30.0 * dt / TAU;
        if k % each == 0 {
            inputs.tension_setpoint = 15.0 + 0.5 * libm::sin(f64::from(k / each));
        }
        sim.advance(inputs, dt).expect("goes on");
        if k == 99 {
            before = sim.statistics().steps;
        }
    }
    let steps = sim.statistics().steps - before;
    assert!(steps * 4 < (count as u64 - 100), "{steps} of {count}");
}

/// Steps to the next change and steps that end at each communication point wind the same, within the tolerance of the run.
#[test]
fn stepping_to_the_next_change_leaves_the_wire_where_it_was() {
    let run = |dt: f64| {
        let mut sim = fig8();
        sim.step_beyond(true);
        let mut inputs = sim.inputs();
        let each = (1e-4 / dt).round() as u32;
        for k in 0..each * 500 {
            inputs.spindle_speed = 30.0;
            inputs.nozzle_position += 0.7e-3 * 30.0 * dt / TAU;
            if k % each == 0 {
                inputs.tension_setpoint = 15.0 + 0.5 * libm::sin(f64::from(k / each));
            }
            sim.advance(inputs, dt).expect("goes on");
        }
        *sim.caught_up().expect("goes on").outputs()
    };
    let (coarse, fine) = (run(1e-4), run(2e-5));
    let near = |a: f64, b: f64, most: f64| assert!((a - b).abs() < most, "{a} and {b}");
    near(coarse.wire_tension, fine.wire_tension, 0.01 * 15.0);
    near(coarse.fed_length, fine.fed_length, 1e-5);
}
