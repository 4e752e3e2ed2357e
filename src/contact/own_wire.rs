//! What belongs together along the wire: the neighbourhood of a place, and the segments of one passage.

/// Length of a place's own neighbourhood in wire diameters: wire cannot bend so sharply that it touches
/// itself within this length. Chosen.
const OWN_WIRE: f64 = 5.0;

/// Passages of a wire by a place whose segments are nearer along that wire than this are one passage at successive searches.
pub(super) const SAME_PASSAGE: u32 = 6;

/// Unstretched length from the clamp, m, beyond which wire belongs to the neighbourhood of the place at
/// `arc` (m) and is no partner of its contact.
pub fn own_wire(arc: f64, diameter: f64) -> f64 {
    arc - OWN_WIRE * diameter
}
