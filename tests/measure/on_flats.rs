//! Layers on a core with flat faces, whose first layer stands off them: the layers above follow its bow.

use crate::coils::{D, PULL, spec, wound};
use coilwind::math::V3;
use coilwind::measure::{Coil, CoilSpec, Profile, SettledNode};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Half of the flats of the core along x and z, and the radius of its corners, m.
const FLAT: [f64; 2] = [3e-3, 19e-3];
const CORNER: f64 = 1e-3;
/// Turns of a layer.
const TURNS: f64 = 4.0;
/// Height of the first layer over the middle of the long faces, m.
const BOW: f64 = 0.6 * D;

/// Place on the core's flank after so much of its perimeter (m) from +x on, its outward normal, and the height of the first layer
/// there, m.
fn flank(way: f64) -> (V3, V3, f64) {
    let [x, z] = FLAT;
    let corner = CORNER * FRAC_PI_2;
    let quarters = [
        [z, corner, x],
        [x, corner, z],
        [z, corner, x],
        [x, corner, z],
    ];
    let mut rest = way;
    for (quarter, lengths) in quarters.iter().enumerate() {
        let turned = |angle: f64| {
            let angle = angle + quarter as f64 * FRAC_PI_2;
            V3::new(libm::cos(angle), 0.0, libm::sin(angle))
        };
        let [first, bend, second] = *lengths;
        let (out, along) = (turned(0.0), turned(FRAC_PI_2));
        let bow = |at: f64, half: f64| match half == z {
            true => BOW * (1.0 - (at / half) * (at / half)),
            false => 0.0,
        };
        let centre = out * second + along * first;
        if rest <= first {
            return (
                out * (second + CORNER) + along * rest,
                out,
                bow(rest, first),
            );
        }
        rest -= first;
        if rest <= bend {
            let normal = turned(rest / CORNER);
            return (centre + normal * CORNER, normal, 0.0);
        }
        rest -= bend;
        if rest <= second {
            let at = second - rest;
            return (out * at + along * (first + CORNER), along, bow(at, second));
        }
        rest -= second;
    }
    flank(rest)
}

fn perimeter() -> f64 {
    4.0 * (FLAT[0] + FLAT[1]) + CORNER * TAU
}

/// Three layers in grooves, of which the wire from the second turn of the third on stands `off` (m) over its groove, and the third
/// is laid with this `pull` (N). A loop at rest stands [`BOW`] off the core.
fn three_layers(off: f64, pull: f64) -> Coil {
    let groove = D * 0.75_f64.sqrt();
    let step = 0.1e-3;
    let whole = perimeter();
    let nodes: Vec<SettledNode> = (0..(3.0 * TURNS * whole / step) as usize)
        .map(|node| {
            let way = node as f64 * step;
            let turn = (way / whole).floor();
            let (foot, normal, bow) = flank(way - turn * whole);
            let layer = (turn / TURNS).floor();
            let in_layer = turn - layer * TURNS;
            let y = match layer as u32 % 2 {
                0 => in_layer,
                _ => TURNS - 1.5 - in_layer,
            };
            let off = if turn > 2.0 * TURNS { off } else { 0.0 };
            let height = bow + layer * groove + off;
            SettledNode {
                position: foot + normal * (0.5 * D + height) + V3::new(0.0, D * y, 0.0),
                arc: way,
                height,
                flange: None,
                plastic_strain: 0.0,
                tension: if layer == 2.0 { pull } else { PULL },
                time: way,
            }
        })
        .collect();
    let spec = CoilSpec {
        profile: Profile::new(vec![BOW]),
        ..spec()
    };
    let mut coil = wound(spec, &nodes);
    coil.begin_pass(TURNS * TAU, -1.0);
    coil.begin_pass(2.0 * TURNS * TAU, 1.0);
    coil
}

/// Heights were compared at one polar angle: bulges of upper layers were too low by up to a quarter of a diameter at the ends of flats.
#[test]
fn a_bulge_at_the_end_of_a_flat_is_as_high_as_in_its_middle() {
    for off in [0.0, 0.5 * D] {
        let coil = three_layers(off, PULL);
        // the second and third turn of the third layer, which lie on two turns all round
        let first = (2.0 * TURNS) as usize + 1;
        let stations: Vec<_> = coil.stations().collect();
        for station in &stations[first * 360 + 20..(first + 1) * 360 - 20] {
            assert!(
                (station.bulge - off).abs() < 0.02 * D,
                "{} instead of {} at {} deg",
                station.bulge / D,
                off / D,
                station.angle.to_degrees() % 360.0
            );
        }
    }
}

/// Layers wound ever looser, as is usual, stand as far off the layers below as they do at rest: they were told as loose turns.
#[test]
fn a_layer_that_is_meant_to_be_looser_has_no_loose_turns() {
    let share = 0.6_f64;
    let off = BOW * (share.sqrt().recip() - 1.0);
    let loose = |pull: f64| three_layers(off, pull).flags().loose_turn;
    assert!(off > 0.15 * D && loose(PULL), "{}", off / D);
    assert!(!loose(share * PULL));
    // less than half of what was meant is loose all the same
    assert!(loose(0.4 * PULL));
}
