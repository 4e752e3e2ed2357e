//! Wire at rest whose tension changes later: it slips along itself as far as friction lets it.

use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;
use std::path::Path;

/// Where a pull changes, in turns, and what it is before and after that, N.
#[derive(Clone, Copy)]
struct Change {
    turn: f64,
    pulls: [f64; 2],
}

/// Core, friction, advance a turn, m, and speed, rad/s.
#[derive(Clone, Copy)]
struct Wound<'a> {
    core: &'a str,
    friction: f64,
    per_turn: f64,
    speed: f64,
    turns: f64,
}

/// Turns far enough apart not to touch, on a round core.
const ROUND: Wound = Wound {
    core: "shape = 'cylinder'\nradius_mm = 10\nlength_y_mm = 40",
    friction: 0.05,
    per_turn: 0.91e-3,
    speed: 50.0,
    turns: 6.2,
};

/// Winds 0.7 mm copper while the pull goes over from one value to the other within a radian.
fn wind(wound: Wound, change: Change, keep: Option<f64>) -> Simulation {
    let Wound { core, friction, .. } = wound;
    let text = format!(
        "[core]\n{core}\n[nozzle]\ny_start_mm = -8\n[start]\nclamp_y_mm = -8\n[spindle]\nspeed = {}\n[tensioner]\ntension = {}\n\
         [friction]\nstatic = {friction}\nkinetic = {friction}\n",
        wound.speed,
        change.pulls[0].max(change.pulls[1]),
    );
    let mut settings =
        SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
    if let Some(keep) = keep {
        settings.freeze.keep_length = keep;
    }
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("it starts");
    let (step, start) = (0.03 / wound.speed, sim.inputs().nozzle_position);
    let mut turned = 0.0;
    while turned < wound.turns * TAU {
        let speed = wound.speed * (turned / 1.0 + 0.03).min(1.0);
        turned += speed * step;
        let share = (turned - change.turn * TAU).clamp(0.0, 1.0);
        let [before, after] = change.pulls;
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: start + wound.per_turn * turned / TAU,
            tension_setpoint: before + (after - before) * share,
            ..Inputs::HELD
        };
        sim.advance(inputs, step).expect("it goes on");
    }
    sim
}

/// Angle along the wire, rad, and tension of each frozen edge.
fn tensions(sim: &Simulation) -> Vec<[f64; 2]> {
    let state = &sim.system().state;
    let points = &state.frozen.points;
    let mut angle = 0.0;
    let mut along = Vec::new();
    for (i, pull) in state.frozen_pulls.iter().enumerate() {
        along.push([angle, pull.tension]);
        if let Some(next) = points.get(i + 1) {
            let turn = |p: &coilwind::math::V3| p.z.atan2(p.x);
            let way = turn(next) - turn(&points[i]);
            angle += (way - (way / TAU).round() * TAU).abs();
        }
    }
    along
}

fn mean_of_turn(sim: &Simulation, turn: usize) -> f64 {
    let within = |[angle, _]: &&[f64; 2]| (angle / TAU) as usize + 1 == turn;
    let all = tensions(sim);
    let own: Vec<f64> = all
        .iter()
        .filter(within)
        .map(|[_, tension]| *tension)
        .collect();
    own.iter().sum::<f64>() / own.len() as f64
}

/// Frozen wire kept 15 N beside 4 N: a ratio of 3.7 over two radians where friction holds 1.1. Three turns that were loose had no verdict.
#[test]
fn a_pull_that_falls_reaches_the_turns_before_as_friction_has_it() {
    let change = Change {
        turn: 4.5,
        pulls: [15.0, 4.0],
    };
    let sim = wind(ROUND, change, None);
    let all = tensions(&sim);
    let at = |angle: f64| all.iter().find(|[a, _]| *a > angle).expect("frozen wire")[1];
    for turn in 1..4 {
        let angle = f64::from(turn) * TAU;
        let ratio = at(angle) / at(angle + TAU);
        let exact = (ROUND.friction * TAU).exp();
        assert!(
            (ratio / exact - 1.0).abs() < 0.03,
            "turn {turn}: {ratio}, {exact}"
        );
    }
    let live = wind(ROUND, change, Some(0.6));
    let rod = &live.system().state.rod;
    assert!(rod.rest.iter().sum::<f64>() > 0.35, "all of it is live");
    // (the first turn of the live wire is at the clamp; its fourth lies where the fourth does here)
    let spin = |i: usize| rod.x[i].z.atan2(rod.x[i].x);
    let (mut angle, mut sum, mut count) = (0.0, 0.0, 0.0);
    for i in 0..rod.edges() {
        if (3.0 * TAU..4.0 * TAU).contains(&angle) {
            (sum, count) = (sum + live.system().state.load.tension[i], count + 1.0);
        }
        let way = spin(i + 1) - spin(i);
        angle += (way - (way / TAU).round() * TAU).abs();
    }
    let (frozen, live) = (mean_of_turn(&sim, 4), sum / count);
    assert!(
        (frozen / live - 1.0).abs() < 0.05,
        "{frozen} N, all live {live} N"
    );
    let loose: Vec<u32> = sim.coil().defects().iter().map(|d| d.turn).collect();
    assert!(!loose.is_empty(), "turns below half the pull are loose");
}

/// More pull goes on into wire at rest as well, and stays behind where the wire is held.
#[test]
fn a_pull_that_rises_reaches_the_turns_before() {
    let change = Change {
        turn: 4.5,
        pulls: [4.0, 15.0],
    };
    let sim = wind(ROUND, change, None);
    let all = tensions(&sim);
    let at = |angle: f64| all.iter().find(|[a, _]| *a > angle).expect("frozen wire")[1];
    for angle in [8.0, 14.0, 20.0] {
        let ratio = at(angle + 4.0) / at(angle);
        let exact = (4.0 * ROUND.friction).exp();
        assert!(
            (ratio / exact - 1.0).abs() < 0.03,
            "{angle}: {ratio}, {exact}"
        );
    }
    let first = mean_of_turn(&sim, 1);
    assert!(first < 5.5, "friction holds the first turn at {first} N");
}

/// A turn of the default wire on the default core was told with 14 N. With all wire live it has 6.4 N, and is loose.
#[test]
fn a_turn_that_becomes_loose_after_it_came_to_rest_is_told() {
    let wound = Wound {
        core: "",
        friction: 0.23,
        per_turn: 0.72e-3,
        speed: 60.0,
        turns: 3.5,
    };
    let change = Change {
        turn: 1.2,
        pulls: [15.0, 1.5],
    };
    let sim = wind(wound, change, None);
    let first = mean_of_turn(&sim, 1);
    assert!(first > 5.0 && first < 8.5, "{first} N");
    let defects = sim.coil().defects();
    let loose = defects
        .iter()
        .find(|d| d.kind == coilwind::measure::DefectKind::LooseTurn);
    assert!(loose.is_some_and(|d| d.turn <= 2), "{defects:?}");
}

/// Single nodes held up to 0.4 N for good, wherever the tension had jumped by more than their friction as they froze.
#[test]
fn hardly_any_friction_holds_hardly_anything() {
    let wound = Wound {
        friction: 0.003,
        speed: 30.0,
        turns: 4.2,
        ..ROUND
    };
    let change = Change {
        turn: 2.5,
        pulls: [15.0, 4.0],
    };
    // with all wire live, 3.98 N
    let first = mean_of_turn(&wind(wound, change, None), 1);
    assert!(first > 3.8 && first < 4.6, "{first} N");
}

/// Two walls of a groove press more than the tension asks for. Stiffness was held to do so, and the second layer kept 12.3 N.
#[test]
fn wire_in_grooves_slips_too() {
    let text = "[core]\nshape = 'cylinder'\nradius_mm = 8\nlength_y_mm = 30\nflange.inner_distance_mm = 3.1594\nflange.height_mm = 4\n\
                [friction]\nstatic = 0.05\nkinetic = 0.05\n[nozzle]\ndistance_mm = 25\n[tensioner]\ntension = 15\n\
                [winding]\nlayers = 2\nturns_per_layer = 4\n[traverse]\nadvance_deg = 90\nmode = 'orthocyclic'\n";
    let settings = SceneSettings::from_toml_str(text, "scene.toml", Path::new("")).expect("reads");
    let scene = settings.build().expect("a scene");
    let start = scene.start_inputs();
    let mut sim = Simulation::starting_by_law(&scene, start).expect("it starts");
    let (speed, step) = (60.0, 5e-4);
    let mut turned = 0.0;
    while turned < 8.0 * TAU {
        let now = speed * (turned + 0.03_f64).min(1.0);
        turned += now * step;
        let share = (0.5 * (turned - 7.0 * TAU)).clamp(0.0, 1.0);
        let inputs = Inputs {
            spindle_speed: now,
            tension_setpoint: 15.0 - 12.5 * share,
            ..start
        };
        sim.advance(inputs, step).expect("it goes on");
    }
    // with all wire live, 6.9 N
    let fifth = mean_of_turn(&sim, 5);
    assert!(fifth < 10.0, "{fifth} N");
}

/// Wire that slipped brings the tension along that it has then. The energy of a turn that thaws is that of a turn that never froze.
#[test]
fn wire_that_slipped_thaws_with_its_tension() {
    let change = Change {
        turn: 2.5,
        pulls: [15.0, 5.0],
    };
    let sim = wind(
        Wound {
            turns: 3.5,
            ..ROUND
        },
        change,
        None,
    );
    let mut system = sim.system().clone();
    let frozen = system.state.frozen_pulls.len();
    let count = frozen / 2;
    let before: Vec<f64> = (frozen - count..frozen)
        .map(|i| system.state.frozen_pulls[i].tension)
        .collect();
    let slipped = before
        .iter()
        .any(|tension| *tension < 14.0 && *tension > 5.5);
    assert!(slipped, "{before:?}");
    let arc = system.state.arc0 + system.state.rod.rest.iter().sum::<f64>();
    assert_eq!(system.thaw_front(count), count);
    let after = system.state.arc0 + system.state.rod.rest.iter().sum::<f64>();
    assert!((arc - after).abs() < 1e-12 * arc, "{arc} {after}");
    system.refresh();
    for (i, before) in before.iter().enumerate() {
        let now = system.state.load.tension[i];
        assert!((now - before).abs() < 0.02, "edge {i}: {now} N, {before} N");
    }
}
