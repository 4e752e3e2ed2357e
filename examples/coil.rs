//! A coil from a scene: half the size of Fig. 8 in every length, wound by the scene's own motion.
//!
//! `cargo run --example coil [FOLDER]` prints the verdict of each turn and writes `coil.png` into the folder
//! (`target/coil` by default).

use coilwind::output::Snapshot;
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::error::Error;
use std::path::PathBuf;

/// Time between looks at the events, s.
const STEP: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    let folder = folder.map_or_else(|| PathBuf::from("target/coil"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;

    let mut settings = SceneSettings::load("fig8")?;
    for (name, value) in [
        ("wire.material", "copper"),
        ("wire.diameter_mm", "0.35"),
        ("core.width_x_mm", "6"),
        ("core.height_z_mm", "15"),
        ("core.length_y_mm", "15"),
        ("core.corner_radius_mm", "1"),
        ("nozzle.distance_mm", "30"),
        // A quarter of the section carries a quarter of the pull.
        ("tensioner.tension", "3.75"),
        ("traverse.per_turn_mm", "0.36"),
        ("spindle.speed", "100"),
        ("spindle.turns", "6"),
    ] {
        settings.set_text(name, value)?;
    }
    let scene = settings.build()?;
    let mut sim = Simulation::new(&scene)?;
    let end = sim.motion_profile().end();
    while sim.time() < end {
        let left = end - sim.time();
        sim.advance_profile(left.min(STEP))?;
        for event in sim.drain_events() {
            println!("{event}");
        }
    }

    println!("turn  verdict    settled  largest gap/mm  largest bulge/mm");
    let coil = sim.coil();
    for turn in coil.turns() {
        println!(
            "{:4}  {:<9}  {:5.0} %  {:14.3}  {:16.3}",
            turn.turn,
            turn.verdict,
            100.0 * turn.settled,
            1e3 * turn.gap_max.unwrap_or(0.0),
            1e3 * turn.bulge_max,
        );
    }
    println!("the coil: {}", coil.verdict());
    Snapshot::new(&sim)?.write(&folder.join("coil"), &sim)?;
    Ok(())
}
