//! What lies straight below a wire.
//!
//! Straight down is against the outward normal of the core's flank. Beside the end of a flat face that is not the way to the axis: one
//! degree there is more than a diameter of wire, along which wire of the layer below comes down from its bow to the corner.

use super::STATION_STEP;
use crate::math::{V3, polar_angle, wrap_to_pi};

/// The line straight down from a place of the wire, across the axis y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plumb {
    /// m
    from: V3,
    /// outward normal of the core's flank, without its part along y
    outward: V3,
    /// +1 where wire runs towards growing polar angle, else -1
    direction: f64,
}

impl Plumb {
    /// The line from `from` (m), where the wire goes on by `along` (m) and comes `higher` over the core by as much, m.
    ///
    /// The height grows by the part of the tangent along the normal, and with the tangent that gives the normal.
    pub(crate) fn at(from: V3, along: V3, higher: f64, direction: f64) -> Self {
        let length = libm::hypot(along.x, along.z);
        let outward = match length > 0.0 {
            true => {
                let rise = (higher / length).clamp(-1.0, 1.0);
                let across = V3::new(along.z, 0.0, -along.x) * (direction / length);
                let along = V3::new(along.x, 0.0, along.z) / length;
                along * rise + across * (1.0 - rise * rise).sqrt()
            }
            false => V3::new(from.x, 0.0, from.z).normalize(),
        };
        Self {
            from,
            outward,
            direction,
        }
    }

    /// Stations by which the winding angle changes on the way down, over so many metres.
    pub(crate) fn stations(&self, down: f64) -> f64 {
        let below = self.from - self.outward * down;
        let angle = wrap_to_pi(polar_angle(below) - polar_angle(self.from));
        self.direction * angle / STATION_STEP
    }
}
