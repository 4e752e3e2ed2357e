//! A nozzle that leads its wire lays all turns in their grooves. One that lets it trail leaves room between them where they cross.

use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;

/// Turns of each of the three layers.
const TURNS: usize = 8;
/// Polar angles between crossovers, degrees. The law ends one at 60 and begins the next at 280, and wire crosses earlier than it is led.
const STRAIGHT: std::ops::Range<usize> = 60..240;
/// The same in the last turn. The turn before it crosses into its place, and nothing leads it on.
const STRAIGHT_AT_THE_END: std::ops::Range<usize> = 60..180;
/// How far beside its groove a turn lies in place, diameters.
const IN_PLACE: f64 = 0.15;

/// The packed bobbin with eight turns in a layer, and its window narrower by the turns that it lacks.
fn short_bobbin(trail: &str) -> SceneSettings {
    let mut settings = SceneSettings::load("bobbin").expect("packed");
    for (key, value) in [
        ("core.flange.inner_distance", "6.008e-3"),
        ("nozzle.y_start", "-2.654e-3"),
        ("start.clamp_y", "-2.654e-3"),
        ("winding.turns_per_layer", "8"),
        ("winding.layers", "3"),
        ("solver.tolerance", "1e-5"),
        ("traverse.trail", trail),
    ] {
        settings.set_text(key, value).expect("a setting");
    }
    settings
}

fn wound(trail: &str) -> Simulation {
    let mut sim = Simulation::new(&short_bobbin(trail).build().expect("valid")).expect("starts");
    let end = sim.motion_profile().end();
    sim.advance_profile(end).expect("the run goes on");
    sim
}

/// Turns that lie beside their groove between crossovers, from 1, how far (diameters) and where (degrees) most, and defects in all.
fn out_of_place(trail: &str) -> (Vec<(usize, f64, usize)>, usize) {
    let sim = wound(trail);
    let scene = sim.scene();
    let d = scene.wire.diameter;
    let (first, window) = (scene.nozzle.y_start, 6.008e-3);
    let pitch = (window - d) / (TURNS as f64 - 0.5);
    let rise = (d * d - 0.25 * pitch * pitch).sqrt();
    let stations: Vec<_> = sim.coil().stations().collect();
    let mut out = Vec::new();
    for turn in 0..3 * TURNS {
        let (layer, along) = (turn / TURNS, (turn % TURNS) as f64 * pitch);
        let y = match layer % 2 {
            0 => first + along,
            _ => -first - along,
        };
        let place = (y, layer as f64 * rise);
        let straight = match turn + 1 < 3 * TURNS {
            true => STRAIGHT,
            false => STRAIGHT_AT_THE_END,
        };
        let off = straight.map(|degree| {
            let station = stations[360 * turn + degree];
            let aside = (station.position.y - place.0).abs();
            (aside.max((station.height - place.1).abs()) / d, degree)
        });
        let (most, degree) = off.max_by(|a, b| a.0.total_cmp(&b.0)).expect("degrees");
        if most > IN_PLACE {
            out.push((turn + 1, most, degree));
        }
    }
    (out, sim.defects().len())
}

#[test]
fn a_led_wire_lies_in_its_grooves() {
    let (out, defects) = out_of_place("led");
    assert!(out.is_empty(), "{out:?}");
    assert_eq!(defects, 0);
}

/// Its turns leave room beside them where they cross. That is no gap of the winding, but the width of the room shows what leading does.
#[test]
fn a_wire_that_trails_leaves_room_where_it_crosses() {
    // (the widest of each turn on average: that of all turns scatters)
    let room = |trail: &str| -> f64 {
        let sim = wound(trail);
        let mut widest = std::collections::BTreeMap::new();
        for station in sim.coil().stations().filter(|s| s.measured) {
            if let Some(neighbour) = station.neighbour {
                let turn = (station.angle / std::f64::consts::TAU) as usize;
                let most = widest.entry(turn).or_insert(0.0_f64);
                *most = most.max(neighbour.gap);
            }
        }
        widest.values().sum::<f64>() / widest.len() as f64 / sim.scene().wire.diameter
    };
    let (free, led) = (room("free"), room("led"));
    assert!(led < 0.05 && free > 2.0 * led, "{free} and {led}");
}
