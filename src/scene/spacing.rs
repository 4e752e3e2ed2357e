//! How near nodes lie to each other near the core.

use super::Core;
use crate::math::scaled;
use crate::rod::Section;
use std::f64::consts::FRAC_PI_4;

/// Radius of a cylinder, in diameters, from which on edges get longer: there a chord is 0.2 % of the diameter off it.
const WIDE: f64 = 10.0;

/// Largest node spacing near the core over the radius of the wire's centreline on its corners. Chosen: with more, copper of 0.1 mm
/// on corners of 0.2 mm stands off the faces twice as far as it does.
const BENT: f64 = 0.45;

/// Largest node spacing near the core over the length in which tension straightens wire beyond an edge, `sqrt(EIp/T)`.
///
/// Chosen: edges of `s` such lengths lose the share `s^2/8` of the curvature at a sharp edge (`1/sqrt(1 + s^2/4)` where angles are
/// small), here 0.6 %.
const STRAIGHTENS: f64 = 0.22;

/// Finest and coarsest spacing, diameters. Below, a rod is no model of the wire any more and the explicit step falls with the
/// square; above, no turn is resolved.
pub(super) const FINEST: f64 = 0.1;
pub(super) const COARSEST: f64 = 10.0;

/// Node spacing near the core that goes with a tolerance, m, for wire of `diameter`, m: 0.3 mm to 2e-6 m for 0.7 mm.
///
/// Above, steps are as the cube root of the tolerance, and both time and space are of second order.
/// A spacing as that root too keeps the shares of the error that come from either. (`fig8` at 1e-5 m
/// and 0.4 mm: nearly all was from the steps. At 2e-6 m, 500 rad/s, 0.4 mm: the mean gap of turn 2 is 0.008 d from
/// that of half the spacing, with 0.3 mm 0.002 d.)
///
/// On a wide cylinder of this radius, m, chords of that spacing lie on the core as none of the rest needs it. There they
/// may be off it by as much as on one of [`WIDE`] diameters, and at most twice as long.
pub(super) fn spacing_for(tolerance: f64, diameter: f64, cylinder: f64) -> f64 {
    let wide = (cylinder / (WIDE * diameter)).sqrt().clamp(1.0, 2.0);
    let over = tolerance / scaled(2e-6, diameter);
    scaled(0.3e-3, diameter) * wide * libm::cbrt(over.max(1.0))
}

/// Spacing near the core that resolves how its corners bend this wire under this `tension` (N), m; a mesh does not tell.
///
/// Wire follows a corner, or where it is stiffer, leaves it as it leaves an edge.
pub(super) fn coarsest_on(core: &Core, wire: &Section, tension: f64) -> f64 {
    core.corner().map_or(f64::INFINITY, |corner| {
        (BENT * (corner + wire.radius())).max(coarsest_at_edge(wire, tension, FRAC_PI_4))
    })
}

/// The same for wire whose centreline turns by twice the angle `half_turn` (rad) at a sharp edge, m.
///
/// Wire that yields little does so over a short piece, and where that ends its curvature has a kink. There edges miss a share of
/// the turn that goes with `s^2` too. The curvature at the edge makes up for it: by the factor `1 + (EI/EIp - 1) (ky/k)^2` more.
fn coarsest_at_edge(wire: &Section, tension: f64, half_turn: f64) -> f64 {
    let yields_at = wire.m_y / wire.ei;
    // first integral of the elastica: T (1 - cos) = M k - W
    let beyond = 2.0 * tension * (1.0 - libm::cos(half_turn)) - wire.m_y * yields_at;
    let straightens = |rigidity: f64| STRAIGHTENS * (rigidity / tension).sqrt();
    if !(wire.m_y.is_finite() && beyond > 0.0) {
        return straightens(wire.ei);
    }
    let onset = yields_at * yields_at;
    let ratio = onset * wire.ei_p / (onset * wire.ei_p + beyond);
    straightens(wire.ei_p) / (1.0 + (wire.ei / wire.ei_p - 1.0) * ratio).sqrt()
}

/// What `near`, the spacing that goes with tolerance and wire, m, is divided by where corners ask for at most `coarsest`, m.
///
/// A power of two, so that the free span can stay as it is.
pub(super) fn halved(near: f64, coarsest: f64, diameter: f64) -> f64 {
    let mut halvings = 1.0;
    while near > coarsest * halvings && near > 2.0 * FINEST * diameter * halvings {
        halvings *= 2.0;
    }
    halvings
}

/// Spacing that a scene takes of `near` where tension (N) draws this wire by twice the angle `half_turn` (rad) over a sharp edge, m.
#[cfg(feature = "lab")]
pub(crate) fn spacing_at_edge(near: f64, wire: &Section, tension: f64, half_turn: f64) -> f64 {
    let coarsest = coarsest_at_edge(wire, tension, half_turn);
    near / halved(near, coarsest, wire.diameter)
}
