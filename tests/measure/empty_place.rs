//! Places left empty beside the flange where a layer begins.

use crate::coils::{D, on_cylinder, spec, wound};
use coilwind::measure::{Coil, CoilSpec, DefectKind, LayerStart};
use std::f64::consts::TAU;

/// The coil of a turn and a half of wire, its middle at `place` diameters from that of a turn which lies at the flange towards -y. That layer
/// leaves so much room beside the flange by plan, m, if there is one.
fn coil(room: Option<f64>, place: impl Fn(f64) -> f64) -> Coil {
    let start = |room| LayerStart {
        faces: [-0.5 * D, 6.5 * D],
        rim: 2.0 * D,
        room,
    };
    let spec = CoilSpec {
        layer_starts: room.map(start).into_iter().collect(),
        ..spec()
    };
    let nodes = on_cylinder(1.5, 1.0, |angle| (D * place(angle / TAU), 0.0));
    wound(spec, &nodes)
}

fn gaps(coil: &Coil) -> Vec<(DefectKind, u32)> {
    coil.defects().iter().map(|d| (d.kind, d.turn)).collect()
}

/// In its place from one crossover to the next, in the last sixth of a turn.
fn stepping(first: f64) -> impl Fn(f64) -> f64 {
    move |turns| first + turns.floor() + ((turns.fract() - 5.0 / 6.0) * 6.0).max(0.0)
}

/// The first turn of a layer has no neighbour, and a coil with the first place of its layer empty was aligned.
#[test]
fn an_empty_place_beside_the_flange_is_a_gap() {
    let told = coil(Some(0.0), stepping(1.0));
    assert_eq!(gaps(&told), [(DefectKind::Gap, 1)]);
    let size = told.defects()[0].size_m;
    assert!(size.is_some_and(|size| (size - D).abs() < 1e-6), "{size:?}");
    // wire that comes to lie there from nearer the flange leaves as much
    let coming = |turns: f64| stepping(1.0)(turns) - 0.3 * (1.0 - 4.0 * turns).max(0.0);
    let size = coil(Some(0.0), coming).defects()[0].size_m;
    assert!(size.is_some_and(|size| (size - D).abs() < 1e-6), "{size:?}");
}

#[test]
fn a_first_turn_in_its_place_leaves_none() {
    assert_eq!(gaps(&coil(Some(0.0), stepping(0.0))), []);
    // by plan, or where no plan says where layers begin
    assert_eq!(gaps(&coil(Some(D), stepping(1.0))), []);
    assert_eq!(gaps(&coil(None, stepping(1.0))), []);
    // as far from its flange as a layer that begins half a place off
    assert_eq!(gaps(&coil(Some(0.0), stepping(0.5))), []);
    // even travel has as much room for the end of its first turn
    assert_eq!(gaps(&coil(Some(0.0), |turns| turns)), []);
}
