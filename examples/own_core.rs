//! A core of one's own: a flanged bobbin as an STL mesh, wound with four layers of wire.
//!
//! `cargo run --example own_core [FOLDER]` writes `bobbin.stl`, `coil.png`, `coil.vtp` and the tables of a
//! run into the folder (`target/own_core` by default). It prints each layer as it is finished and how well
//! the wire lies in the grooves of the layer below.

use coilwind::math::V3;
use coilwind::output::{CoreMesh, Ending, Picture, Snapshot, render_png, write_results};
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::{Simulation, core_surface};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Wire diameter, m.
const DIAMETER: f64 = 0.7e-3;
/// Distance of neighbouring turns: the wire and a hundredth of it, m.
const PITCH: f64 = 1.01 * DIAMETER;
const TURNS_PER_LAYER: usize = 20;
const LAYERS: usize = 4;

/// Radius of the barrel and of the bore through it, m.
const BARREL: f64 = 8e-3;
const BORE: f64 = 4e-3;
/// Between the flanges: a layer and half a turn, so that each layer lies in the grooves of the one below, m.
const WIDTH: f64 = (TURNS_PER_LAYER as f64 + 0.5) * PITCH;
/// Radius and thickness of the flanges, m.
const FLANGE: [f64; 2] = [12e-3, 1.5e-3];
/// Flat sides of the barrel.
const SIDES: usize = 256;

/// Speed of the spindle, rad/s, and the turns over which it is reached.
const SPEED: f64 = 200.0;
const RAMP_TURNS: f64 = 0.5;
/// Communication step, s.
const STEP: f64 = 5e-4;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    let folder = folder.map_or_else(|| PathBuf::from("target/own_core"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("bobbin.stl"), bobbin())?;

    let scene = settings(&folder)?.build()?;
    let mut sim = Simulation::new(&scene)?;
    let began = Instant::now();
    // A pass from flange to flange.
    let pass = 2.0 * traverse_end() / PITCH;
    let turns = LAYERS as f64 * pass;
    let mut told = 0;
    while sim.outputs().turns_wound < turns {
        sim.advance(inputs_after(&sim, scene.tensioner.tension), STEP)?;
        let layers = (sim.outputs().turns_wound / pass) as usize;
        if layers > told {
            told = layers;
            println!(
                "layer {layers} wound after {:.1} s",
                began.elapsed().as_secs_f64()
            );
        }
    }
    let seconds = began.elapsed().as_secs_f64();
    println!(
        "{turns:.1} turns, {:.3} s simulated in {seconds:.1} s",
        sim.time()
    );
    print_layers(&sim);
    let snapshot = Snapshot::new(&sim)?;
    write_results(&folder, &sim, Some(&snapshot), &Ending::Done, seconds)?;
    picture(&folder.join("coil.png"), &sim)
}

/// The bobbin as ASCII STL in mm: flange, barrel, flange and bore, revolved about y.
fn bobbin() -> String {
    let (inner, outer) = (0.5 * WIDTH, 0.5 * WIDTH + FLANGE[1]);
    let wall = [
        [-outer, BORE],
        [-outer, FLANGE[0]],
        [-inner, FLANGE[0]],
        [-inner, BARREL],
        [inner, BARREL],
        [inner, FLANGE[0]],
        [outer, FLANGE[0]],
        [outer, BORE],
        [-outer, BORE],
    ];
    let point = |[y, r]: [f64; 2], side: usize| {
        let angle = TAU * (side % SIDES) as f64 / SIDES as f64;
        [1e3 * r * angle.cos(), 1e3 * y, 1e3 * r * angle.sin()]
    };
    let mut text = "solid bobbin\n".to_owned();
    let mut facet = |corners: [[f64; 3]; 3]| {
        text += " facet normal 0 0 0\n  outer loop\n";
        for [x, y, z] in corners {
            let _ = writeln!(text, "   vertex {x:.6} {y:.6} {z:.6}");
        }
        text += "  endloop\n endfacet\n";
    };
    for side in 0..SIDES {
        for pair in wall.windows(2) {
            let [a, b] = [point(pair[0], side), point(pair[1], side)];
            let [c, d] = [point(pair[1], side + 1), point(pair[0], side + 1)];
            facet([a, b, c]);
            facet([a, c, d]);
        }
    }
    text + "endsolid bobbin\n"
}

/// The scene: the mesh, thin copper wire clamped beside the lower flange, and a nozzle in front of it.
fn settings(folder: &Path) -> Result<SceneSettings, Box<dyn Error>> {
    let mut settings = SceneSettings::default();
    settings.core.shape = "mesh".to_owned();
    settings.core.file = folder.join("bobbin.stl").display().to_string();
    settings.wire.diameter = DIAMETER;
    settings.start.clamp_y = -traverse_end();
    settings.nozzle.y_start = -traverse_end();
    settings.tensioner.tension = 15.0;
    Ok(settings)
}

/// Where the outermost turn of a layer lies, m.
fn traverse_end() -> f64 {
    0.5 * (WIDTH - DIAMETER)
}

/// Inputs at the end of the next communication step: the spindle speeds up evenly to its speed, the nozzle
/// moves a pitch per turn and reverses at the flanges.
fn inputs_after(sim: &Simulation, tension: f64) -> Inputs {
    let rate = SPEED * SPEED / (2.0 * TAU * RAMP_TURNS);
    let speed = (sim.inputs().spindle_speed + rate * STEP).min(SPEED);
    let angle = sim.outputs().spindle_angle + speed * STEP;
    let way = PITCH * angle / TAU % (4.0 * traverse_end());
    let end = traverse_end();
    Inputs {
        spindle_speed: speed,
        nozzle_position: if way < 2.0 * end {
            way - end
        } else {
            3.0 * end - way
        },
        tension_setpoint: tension,
        ..Inputs::HELD
    }
}

/// How the settled wire lies, layer by layer.
fn print_layers(sim: &Simulation) {
    println!("layer  turns  radius/mm  in the grooves  gaps above 0.15 d  largest gap/d");
    let step = coilwind::measure::STATIONS_PER_TURN as f64;
    for pass in 1..=LAYERS as u32 + 1 {
        let stations = || sim.coil().stations().filter(move |s| s.pass == pass);
        let count = stations().count() as f64;
        if count == 0.0 {
            continue;
        }
        let share = |n: usize| 100.0 * n as f64 / count;
        let gaps = || stations().filter_map(|s| Some(s.neighbour?.gap / DIAMETER));
        println!(
            "{pass:5}  {:5.1}  {:9.3}  {:12.1} %  {:15.1} %  {:13.2}",
            count / step,
            1e3 * stations().map(|s| s.radius()).sum::<f64>() / count,
            share(stations().filter(|s| s.bulge < 0.1 * DIAMETER).count()),
            share(gaps().filter(|gap| *gap > 0.15).count()),
            gaps().fold(0.0, f64::max),
        );
    }
}

/// The coil from beside and a little from above: settled wire is copper, live wire blue.
fn picture(path: &Path, sim: &Simulation) -> Result<(), Box<dyn Error>> {
    let core = core_surface(sim.scene())?;
    let wire = sim.centreline();
    let mesh = CoreMesh {
        vertices: &core.mesh().vertices,
        triangles: &core.mesh().triangles,
    };
    let mut picture = Picture::new(Some(mesh), &wire, 0.5 * DIAMETER);
    picture.from = V3::new(1.0, 0.40, 0.75);
    Ok(render_png(path, &picture)?)
}
