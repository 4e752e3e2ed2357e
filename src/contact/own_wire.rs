//! The rule that keeps a place of the wire from touching the wire right behind it.

/// Length of a place's own neighbourhood in wire diameters: wire cannot bend so sharply that it touches
/// itself within this length. Chosen.
const OWN_WIRE: f64 = 5.0;

/// Unstretched length from the clamp, m, beyond which wire belongs to the neighbourhood of the place at
/// `arc` (m) and is no partner of its contact.
pub fn own_wire(arc: f64, diameter: f64) -> f64 {
    arc - OWN_WIRE * diameter
}
