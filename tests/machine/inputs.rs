//! What a model of the machine sets and reads: a nozzle that moves along x and z, a damper, the coil so far.

use crate::common::fig8;
use coilwind::measure::Verdict;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;

/// Winds for `steps` milliseconds with a nozzle on the circle of the scene's, `turned` (rad) round the core from +x.
fn wound(turned: f64, steps: u32) -> Simulation {
    let scene = fig8(&[]);
    let distance = scene.nozzle.distance;
    let at_rest = Inputs {
        tension_setpoint: scene.tensioner.tension,
        nozzle_position: scene.nozzle_law.start(),
        nozzle_offset_x: distance * turned.cos() - distance,
        nozzle_offset_z: -distance * turned.sin(),
        ..Inputs::HELD
    };
    let mut run = Simulation::starting_with(&scene, at_rest).expect("starts");
    for k in 0..steps {
        let now = Inputs {
            spindle_speed: (4.0 * f64::from(k)).min(100.0),
            ..at_rest
        };
        run.advance(now, 1e-3).expect("goes on");
    }
    run
}

#[test]
fn a_nozzle_elsewhere_on_its_circle_winds_the_same_coil() {
    let [here, there] = [0.0, 0.8].map(|turned| wound(turned, 60));
    let (a, b) = (here.outputs(), there.outputs());
    assert!(a.turns_wound > 0.5, "{}", a.turns_wound);
    for (name, a, b, close) in [
        ("spindle_angle", a.spindle_angle, b.spindle_angle, 1e-12),
        ("wire_tension", a.wire_tension, b.wire_tension, 1e-3),
        ("free_length", a.free_length, b.free_length, 1e-5),
        ("layon_angle", a.layon_angle, b.layon_angle, 1e-3),
        ("turns_wound", a.turns_wound, b.turns_wound, 1e-4),
    ] {
        assert!((a - b).abs() < close, "{name}: {a} and {b}");
    }
    // the wire meets the coil at a place that is turned as the nozzle is
    let radius = |o: &coilwind::signals::Outputs| o.layon_x.hypot(o.layon_z);
    assert!((radius(a) - radius(b)).abs() < 1e-5);
    let turned = (-b.layon_z).atan2(b.layon_x) - (-a.layon_z).atan2(a.layon_x);
    assert!((turned - 0.8).abs() < 1e-3, "{turned}");
}

/// A nozzle that backs off draws wire out: as much as the free span becomes longer.
#[test]
fn a_nozzle_that_backs_off_draws_wire() {
    let mut run = wound(0.0, 0);
    let start = run.inputs();
    let before = *run.outputs();
    let rates = Inputs {
        nozzle_offset_x: 0.1,
        nozzle_offset_z: 0.05,
        ..Inputs::HELD
    };
    let mut now = start;
    for _ in 0..50 {
        run.advance_ramped(now, rates, 1e-3).expect("goes on");
        now = now.after(&rates, 1e-3);
    }
    for _ in 0..100 {
        run.advance(now, 1e-3).expect("goes on");
    }
    let is = run.inputs();
    assert!((is.nozzle_offset_x - start.nozzle_offset_x - 5e-3).abs() < 1e-12);
    assert!((is.nozzle_offset_z - start.nozzle_offset_z - 2.5e-3).abs() < 1e-12);
    let o = run.outputs();
    let (drawn, longer) = (
        o.fed_length,
        o.free_length + o.wire_length - before.free_length - before.wire_length,
    );
    assert!(
        drawn > 3e-3 && (drawn - longer).abs() < 0.05 * drawn,
        "{drawn} {longer}"
    );
    let scene = run.scene();
    assert!(
        (o.wire_tension - scene.tensioner.tension).abs() < 0.1,
        "{}",
        o.wire_tension
    );
}

#[test]
fn a_nozzle_that_starts_in_the_core_is_refused_and_one_sent_there_collides() {
    let mut run = wound(0.0, 0);
    let into = Inputs {
        nozzle_offset_x: -run.scene().nozzle.distance,
        ..run.inputs()
    };
    run.advance(into, 1e-3).expect("the run goes on");
    assert_eq!(run.verdict(), Verdict::Collision);
    let told = run.drain_events();
    assert!(
        told.iter()
            .any(|event| event.text.contains("nozzle_offset_x")),
        "{told:?}"
    );
    let scene = fig8(&[]);
    assert!(Simulation::starting_with(&scene, into).is_err());
}

/// Two turns at a constant speed on a cylinder of 10 mm, then on with the speed raised evenly.
fn on_a_cylinder(changes: &[(&str, &str)]) -> Simulation {
    let mut all = vec![
        ("core.shape", "cylinder"),
        ("core.radius", "0.01"),
        ("wire.elastic", "true"),
        ("spindle.speed", "50"),
    ];
    all.extend(changes);
    let mut run = Simulation::new(&fig8(&all)).expect("starts");
    let end = run.motion_profile().end();
    run.advance_profile(end).expect("goes on");
    run
}

/// On a round core the wire comes evenly, so that the damper adds its share of the speed.
#[test]
fn a_damped_tensioner_pulls_harder_the_faster_the_wire_comes() {
    let tension = |damping: &str| {
        let run = on_a_cylinder(&[("tensioner.damping", damping)]);
        let o = run.outputs();
        (o.wire_tension, o.tensioner_speed)
    };
    let ((free, _), (damped, speed)) = (tension("0"), tension("4"));
    assert!(speed > 0.4, "{speed}");
    let expected = free + 4.0 * speed;
    assert!(
        (damped - expected).abs() < 0.02 * expected,
        "{damped} {expected}"
    );
}

/// Resistance left the plastic stretch out: soft wire that is drawn thin had that of its section before.
#[test]
fn wire_that_is_stretched_for_good_resists_more() {
    let run = on_a_cylinder(&[
        ("wire.elastic", "false"),
        ("wire.material", "aluminium"),
        ("wire.yield_stress", "28e6"),
    ]);
    let (o, wire) = (*run.outputs(), run.scene().wire.clone());
    let resistivity = run.scene().resistivity;
    let unstretched = |length: f64| resistivity * length / wire.bare_area();
    // the sum of L^2 / V over the edges of the wire up to a place
    let line = run.centreline();
    let stretched = |length: f64| -> f64 {
        let edges = line.arc.windows(2).zip(&line.plastic_stretch);
        let of = |(ends, strain): (&[f64], &f64)| {
            let rest = (ends[1].min(length) - ends[0]).max(0.0);
            let (long, volume) = (rest * (1.0 + strain), rest * wire.bare_area());
            if rest > 0.0 {
                resistivity * long * long / volume
            } else {
                0.0
            }
        };
        edges.map(of).sum()
    };
    let expected = stretched(o.wire_length);
    assert!(expected > 1.02 * unstretched(o.wire_length), "{expected}");
    assert!(
        (o.wire_resistance / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        o.wire_resistance
    );
    let product = run.product();
    assert!(product.wire_length_m > 0.03 && product.wire_length_m < o.wire_length);
    let expected = stretched(product.wire_length_m);
    assert!(
        (product.resistance_ohm / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        product.resistance_ohm
    );
}

/// Inertia and resistance are those of wire laid on a circle.
#[test]
fn the_coil_has_the_inertia_and_resistance_of_its_wire() {
    let mut run = on_a_cylinder(&[]);
    let o = *run.outputs();
    let wire = run.scene().wire.clone();
    let section = 0.25 * std::f64::consts::PI * wire.diameter * wire.diameter;
    let resistance = o.wire_length * section.recip() / 58e6;
    assert!((o.wire_resistance / resistance - 1.0).abs() < 1e-9);
    let radius = 0.01 + 0.5 * wire.diameter;
    let settled = run.product().wire_length_m;
    let inertia = wire.density * section * settled * radius * radius;
    assert!(settled > 0.03, "{settled}");
    assert!(
        (o.coil_inertia / inertia - 1.0).abs() < 0.03,
        "{} {inertia}",
        o.coil_inertia
    );
    assert!((o.layon_x.hypot(o.layon_z) / radius - 1.0).abs() < 0.01);
    assert!((o.turn_in_layer - o.turns_wound).abs() < 1e-12);
    let half = 0.5 * 0.06;
    assert!(o.flange_clearance > 0.0 && o.flange_clearance < half);
    // at a constant speed nothing speeds the coil up
    run.advance(run.inputs(), 1e-3).expect("goes on");
    let o = run.outputs();
    assert_eq!(o.spindle_torque_total, o.spindle_torque);
    // and raised evenly it takes the moment of its inertia
    let rates = Inputs {
        spindle_speed: 4000.0,
        ..Inputs::HELD
    };
    run.advance_ramped(run.inputs(), rates, 1e-3)
        .expect("goes on");
    let o = run.outputs();
    let extra = o.spindle_torque - o.spindle_torque_total;
    assert!(
        (extra / (4000.0 * o.coil_inertia) - 1.0).abs() < 1e-9,
        "{extra:e}"
    );
}

/// Metal in the whole outer section made enamelled wire too heavy by 17 to 45 %.
#[test]
fn enamel_weighs_what_it_weighs() {
    let run = on_a_cylinder(&[("wire.enamelled_diameter", "0.8e-3")]);
    let radius = 0.01 + 0.4e-3;
    let inertia = run.product().wire_mass_kg * radius * radius;
    let told = run.outputs().coil_inertia;
    assert!((told / inertia - 1.0).abs() < 0.03, "{told} {inertia}");
}

/// Limits tuned while the core stood raised a flag with a count of none, or left a count without a flag.
#[test]
fn tuned_limits_count_at_once() {
    let mut run = on_a_cylinder(&[("traverse.per_turn", "0.73e-3"), ("spindle.turns", "4")]);
    let stand = Inputs {
        spindle_speed: 0.0,
        ..run.inputs()
    };
    run.step_beyond(true);
    for _ in 0..300 {
        run.advance(stand, 1e-3).expect("comes to rest");
    }
    let told = |run: &mut Simulation, gap: f64| {
        let mut scene = run.scene().clone();
        scene.defects.gap = gap;
        run.retune(&scene).expect("nothing is owed");
        let o = run.outputs();
        assert!(o.defect_count_gap > 0 || !o.defect_gap, "{o:?}");
        run.advance(stand, 1e-3).expect("goes on");
        let o = run.outputs();
        assert!(o.defect_count >= o.defect_count_gap, "{o:?}");
        (o.defect_gap, o.defect_count_gap > 0)
    };
    assert_eq!(told(&mut run, 5.0), (false, false));
    assert_eq!(told(&mut run, 0.01), (true, true));
    assert_eq!(told(&mut run, 5.0), (false, false));
}

/// The tension fell to nothing in the step of a break, and the least of that step was what broke the wire.
#[test]
fn a_break_is_within_the_extremes_of_its_step() {
    for step in [5e-5, 2e-4, 7e-4, 2e-3] {
        let mut run = Simulation::new(&fig8(&[("spindle.speed", "60")])).expect("starts");
        run.step_beyond(true);
        run.advance_profile(0.03).expect("goes on");
        let pulled = Inputs {
            tension_setpoint: 100.0,
            ..run.inputs()
        };
        while !run.outputs().defect_break {
            run.advance(pulled, step).expect("goes on");
            let o = run.outputs();
            let within = o.wire_tension_min..=o.wire_tension_max;
            assert!(within.contains(&o.wire_tension), "{step}: {within:?}");
        }
    }
}

#[test]
fn a_break_tells_where_the_wire_parted() {
    let mut run = Simulation::new(&fig8(&[])).expect("starts");
    assert_eq!(run.outputs().break_position, 0.0);
    let pulled = Inputs {
        tension_setpoint: 1e3,
        ..run.inputs()
    };
    for _ in 0..20 {
        run.advance(pulled, 1e-3).expect("goes on");
    }
    let o = run.outputs();
    assert!(o.defect_break);
    assert!(
        o.break_position > 0.0 && o.break_position < 0.2,
        "{}",
        o.break_position
    );
}

/// A break at the clamp told the place 0, as whole wire does, and the wire kept its tension.
#[test]
fn wire_that_parts_at_the_clamp_tells_a_place_and_pulls_no_more() {
    let mut run = Simulation::new(&fig8(&[])).expect("starts");
    let pulled = Inputs {
        tension_setpoint: 1e3,
        ..run.inputs()
    };
    while !run.outputs().defect_break {
        run.advance(pulled, 1e-5).expect("goes on");
    }
    let (o, wire) = (run.outputs(), run.centreline());
    let after = wire.arc.partition_point(|arc| *arc <= o.break_position);
    let between = wire.arc[after - 1] + wire.arc[after];
    assert!((o.break_position - 0.5 * between).abs() < 1e-12);
    // the edge that parted begins at the node before the break
    assert!(wire.tension[after - 1..].iter().all(|t| *t == 0.0));
}

/// The history says that nothing pulls at the nozzle, and so do `coil.vtp` and the frames.
#[test]
fn wire_that_parted_carries_no_tension_from_there_on() {
    let mut run = Simulation::new(&fig8(&[("spindle.speed", "60")])).expect("starts");
    run.advance_profile(0.05).expect("goes on");
    let pulled = Inputs {
        tension_setpoint: 200.0,
        ..run.inputs()
    };
    let mut before = run.centreline();
    while !run.outputs().defect_break {
        before = run.centreline();
        run.advance(pulled, 5e-5).expect("goes on");
    }
    assert!(before.tension.iter().all(|t| *t > 0.0));
    for _ in 0..2 {
        let (o, wire) = (*run.outputs(), run.centreline());
        let laid = wire.arc.partition_point(|arc| *arc < o.break_position);
        assert!(laid > wire.frozen && laid < wire.arc.len() - 2, "{laid}");
        assert!(wire.tension[laid..].iter().all(|t| *t == 0.0));
        // What lies on the core before that place stays as it was laid.
        assert!(wire.tension[..wire.frozen].iter().all(|t| *t > 1.0));
        run.advance(pulled, 1e-3).expect("goes on");
        assert_eq!(run.outputs().wire_tension, 0.0);
        // the place of the last lay-on goes round with the core
        let (one, other) = (&o, run.outputs());
        let turned = |o: &Outputs| o.layon_x.atan2(o.layon_z) - o.spindle_angle;
        assert!((turned(one) - turned(other)).abs() < 1e-9);
        assert!(other.spindle_angle > one.spindle_angle + 0.05);
    }
}

/// A damper that the machine adds is one that the scene has.
#[test]
fn a_damper_from_outside_is_a_damper_of_the_scene() {
    let wound = |scene: &str, outside: f64| {
        let changes = [("tensioner.damping", scene), ("spindle.speed", "100")];
        let mut run = Simulation::new(&fig8(&changes)).expect("starts");
        run.step_beyond(true);
        for k in 0..40 {
            let now = Inputs {
                spindle_speed: (10.0 * f64::from(k)).min(100.0),
                tensioner_damping: outside,
                ..run.inputs()
            };
            run.advance(now, 1e-3).expect("goes on");
        }
        assert_eq!(run.inputs().tensioner_damping, outside);
        *run.outputs()
    };
    let (scene, outside, both) = (wound("3", 0.0), wound("0", 3.0), wound("1", 2.0));
    assert!(scene.wire_tension > 15.5, "{}", scene.wire_tension);
    for other in [outside, both] {
        let apart = (other.wire_tension - scene.wire_tension).abs();
        assert!(apart < 0.05, "{apart}");
        assert!((other.fed_length - scene.fed_length).abs() < 1e-5);
    }
}

/// A place that was measured where a step begins has the nozzle a step late, unless it is told so.
#[test]
fn a_nozzle_measured_at_the_start_of_a_step_is_as_late_as_the_page_says() {
    let step = 1e-3;
    // place of a carriage over time, its rate, and the largest lag allowed at the end of a step
    let even: [fn(f64) -> f64; 2] = [|t| 0.1 * t, |_| 0.1];
    let faster: [fn(f64) -> f64; 2] = [|t| 5.0 * t * t, |t| 10.0 * t];
    let lag = |at_start: &str, [place, rate]: [fn(f64) -> f64; 2], with_rate: bool| {
        let mut run =
            Simulation::new(&fig8(&[("nozzle.position_at_start", at_start)])).expect("starts");
        let start = run.inputs();
        let mut most = 0.0_f64;
        for k in 0..20 {
            let time = f64::from(k) * step;
            let now = Inputs {
                nozzle_position: start.nozzle_position + place(time),
                ..start
            };
            let rates = Inputs {
                nozzle_position: if with_rate { rate(time) } else { 0.0 },
                ..Inputs::HELD
            };
            run.advance_ramped(now, rates, step).expect("goes on");
            if k > 1 {
                let is = run.outputs().nozzle_y - start.nozzle_position;
                most = most.max((is - place(time + step)).abs());
            }
        }
        most
    };
    let close = |got: f64, want: f64| assert!((got - want).abs() < 1e-9, "{got} {want}");
    close(lag("false", even, false), 0.1 * step);
    close(lag("true", even, false), 0.0);
    close(lag("false", even, true), 0.0);
    close(lag("true", even, true), 0.0);
    // speeding up: v dt, a dt^2, a dt^2 / 2
    close(
        lag("false", faster, false),
        5.0 * (0.02_f64.powi(2) - 0.019_f64.powi(2)),
    );
    close(lag("true", faster, false), 10.0 * step * step);
    close(lag("false", faster, true), 5.0 * step * step);
}

/// A carriage that has stopped says so by a derivative of 0. It counted as none, and the nozzle went on for a step.
#[test]
fn a_carriage_that_is_told_to_stand_stands() {
    let step = 1e-3;
    let mut run = Simulation::new(&fig8(&[("nozzle.position_at_start", "true")])).expect("starts");
    let start = run.inputs();
    for k in 0..10_u32 {
        let now = Inputs {
            nozzle_position: start.nozzle_position + 0.1 * step * f64::from(k.min(5)),
            ..start
        };
        let rates = Inputs {
            nozzle_position: if k < 5 { 0.1 } else { Inputs::STILL },
            ..Inputs::HELD
        };
        run.advance_ramped(now, rates, step).expect("goes on");
        let is = run.outputs().nozzle_y - start.nozzle_position;
        let meant = 0.1 * step * f64::from((k + 1).min(5));
        assert!((is - meant).abs() < 1e-12, "step {k}: {is} m, {meant} m");
    }
}

/// With inertia in the line and a pulley, a run goes on from its bytes as if it had not stopped.
#[test]
fn a_chain_behind_the_nozzle_is_saved_and_goes_on_to_the_bit() {
    let scene = fig8(&[
        ("tensioner.line_inertia", "true"),
        ("tensioner.pulley_mass", "2e-3"),
        ("tensioner.pulley_friction", "2"),
        ("tensioner.pulley_place", "0.3"),
    ]);
    let at_rest = Inputs {
        tension_setpoint: scene.tensioner.tension,
        nozzle_position: scene.nozzle_law.start(),
        ..Inputs::HELD
    };
    let mut run = Simulation::starting_with(&scene, at_rest).expect("starts");
    assert!((run.outputs().wire_tension - 15.0).abs() < 1e-6);
    let wind = |run: &mut Simulation, from: u32, to: u32| {
        for k in from..to {
            let now = Inputs {
                spindle_speed: (4.0 * f64::from(k)).min(100.0),
                ..at_rest
            };
            run.advance(now, 1e-3).expect("goes on");
        }
    };
    wind(&mut run, 0, 40);
    let bytes = run.to_bytes().expect("bytes");
    let mut again = Simulation::from_bytes(&scene, &bytes).expect("a state");
    wind(&mut run, 40, 70);
    wind(&mut again, 40, 70);
    assert_eq!(run.outputs(), again.outputs());
    let mean = run.outputs().wire_tension;
    assert!(
        run.outputs().fed_length > 0.05 && mean > 5.0 && mean < 40.0,
        "{mean}"
    );
}

/// A line with mass kept in mind the tension at the nozzle, and got longer by that in its span: in short steps again and again under the
/// same pull, or hardly at all.
#[test]
fn a_line_with_mass_yields_as_much_in_short_steps() {
    let scene = fig8(&[
        ("wire.material", "copper"),
        ("tensioner.line_inertia", "true"),
        ("tensioner.mass", "2e-3"),
        ("solver.steps_beyond", "off"),
    ]);
    let stretched = |step: f64| {
        let mut inputs = Inputs {
            tension_setpoint: 30.0,
            nozzle_position: scene.nozzle_law.start(),
            spindle_speed: 100.0,
            ..Inputs::HELD
        };
        let mut run = Simulation::starting_with(&scene, inputs).expect("starts");
        for k in 0..(14e-3 / step) as u32 {
            // (it yields at 38.5 N)
            inputs.tension_setpoint = (30.0 + 2e3 * step * f64::from(k)).min(43.0);
            run.advance(inputs, step).expect("goes on");
        }
        let o = run.outputs();
        o.fed_length - o.tensioner_position
    };
    let found = [40e-6, 10e-6, 4e-6].map(stretched);
    assert!((found[2] / found[0] - 1.0).abs() < 0.02, "{found:?}");
}

#[test]
fn a_chain_where_it_cannot_be_is_refused_with_what_is_lacking() {
    use coilwind::settings::SceneSettings;
    for (changes, key, why) in [
        (
            vec![
                ("tensioner.pulley_mass", "1e-3"),
                ("solver.integrator", "rk4"),
            ],
            "tensioner.pulley_mass",
            "explicit",
        ),
        (
            vec![("tensioner.pulley_friction", "1"), ("tensioner.mass", "0")],
            "tensioner.pulley_friction",
            "tensioner.mass",
        ),
        (
            vec![
                ("tensioner.line_inertia", "true"),
                ("tensioner.line_length", "0"),
            ],
            "tensioner.line_inertia",
            "line_length",
        ),
    ] {
        let mut settings = SceneSettings::load("fig8").expect("packed");
        for (name, value) in changes {
            settings.set_text(name, value).expect(name);
        }
        let error = settings.build().expect_err(key).to_string();
        assert!(error.contains(key) && error.contains(why), "{error}");
    }
    let mut settings = SceneSettings::load("fig8").expect("packed");
    let error = settings
        .set_text("tensioner.pulley_mass", "-1e-3")
        .expect_err("negative");
    assert!(error.to_string().contains("0 to 100 kg"), "{error}");
}
