//! What happens within a communication step is seen at its end, and what does not move stays.

use coilwind::measure::STATION_STEP;
use coilwind::settings::SceneSettings;
use coilwind::signals::{EventKind, Outputs};
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

fn fig8() -> Simulation {
    let settings = SceneSettings::load("fig8").unwrap();
    Simulation::new(&settings.build().unwrap()).unwrap()
}

/// Speeds up to `speed` (rad/s) by 15 rad/s a millisecond, `count` milliseconds in all; the nozzle goes by `pitch`, m a turn.
fn wound(speed: f64, pitch: f64, count: u32) -> Simulation {
    wound_with(&[], speed, pitch, count)
}

/// The same with these settings.
fn wound_with(changes: &[(&str, &str)], speed: f64, pitch: f64, count: u32) -> Simulation {
    let mut settings = SceneSettings::load("fig8").unwrap();
    for (name, value) in changes {
        settings.set_text(name, value).unwrap();
    }
    let mut sim = Simulation::new(&settings.build().unwrap()).unwrap();
    let mut inputs = sim.inputs();
    for k in 0..count {
        inputs.spindle_speed = (15.0 * f64::from(k)).min(speed);
        inputs.nozzle_position += pitch * inputs.spindle_speed * 1e-3 / TAU;
        sim.advance(inputs, 1e-3).unwrap();
    }
    sim
}

/// 300 rad/s, then -300 for a millisecond: slack came and went, and the end of the step had no word of it.
#[test]
fn slack_that_passes_within_a_step_is_seen() {
    let mut sim = wound(300.0, 0.7e-3, 30);
    assert!(!sim.outputs().defect_slack);
    let mut inputs = sim.inputs();
    inputs.spindle_speed = -300.0;
    sim.advance(inputs, 1e-3).unwrap();
    let o = *sim.outputs();
    assert!(o.wire_tension_min == 0.0 && o.wire_tension > 1.0, "{o:?}");
    assert!(o.defect_slack);
    assert_eq!(
        (o.defect_code, o.defect_count, o.defect_count_slack),
        (16, 1, 1)
    );
    assert_eq!((o.defect_kind, o.defect_turn), (16, 1.0));
    assert!((0.03..=0.031).contains(&o.defect_time), "{}", o.defect_time);
    inputs.spindle_speed = 0.0;
    for _ in 0..20 {
        sim.advance(inputs, 1e-3).unwrap();
    }
    let o = sim.outputs();
    assert!(
        o.wire_tension_min > 0.0 && !o.defect_slack && o.defect_code == 0,
        "{o:?}"
    );
    assert_eq!((o.defect_count, o.defect_kind), (1, 16));
}

/// A loose turn was found after the wire had gone slack, in wire that had come to rest before. `defect_count` rose, and `defect_kind` to
/// `defect_size` went on telling of the slack.
#[test]
fn what_is_found_after_slack_is_the_last_defect() {
    let mut settings = SceneSettings::load("fig8").unwrap();
    for (name, value) in [
        ("core.shape", "cylinder"),
        ("core.radius_mm", "5"),
        ("wire.material", "copper-soft"),
        ("wire.diameter_mm", "0.4"),
        ("tensioner.tension", "5"),
        ("nozzle.distance_mm", "14"),
        ("solver.tolerance_um", "10"),
    ] {
        settings.set_text(name, value).unwrap();
    }
    let mut sim = Simulation::new(&settings.build().unwrap()).unwrap();
    let mut inputs = sim.inputs();
    let mut slack = f64::NAN;
    for k in 0..300 {
        inputs.spindle_speed = (3.75 * f64::from(k)).min(150.0);
        inputs.nozzle_position += 5.5e-4 * inputs.spindle_speed * 0.5e-3 / TAU;
        inputs.tension_setpoint = if k == 155 { 0.0 } else { 5.0 };
        sim.advance(inputs, 0.5e-3).unwrap();
        let o = sim.outputs();
        if o.defect_count_slack == 1 && slack.is_nan() {
            slack = o.defect_time;
            assert_eq!((o.defect_kind, o.defect_count_loose_turn), (16, 0));
        }
        if o.defect_count_loose_turn == 1 {
            assert_eq!((o.defect_kind, o.defect_turn), (512, 2.0));
            assert!(o.defect_time < slack, "{slack}, {o:?}");
            return;
        }
    }
    panic!(
        "no turn was found loose after the slack: {slack} {:?}",
        sim.outputs()
    );
}

/// A last turn that snapped into its groove took the tension away for 6 to 30 us, and condemned coils of which all turns lay in their places.
#[test]
fn slack_in_which_no_wire_is_laid_is_none() {
    let mut sim = wound(100.0, 0.7e-3, 30);
    let mut inputs = sim.inputs();
    for (back, told) in [(0.9 * STATION_STEP, false), (5.0 * STATION_STEP, true)] {
        // the core gives wire back, and draws it in again
        inputs.spindle_speed = -600.0;
        sim.advance(inputs, back / 600.0).unwrap();
        inputs.spindle_speed = 100.0;
        let mut least = sim.outputs().wire_tension_min;
        for _ in 0..50 {
            sim.advance(inputs, 1e-4).unwrap();
            least = sim.outputs().wire_tension_min.min(least);
        }
        let o = sim.outputs();
        assert_eq!((least, o.defect_count_slack), (0.0, i32::from(told)));
        assert!(!o.defect_slack && o.wire_tension > 1.0);
    }
}

/// At 300 rad/s and above a snap of 0.1 ms condemned a coil, since the core turned by more than a station meanwhile.
#[test]
fn slack_counts_by_the_tensioners_time_or_by_the_wire_that_is_laid() {
    // seconds back, mass of the tensioner, kg
    for (back, mass, told) in [
        (70e-6, "1e-3", false),
        (300e-6, "1e-3", true),
        (600e-6, "0.5", true),
    ] {
        let mut sim = wound_with(&[("tensioner.mass", mass)], 100.0, 0.7e-3, 30);
        let mut inputs = sim.inputs();
        let mut least = f64::INFINITY;
        for (speed, time) in [(-600.0, back), (600.0, back + 20e-6), (100.0, 1e-3)] {
            inputs.spindle_speed = speed;
            sim.advance(inputs, time).unwrap();
            least = sim.outputs().wire_tension_min.min(least);
        }
        assert!(600.0 * back > 2.0 * STATION_STEP);
        let o = sim.outputs();
        assert_eq!((least, o.defect_count_slack), (0.0, i32::from(told)));
    }
}

/// A core that turns away and comes back to where the wire was slack has slack of another time there: it was counted once for all.
#[test]
fn slack_that_comes_again_after_turns_between_counts_again() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    for k in 0..16 {
        inputs.spindle_speed = if k % 2 == 0 { 300.0 } else { -300.0 };
        for _ in 0..10 {
            sim.advance(inputs, 5e-3).unwrap();
        }
    }
    // (each way back begins with slack)
    assert!(sim.outputs().defect_count_slack >= 8, "{:?}", sim.outputs());
}

/// A core that turned forth and back had a tension 0.03 N below its smallest: edges at the nozzle are joined after the last look.
#[test]
fn a_tension_that_a_change_of_the_mesh_left_is_one_of_its_extremes() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    for k in 0..500 {
        inputs.spindle_speed = 60.0 * (0.03 * (f64::from(k) + 0.5)).sin();
        inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * 1e-3 / TAU;
        sim.advance(inputs, 1e-3).unwrap();
        let o = sim.outputs();
        let extremes = o.wire_tension_min..=o.wire_tension_max;
        assert!(
            extremes.contains(&o.wire_tension),
            "{k}: {} is not in {extremes:?}",
            o.wire_tension
        );
    }
}

/// A core that turned back past its start had -0.003 turns in the layer, and no turn wound.
#[test]
fn no_layer_has_less_than_no_turn() {
    let mut sim = wound(100.0, 0.7e-3, 30);
    let mut inputs = sim.inputs();
    for k in 0..120 {
        inputs.spindle_speed = (100.0 - 4.0 * f64::from(k)).max(-100.0);
        inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * 1e-3 / TAU;
        sim.advance(inputs, 1e-3).unwrap();
        let o = sim.outputs();
        assert!(o.turn_in_layer >= 0.0, "{k}: {}", o.turn_in_layer);
    }
    assert!(sim.outputs().spindle_angle < -1.0);
}

/// A gap was told as "bulge, overlap, double turn, gap" where the coil had those three already.
#[test]
fn an_event_names_the_defect_that_came_and_no_other() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    let mut told = Vec::new();
    for k in 0..350 {
        // First turn on turn, then apart.
        inputs.spindle_speed = (15.0 * f64::from(k)).min(100.0);
        let pitch = if k < 180 { 0.0 } else { 2e-3 };
        inputs.nozzle_position += pitch * inputs.spindle_speed * 1e-3 / TAU;
        sim.advance(inputs, 1e-3).unwrap();
        let events = sim.drain_events().into_iter();
        told.extend(events.filter(|e| e.kind == EventKind::Defect));
    }
    let gaps = told.iter().filter(|e| e.text.contains("gap"));
    let gaps: Vec<_> = gaps.map(|e| e.text.as_str()).collect();
    assert!(!gaps.is_empty() && told.len() > gaps.len(), "{told:?}");
    assert!(gaps.iter().all(|text| text.ends_with("(gap)")), "{gaps:?}");
}

/// Between the ends of a step of the solver the turns went on, and those of the layer stood still.
#[test]
fn turns_of_the_layer_go_on_with_the_turns() {
    let mut sim = wound(100.0, 0.7e-3, 20);
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 100.0;
    sim.step_beyond(true);
    for k in 0..2_000 {
        inputs.nozzle_position += 0.7e-3 * 100.0 * 5e-6 / TAU;
        sim.advance(inputs, 5e-6).unwrap();
        let o = sim.outputs();
        let off = (o.turn_in_layer - o.turns_wound).abs();
        assert!(off < 1e-12, "{k}: {} of {}", o.turn_in_layer, o.turns_wound);
    }
    assert!(sim.outputs().turns_wound < 1.2);
}

#[test]
fn a_broken_wire_has_no_tension_in_any_output() {
    let mut sim = wound(100.0, 0.7e-3, 20);
    let mut inputs = sim.inputs();
    while !sim.outputs().defect_break {
        inputs.tension_setpoint += 5.0;
        sim.advance(inputs, 1e-3).unwrap();
        assert!(inputs.tension_setpoint < 150.0);
    }
    let o = *sim.outputs();
    assert!(o.wire_tension_max > 50.0);
    assert_eq!(
        (o.defect_kind, o.defect_count_break, o.defect_code & 8),
        (8, 1, 8)
    );
    for _ in 0..3 {
        sim.advance(inputs, 1e-3).unwrap();
        let o = sim.outputs();
        assert_eq!(
            (o.wire_tension, o.wire_tension_min, o.wire_tension_max),
            (0.0, 0.0, 0.0)
        );
        assert_eq!((o.defect_kind, o.defect_count_break), (8, 1));
    }
}

/// The tension told for the step of the break was that which broke the wire, or 0 where another step of the solver followed in it;
/// so were the speed at the nozzle and the torque.
#[test]
fn the_step_in_which_the_wire_breaks_ends_without_tension() {
    for beyond in [false, true] {
        for step in [1e-5, 1e-4, 1e-3, 5e-3] {
            let mut sim = wound(100.0, 0.7e-3, 20);
            sim.step_beyond(beyond);
            let mut inputs = sim.inputs();
            inputs.tension_setpoint = 90.0;
            let mut before = *sim.outputs();
            while !sim.outputs().defect_break {
                before = *sim.outputs();
                sim.advance(inputs, step).unwrap();
                assert!(sim.outputs().spindle_angle < 10.0 * TAU);
            }
            let o = *sim.outputs();
            let told = format!("{beyond} {step}: {o:?}");
            assert_eq!((o.wire_tension, o.spindle_torque), (0.0, 0.0), "{told}");
            assert_eq!((o.feed_speed, o.tensioner_speed), (0.0, 0.0), "{told}");
            assert_eq!(o.wire_tension_min, 0.0, "{told}");
            // (what broke it stands in the step, and what was told before rose to it)
            assert!(o.wire_tension_max > 80.0, "{told}");
            assert!(o.wire_tension_max >= before.wire_tension, "{told}");
            if step < 1e-4 {
                assert!(before.wire_tension > 60.0, "{told}: {before:?}");
            }
        }
    }
}

#[test]
fn every_kind_of_defect_has_its_count_and_its_size() {
    let sim = wound(100.0, 1.2e-3, 160);
    let o = sim.outputs();
    assert!(o.defect_gap && o.defect_count_gap > 0, "{o:?}");
    let counts = [
        o.defect_count_bulge,
        o.defect_count_gap,
        o.defect_count_overlap,
        o.defect_count_break,
        o.defect_count_slack,
    ];
    assert_eq!(counts.iter().sum::<i32>(), o.defect_count);
    let last = sim.coil().last_defect().unwrap();
    assert_eq!(
        (o.defect_kind, o.defect_time),
        (last.kind.code(), last.time)
    );
    assert!(
        (0.15..1.0).contains(&(o.defect_size / 0.7e-3)),
        "{}",
        o.defect_size
    );
}

fn lay_on(o: &Outputs) -> [f64; 5] {
    [
        o.turns_wound,
        o.free_length,
        o.layon_position,
        o.layon_angle,
        o.wire_length,
    ]
}

/// Nothing moved, and the place where the wire leaves the core went from one end of the face to the other.
#[test]
fn the_place_where_wire_is_laid_stands_with_the_spindle() {
    let mut sim = fig8();
    let inputs = sim.inputs();
    let start = lay_on(sim.outputs());
    for _ in 0..50 {
        sim.advance(inputs, 1e-3).unwrap();
        for (now, start) in lay_on(sim.outputs()).into_iter().zip(start) {
            assert!((now - start).abs() < 1e-5, "{now} {start}");
        }
    }
    let mut sim = wound(100.0, 0.7e-3, 60);
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 0.0;
    sim.advance(inputs, 0.05).unwrap();
    let stopped = lay_on(sim.outputs());
    for _ in 0..50 {
        sim.advance(inputs, 1e-3).unwrap();
        for (now, stopped) in lay_on(sim.outputs()).into_iter().zip(stopped) {
            assert!((now - stopped).abs() < 1e-5, "{now} {stopped}");
        }
    }
}

/// The place where wire is laid moves along the wire, not from node to node: between landings by far less than the 0.3 mm
/// between nodes in a step of the core of 0.03 rad.
#[test]
fn the_place_where_wire_is_laid_moves_along_the_wire() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    inputs.spindle_speed = 30.0;
    let (mut before, mut steps) = (sim.outputs().wire_length, Vec::new());
    for _ in 0..200 {
        inputs.nozzle_position += 0.7e-3 * 0.03 / TAU;
        sim.advance(inputs, 1e-3).unwrap();
        steps.push((sim.outputs().wire_length - before).abs());
        before = sim.outputs().wire_length;
    }
    let jumps = steps.iter().filter(|step| **step > 2.5e-4).count();
    assert!(jumps < 12, "{jumps} of {}", steps.len());
}

/// A slope that misses the next value by more than the value held is worse than none. No slope foretells a landing.
#[test]
fn slopes_predict_better_than_the_value_held() {
    let mut sim = wound(100.0, 0.7e-3, 20);
    let mut inputs = sim.inputs();
    let seen = |o: &Outputs| {
        [
            ("wire_tension", o.wire_tension),
            ("spindle_torque", o.spindle_torque),
            ("feed_speed", o.feed_speed),
            ("fed_length", o.fed_length),
            ("spindle_angle", o.spindle_angle),
            ("free_length", o.free_length),
            ("turns_wound", o.turns_wound),
            ("layon_angle", o.layon_angle),
            ("layon_position", o.layon_position),
            ("tensioner_position", o.tensioner_position),
            ("nozzle_y", o.nozzle_y),
        ]
    };
    let mut missed = [[0.0_f64; 2]; 11];
    for _ in 0..100 {
        let before = *sim.outputs();
        let (now, rates) = (seen(&before), seen(sim.output_rates()));
        inputs.nozzle_position += 0.7e-3 * 0.1 / TAU;
        sim.advance(inputs, 1e-3).unwrap();
        let o = sim.outputs();
        if o.wire_length - before.wire_length > 1.5 * (o.fed_length - before.fed_length) {
            continue;
        }
        for (k, (_, next)) in seen(sim.outputs()).into_iter().enumerate() {
            missed[k][0] += (next - now[k].1).powi(2);
            missed[k][1] += (next - now[k].1 - 1e-3 * rates[k].1).powi(2);
        }
    }
    for ((name, _), [held, led]) in seen(sim.outputs()).into_iter().zip(missed) {
        println!(
            "{name}: held {:.3e} led {:.3e}",
            (held / 100.0).sqrt(),
            (led / 100.0).sqrt()
        );
        let most = match name {
            // the tensioner rests on its brake, or goes on
            "tensioner_position" | "nozzle_y" => 0.2,
            _ => 1.001,
        };
        assert!(led <= most * held, "{name}: {:.3}", (led / held).sqrt());
    }
}

/// The deepest contact "since the last communication point" was that of the whole run: it never fell.
#[test]
fn the_deepest_contact_is_that_of_the_last_step() {
    for integrator in ["implicit", "verlet"] {
        let text = format!(
            "[spindle]\nramp_turns = 0.1\n[solver]\nintegrator = '{integrator}'\n[core]\nshape = 'cylinder'\nradius_mm = 8\n[nozzle]\ndistance_mm = 25\n"
        );
        let settings =
            SceneSettings::from_toml_str(&text, "scene.toml", std::path::Path::new("")).unwrap();
        let mut sim = Simulation::new(&settings.build().unwrap()).unwrap();
        let mut inputs = sim.inputs();
        let mut deepest = Vec::new();
        for k in 0..30 {
            inputs.spindle_speed = (30.0 * f64::from(k)).min(150.0);
            inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * 1e-3 / TAU;
            sim.advance(inputs, 1e-3).unwrap();
            deepest.push(sim.outputs().penetration_max);
        }
        let most = sim.winding().summary().penetration.largest_m;
        let largest = deepest.iter().copied().fold(0.0, f64::max);
        assert!(
            most > 0.0 && largest <= most,
            "{integrator}: {largest} {most}"
        );
        assert!(largest > 0.9 * most, "{integrator}: {largest} {most}");
        assert!(!deepest.is_sorted(), "{integrator}: {deepest:?}");
    }
}
