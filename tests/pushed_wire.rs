//! Wire at rest that the next turn pushes along the core: it moves where friction does not hold it.

use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::path::Path;

/// Half a millimetre of copper in turns laid back against each other, of which the nozzle leads none; friction, and how much stays live, m.
fn laid_back(friction: f64, keep: Option<f64>) -> Simulation {
    let text = format!(
        "[wire]\ndiameter_mm = 0.5\n[core]\nshape = 'cylinder'\nradius_mm = 6\nlength_y_mm = 30\n[nozzle]\ndistance_mm = 40\n\
         [tensioner]\ntension = 12\n[spindle]\nspeed = 60\nturns = 8\n[traverse]\nper_turn_mm = 0.35\nlead_mm = 0\n\
         [friction]\nstatic = {friction}\nkinetic = {friction}\n"
    );
    let mut settings =
        SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
    if let Some(keep) = keep {
        settings.freeze.keep_length = keep;
    }
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("it starts");
    let end = sim.motion_profile().end();
    while sim.time() < end {
        let left = end - sim.time();
        sim.advance_profile(left.min(1e-3)).expect("goes on");
    }
    sim
}

/// Mean gaps of turns from the second on, diameters.
fn gaps(sim: &Simulation) -> Vec<f64> {
    let turns = sim.coil().turns();
    let gaps = turns.iter().skip(1).filter_map(|turn| turn.gap_mean);
    gaps.map(|gap| gap / 0.5e-3).collect()
}

/// Frozen turns kept their gaps, 0.045 d at the sixth turn and 0.11 d at the thirteenth. With all wire live they close.
#[test]
fn turns_that_lean_on_each_other_close_their_gaps() {
    let (frozen, live) = (
        gaps(&laid_back(0.05, None)),
        gaps(&laid_back(0.05, Some(0.12))),
    );
    assert!(frozen.len() >= 5 && live.len() >= 3, "{frozen:?} {live:?}");
    assert!(frozen[4] < 0.025, "{frozen:?}");
    for (turn, (a, b)) in frozen.iter().zip(&live).enumerate() {
        assert!(
            (a - b).abs() < 0.006,
            "turn {}: {a} d, all live {b} d",
            turn + 2
        );
    }
}

/// Where friction holds the turns, nothing thaws.
#[test]
fn turns_that_friction_holds_stay_at_rest() {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    settings.set_text("spindle.turns", "3").expect("valid");
    settings.set_text("friction.static", "0.5").expect("valid");
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("it starts");
    let end = sim.motion_profile().end();
    let mut most = 0;
    while sim.time() < end {
        let left = end - sim.time();
        sim.advance_profile(left.min(1e-3)).expect("goes on");
        let frozen = sim.system().state.frozen_pulls.len();
        assert!(frozen >= most, "{frozen} of {most} frozen edges");
        most = frozen;
    }
    assert!(most > 50);
}
