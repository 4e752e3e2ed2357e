//! Places of the wire straight below another.

use super::coil::{Coil, Record};
use super::plumb::Plumb;

/// How often the place below is looked up again at the height found there. The first time it is taken to be as high as where the
/// search begins; wire is inclined by a tenth, so each time leaves a tenth of the error.
const TIMES: usize = 2;

/// A place of the wire below.
pub(crate) struct Lower<'a> {
    /// m
    pub(crate) y: f64,
    /// over the core, m
    pub(crate) height: f64,
    /// the station next to it
    pub(crate) record: &'a Record,
}

impl Coil {
    /// The place straight below wire at `height` over the core (m), along the wire of the station at `index`.
    pub(crate) fn straight_below(&self, plumb: &Plumb, height: f64, index: usize) -> Lower<'_> {
        let last = self.records.len() - 1;
        let mut lower = self.on_wire(index as f64);
        for _ in 0..TIMES {
            let place = index as f64 + plumb.stations(height - lower.height);
            lower = self.on_wire(place.clamp(0.0, last as f64));
        }
        lower
    }

    /// The wire at so many stations from the clamp.
    fn on_wire(&self, place: f64) -> Lower<'_> {
        let before = place as usize;
        let after = (before + 1).min(self.records.len() - 1);
        let (a, b) = (&self.records[before], &self.records[after]);
        let share = place - before as f64;
        let between = |a: f64, b: f64| a + share * (b - a);
        Lower {
            y: between(a.station.position.y, b.station.position.y),
            height: between(a.station.height, b.station.height),
            record: if share < 0.5 { a } else { b },
        }
    }
}
