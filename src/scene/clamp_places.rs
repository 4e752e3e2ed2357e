//! Where between the flanges of a mesh the wire can be clamped.

use crate::geometry::{Room, Surface};

/// Share of the room that stretches have at least. Of a surface that crosses itself, inside and outside are not told apart, and
/// wire seems to lie nowhere.
const JUDGED: f64 = 0.1;

/// Halvings of the step to the last place of a stretch.
const HALVINGS: u32 = 30;

/// The stretches along the axis, m, in which wire of this radius (m) that is clamped on +x lies on the core, and neither in a
/// flange nor on one that leans over it. None where that cannot be told.
pub(super) fn clamp_places(surface: &Surface, room: Room, radius: f64) -> Vec<[f64; 2]> {
    let [low, high] = room.widest;
    let middle = 0.5 * (low + high);
    let [mut down, up] = [low + radius, high - radius].map(|end| {
        let way = Way { surface, radius };
        way.stretches(middle, end)
    });
    down.reverse();
    let mut places: Vec<[f64; 2]> = down.into_iter().map(|[from, to]| [to, from]).collect();
    for stretch in up {
        match places.last_mut() {
            Some(last) if last[1] == stretch[0] => last[1] = stretch[1],
            _ => places.push(stretch),
        }
    }
    let free: f64 = places.iter().map(|[from, to]| to - from).sum();
    if free < JUDGED * (high - low - 2.0 * radius) {
        places.clear();
    }
    places
}

/// A clamp that is moved along the core.
struct Way<'a> {
    surface: &'a Surface,
    radius: f64,
}

impl Way<'_> {
    /// Half width of the core for wire that is clamped at `y`, m; none where it lies on no core.
    fn lies_at(&self, y: f64) -> Option<f64> {
        let lies =
            self.surface.holds_clamped(y, self.radius) && !self.surface.overhangs(y, self.radius);
        lies.then(|| self.surface.half_width(y, self.radius))
            .flatten()
    }

    /// The same, but none on what rises by more than 45 degrees since the place and distance `last`, as a flange does.
    fn goes_on(&self, y: f64, last: Option<(f64, f64)>) -> Option<f64> {
        let rises = |x: f64| last.is_some_and(|(from, before)| x - before > (y - from).abs());
        self.lies_at(y).filter(|&x| !rises(x))
    }

    /// The stretches from the place `from` to `end`, m, in this order.
    fn stretches(&self, from: f64, end: f64) -> Vec<[f64; 2]> {
        let mut found: Vec<[f64; 2]> = Vec::new();
        let parts = ((end - from).abs() / (0.5 * self.radius)).ceil() as u32;
        let (mut last, mut open) = (None, false);
        for k in 0..=parts {
            let share = if parts == 0 {
                0.0
            } else {
                f64::from(k) / f64::from(parts)
            };
            let y = from + share * (end - from);
            let here = self.goes_on(y, last);
            match here {
                Some(x) => {
                    match found.last_mut() {
                        Some(stretch) if open => stretch[1] = y,
                        _ => found.push([y; 2]),
                    }
                    last = Some((y, x));
                }
                None if open => {
                    if let (Some(stretch), Some(before)) = (found.last_mut(), last) {
                        stretch[1] = self.last_before(before, y);
                    }
                }
                None => {}
            }
            open = here.is_some();
        }
        found
    }

    /// The last place before `closed` (m) to which the stretch goes on from the place and distance `open`.
    fn last_before(&self, mut open: (f64, f64), closed: f64) -> f64 {
        let mut step = closed - open.0;
        for _ in 0..HALVINGS {
            step *= 0.5;
            let y = open.0 + step;
            if let Some(x) = self.goes_on(y, Some(open)) {
                open = (y, x);
            }
        }
        open.0
    }
}
