//! Machines whose nozzle or spindle goes another way than the scene says: passes, turns and neighbours stay right.

use crate::common::fig8;
use coilwind::measure::{Coil, DefectKind, STATIONS_PER_TURN, Verdict};
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

const PITCH: f64 = 0.714e-3;
const SPEED: f64 = 100.0;
/// Communication step, s.
const STEP: f64 = 5e-4;

fn copper() -> Simulation {
    let changes = [("wire.material", "copper"), ("solver.tolerance_um", "10")];
    Simulation::new(&fig8(&changes)).expect("the scene starts")
}

/// Winds this many turns, `sense` times forwards, with the nozzle at `law` of the turns of the core, in pitches.
fn wind(sim: &mut Simulation, turns: f64, sense: f64, law: impl Fn(f64) -> f64) {
    let ramp = SPEED * SPEED / (0.5 * TAU);
    let mut speed: f64 = 0.0;
    let mut turned = 0.0;
    while turned < turns {
        speed = (speed + ramp * STEP).min(SPEED);
        turned += speed * STEP / TAU;
        let inputs = Inputs {
            spindle_speed: sense * speed,
            nozzle_position: PITCH * law(turned),
            tension_setpoint: 15.0,
            ..Inputs::HELD
        };
        sim.advance(inputs, STEP).expect("the run goes on");
    }
}

fn without_neighbour(coil: &Coil) -> usize {
    coil.stations().filter(|s| s.neighbour.is_none()).count()
}

/// A nozzle that went towards -y by its input made a second pass and a gap of 0.36 mm.
#[test]
fn a_nozzle_towards_minus_y_winds_one_pass() {
    let (mut up, mut down) = (copper(), copper());
    wind(&mut up, 3.5, 1.0, |t| t);
    wind(&mut down, 3.5, 1.0, |t| -t);
    assert_eq!((up.coil().passes(), down.coil().passes()), (1, 1));
    for sim in [&up, &down] {
        assert_eq!(without_neighbour(sim.coil()), STATIONS_PER_TURN);
        assert!(sim.outputs().mean_pitch > 0.0);
    }
    let turns = |sim: &Simulation| sim.turns().iter().map(|t| t.verdict).collect::<Vec<_>>();
    assert_eq!(turns(&up), turns(&down), "the mirror image");
}

/// A spindle that turned backwards from the start wound turns that nobody counted.
#[test]
fn a_spindle_that_turns_backwards_winds_turns() {
    let mut sim = copper();
    wind(&mut sim, 3.5, -1.0, |t| t);
    let o = *sim.outputs();
    assert!(o.turns_wound > 3.0 && o.turns_settled > 2.4, "{o:?}");
    assert!(o.spindle_angle < -3.4 * TAU && o.mean_pitch > 0.9 * PITCH);
    assert_eq!(without_neighbour(sim.coil()), STATIONS_PER_TURN);
    assert_ne!(sim.verdict(), Verdict::Unsettled);
    let bytes = sim.to_bytes().expect("a state");
    let mut again = Simulation::from_bytes(sim.scene(), &bytes).expect("it is read");
    assert_eq!(again.coil(), sim.coil(), "to the bit");
    for sim in [&mut sim, &mut again] {
        wind(sim, 0.5, -1.0, |t| 3.5 + t);
    }
    assert_eq!(again.outputs(), sim.outputs());
}

/// One way back by a pitch labelled wire that was laid long before, and its first turn was compared with its beginning. The
/// nozzle lays turns on its own row, which ride and are double; that is no layer and no gap.
#[test]
fn a_nozzle_that_goes_back_by_a_pitch_once_makes_no_gap() {
    let mut sim = copper();
    let law = |t: f64| match t {
        t if t < 3.0 => t,
        t if t < 4.0 => 6.0 - t,
        t => t - 2.0,
    };
    wind(&mut sim, 6.5, 1.0, law);
    let passes: BTreeSet<_> = sim.coil().stations().map(|station| station.pass).collect();
    assert_eq!(passes.len(), 1, "{passes:?}");
    let defects = sim.defects();
    assert!(
        !defects.iter().any(|d| d.kind == DefectKind::Gap),
        "{defects:?}"
    );
    let told = |kind| {
        defects
            .iter()
            .any(|d| d.kind == kind && (4..=7).contains(&d.turn))
    };
    assert!(
        told(DefectKind::Overlap) && told(DefectKind::DoubleTurn),
        "{defects:?}"
    );
}

/// Two layers: the label is that of the laying, each row's first turn has no neighbour, and a saved state goes on alike.
#[test]
fn two_layers_survive_a_saved_state_at_the_turn() {
    let law = |t: f64| if t < 4.0 { t } else { 8.0 - t };
    let mut sim = copper();
    wind(&mut sim, 4.3, 1.0, law);
    let bytes = sim.to_bytes().expect("a state");
    let mut again = Simulation::from_bytes(sim.scene(), &bytes).expect("it is read");
    for sim in [&mut sim, &mut again] {
        let end = |t: f64| law(4.3 + t);
        wind(sim, 3.0, 1.0, end);
    }
    assert_eq!(again.outputs(), sim.outputs());
    assert_eq!(again.coil(), sim.coil());
    assert_eq!(sim.coil().passes(), 2);
}

/// A nozzle and spindle that go back together and on again leave no pass behind.
#[test]
fn unwinding_and_winding_again_is_one_pass() {
    let mut sim = copper();
    wind(&mut sim, 2.5, 1.0, |t| t);
    wind(&mut sim, 1.5, -1.0, |t| 2.5 - t);
    wind(&mut sim, 2.5, 1.0, |t| 1.0 + t);
    assert_eq!(sim.coil().passes(), 1);
    assert_eq!(without_neighbour(sim.coil()), STATIONS_PER_TURN);
}

/// Wire wound at 1 N where the scene has 15 N stood off by several diameters and was aligned.
#[test]
fn wire_wound_looser_than_the_scene_has_it_bulges() {
    let mut sim = copper();
    let loose = Inputs {
        tension_setpoint: 1.0,
        ..sim.inputs()
    };
    sim.set_start(loose).expect("a start");
    let mut turned = 0.0;
    while turned < 2.5 {
        let speed = 30.0;
        turned += speed * STEP / TAU;
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: PITCH * turned,
            tension_setpoint: 1.0,
            ..Inputs::HELD
        };
        sim.advance(inputs, STEP).expect("the run goes on");
    }
    assert_eq!(sim.verdict(), Verdict::Bulge, "{:?}", sim.defects());
    let most = sim.turns().iter().map(|t| t.bulge_max).fold(0.0, f64::max);
    assert!(most > 1.4e-3, "{most}");
}
