//! A nozzle that inputs send aside while wire is wound, in communication steps of any length.

use coilwind::measure::DefectKind;
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

const SPEED: f64 = 60.0;

/// `fig8` at this speed, whose nozzle goes outwards by `out` and up by `up`, m/s, in steps of `dt`, s, for `time`, s.
fn wound([out, up]: [f64; 2], dt: f64, time: f64, beyond: bool) -> Simulation {
    let settings = SceneSettings::load("fig8").expect("packed");
    let scene = settings.build().expect("a scene");
    let start = Inputs {
        spindle_speed: SPEED,
        ..scene.start_inputs()
    };
    let mut sim = Simulation::starting_with(&scene, start).expect("starts");
    sim.step_beyond(beyond);
    for k in 1..=(time / dt).round() as u32 {
        let end = f64::from(k) * dt;
        let inputs = Inputs {
            nozzle_position: 0.7e-3 * SPEED * end / TAU,
            nozzle_offset_x: out * end,
            nozzle_offset_z: up * end,
            ..start
        };
        sim.advance(inputs, dt).expect("goes on");
    }
    sim
}

/// Each communication point ended a step, and a coil cost what its communication steps cost.
#[test]
fn an_even_way_aside_takes_no_step_of_its_own() {
    let way = [0.02, -0.05];
    let long = wound(way, 1e-3, 0.12, true);
    let short = wound(way, 2e-5, 0.12, true);
    let [of_long, of_short] = [&long, &short].map(|sim| sim.statistics().steps);
    println!("{of_long} {of_short}");
    assert!(10 * of_short < 12 * of_long, "{of_short} for {of_long}");
    let there = short.caught_up().expect("goes on");
    let nozzle = there.system().state.support[1].point;
    let distance = long.scene().nozzle.distance;
    assert!(
        (nozzle.x - distance - 0.02 * 0.12).abs() < 1e-12,
        "{nozzle}"
    );
    assert!((nozzle.z + 0.05 * 0.12).abs() < 1e-12, "{nozzle}");
    let off = long.outputs().fed_length - short.outputs().fed_length;
    assert!(off.abs() < 2e-6, "{off:e} m");
    // and it is the coil of steps that end at the communication points, but for a hundredth of a diameter
    let twin = wound(way, 1e-4, 0.12, false);
    let off = twin.outputs().fed_length - short.outputs().fed_length;
    assert!(off.abs() < 7e-6, "{off:e} m");
}

/// A way of less than a thousandth of the tolerance a communication step was left out, however many there were.
#[test]
fn a_nozzle_that_creeps_aside_gets_there() {
    let sim = wound([0.0, 1e-4], 1e-5, 0.02, true);
    let nozzle = sim.caught_up().expect("goes on").system().state.support[1].point;
    assert!((nozzle.z - 2e-6).abs() < 1e-15, "{nozzle}");
    let there = sim.inputs().nozzle_offset_z;
    assert!((there - 2e-6).abs() < 1e-15, "{there}");
}

/// No step looks ahead into the core.
#[test]
fn a_nozzle_on_its_way_into_the_core_meets_it_when_it_gets_there() {
    let met = |dt: f64, beyond: bool| {
        let sim = wound([-0.6, 0.0], dt, 0.1, beyond);
        let defects = sim.defects();
        let [collision] = &defects[..] else {
            panic!("one collision: {defects:?}");
        };
        assert_eq!(collision.kind, DefectKind::Collision);
        collision.time_s
    };
    // (the coil is looked for at the ends of steps, which are shorter than this)
    let step = 2e-4;
    let twin = met(1e-5, false);
    for dt in [1e-3, 1e-4, 2e-5] {
        let time = met(dt, true);
        assert!((0.0..step).contains(&(time - twin)), "{time} for {twin}");
    }
}
