//! Tension over a place of the wire, as a chain of straight pieces that never falls.
//!
//! Masses, springs, dashpots, dry friction, yield and slack behind the nozzle each turn one such curve into the next.
//! During an implicit step they all are of this form, so the feed needs no unknown of its own.

use super::line_yield::{LineYield, MOST_LEVELS};

/// Most corners: the first, two by friction of a pulley, one each where either span goes slack and where wire would push, and
/// those where more of the line yields.
pub const MOST_CORNERS: usize = 6 + MOST_LEVELS;

/// A curve that never falls: straight between its corners, with a ray before the first and after the last.
///
/// Places in m, tensions in N, slopes in N/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// place and tension of each corner, in order
    corners: [[f64; 2]; MOST_CORNERS],
    count: usize,
    /// slopes of the two rays
    before: f64,
    after: f64,
}

impl Curve {
    /// A straight line that has `tension` at 0.
    pub fn straight(tension: f64, slope: f64) -> Self {
        let mut corners = [[0.0; 2]; MOST_CORNERS];
        corners[0] = [0.0, tension];
        Self {
            corners,
            count: 1,
            before: slope,
            after: slope,
        }
    }

    /// Place and tension of each corner, in order.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.count]
    }

    /// Slope behind a corner.
    pub fn slope_after(&self, corner: usize) -> f64 {
        match self.corners().get(corner + 1) {
            Some(next) => {
                let from = self.corners[corner];
                (next[1] - from[1]) / (next[0] - from[0])
            }
            None => self.after,
        }
    }

    /// Tension at a place; on an upright piece, where a corner of it lies.
    pub fn tension(&self, place: f64) -> f64 {
        let corners = self.corners();
        let next = corners.partition_point(|c| c[0] <= place);
        let Some(last) = next.checked_sub(1) else {
            return corners[0][1] + self.before * (place - corners[0][0]);
        };
        corners[last][1] + self.slope_after(last) * (place - corners[last][0])
    }

    /// Place at which it has this tension; where it has it all along a piece, the place there that is nearest to 0.
    pub fn place(&self, tension: f64) -> f64 {
        let corners = self.corners();
        let beyond = |from: [f64; 2], slope: f64| {
            if slope > 0.0 {
                from[0] + (tension - from[1]) / slope
            } else {
                from[0]
            }
        };
        let (first, last) = (corners[0], corners[self.count - 1]);
        let low = match corners.iter().position(|c| c[1] >= tension) {
            None => beyond(last, self.after),
            Some(0) if self.before == 0.0 && first[1] == tension => f64::NEG_INFINITY,
            Some(0) => beyond(first, self.before),
            Some(k) => between(corners[k - 1], corners[k], tension),
        };
        let high = match corners.iter().rposition(|c| c[1] <= tension) {
            None => beyond(first, self.before),
            Some(k) if k + 1 == self.count => {
                if self.after == 0.0 && last[1] == tension {
                    f64::INFINITY
                } else {
                    beyond(last, self.after)
                }
            }
            Some(k) => between(corners[k], corners[k + 1], tension),
        };
        0.0_f64.max(low.min(high)).min(high.max(low))
    }

    /// The curve with a straight line added that has `tension` at 0.
    pub fn plus(mut self, tension: f64, slope: f64) -> Self {
        for c in &mut self.corners[..self.count] {
            c[1] += tension + slope * c[0];
        }
        self.before += slope;
        self.after += slope;
        self
    }

    /// The curve with every place farther by this, m.
    pub fn moved(mut self, by: f64) -> Self {
        self.corners[..self.count]
            .iter_mut()
            .for_each(|c| c[0] += by);
        self
    }

    /// The curve with dry friction of this force added, which holds place 0.
    pub fn with_friction(mut self, force: f64) -> Self {
        // (an upright piece without height has no slope)
        if force == 0.0 {
            return self;
        }
        let here = self.tension(0.0);
        let at = self.corners().partition_point(|c| c[0] < 0.0);
        let behind = self.corners().partition_point(|c| c[0] <= 0.0);
        let after: [[f64; 2]; MOST_CORNERS] = self.corners;
        let old = self.count;
        self.corners[..at].iter_mut().for_each(|c| c[1] -= force);
        self.corners[at] = [0.0, here - force];
        self.corners[at + 1] = [0.0, here + force];
        self.count = at + 2;
        for c in &after[behind..old] {
            self.corners[self.count] = [c[0], c[1] + force];
            self.count += 1;
        }
        self
    }

    /// The curve at the front of a spring behind which it lies: the spring pulls by `pull` with both places 0.
    pub fn before_spring(mut self, stiffness: f64, pull: f64) -> Self {
        for c in &mut self.corners[..self.count] {
            c[0] += (c[1] - pull) / stiffness;
        }
        let soft = |slope: f64| slope * stiffness / (slope + stiffness);
        (self.before, self.after) = (soft(self.before), soft(self.after));
        self
    }

    /// The curve at the front of wire that gets longer for good by what it yields.
    pub fn before_yield(self, yields: &LineYield) -> Self {
        let mut next = Self { count: 0, ..self };
        let mut add = |[place, tension]: [f64; 2]| {
            next.corners[next.count] = [place + yields.longer(tension), tension];
            next.count += 1;
        };
        let mut levels = yields.levels().iter().map(|level| level[0]).peekable();
        for (k, corner) in self.corners().iter().enumerate() {
            while let Some(tension) = levels.next_if(|tension| *tension <= corner[1]) {
                // (nothing begins to yield along a level ray)
                if tension < corner[1] && (k > 0 || self.before > 0.0) {
                    add([self.place(tension), tension]);
                }
            }
            add(*corner);
        }
        if self.after > 0.0 {
            levels.for_each(|tension| add([self.place(tension), tension]));
            let compliance: f64 = yields.levels().iter().map(|level| level[1]).sum();
            next.after = 1.0 / (1.0 / self.after + compliance);
        }
        next
    }

    /// The curve with 0 wherever it was below: wire pulls and never pushes.
    pub fn never_pushing(mut self) -> Self {
        let corners = self.corners;
        let old = &corners[..self.count];
        let pulls = old.partition_point(|c| c[1] <= 0.0);
        let zero = match (pulls.checked_sub(1), old.get(pulls)) {
            (None, Some(_)) if self.before <= 0.0 => return self,
            (None, Some(first)) => first[0] - first[1] / self.before,
            (Some(k), Some(next)) => between(old[k], *next, 0.0),
            (_, None) => {
                let last = old[old.len() - 1];
                if self.after <= 0.0 {
                    return Self::straight(0.0, 0.0);
                }
                last[0] - last[1] / self.after
            }
        };
        self.corners[0] = [zero, 0.0];
        self.count = 1;
        for c in &old[pulls..] {
            self.corners[self.count] = *c;
            self.count += 1;
        }
        self.before = 0.0;
        self
    }
}

/// Place between two corners where the tension is this.
fn between(from: [f64; 2], to: [f64; 2], tension: f64) -> f64 {
    let rise = to[1] - from[1];
    if rise <= 0.0 {
        return to[0];
    }
    from[0] + (to[0] - from[0]) * ((tension - from[1]) / rise)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_changes_the_curve_as_its_law_says() {
        let mass = Curve::straight(3.0, 2.0);
        let held = mass.with_friction(1.5);
        assert_eq!(held.tension(-1.0), 3.0 - 2.0 - 1.5);
        assert_eq!(held.tension(1.0), 3.0 + 2.0 + 1.5);
        // anywhere on the upright piece wire stays where it is
        for tension in [1.5, 2.0, 4.5] {
            assert_eq!(held.place(tension), 0.0);
        }
        assert_eq!(held.place(6.5), 1.0);
        assert_eq!(held.place(-0.5), -1.0);
        // two springs in a row: each takes its own stretch under the same force
        let front = held.before_spring(4.0, 0.5);
        for tension in [-2.0, 0.0, 1.6, 3.0, 4.4, 9.0] {
            let want = held.place(tension) + (tension - 0.5) / 4.0;
            assert!((front.place(tension) - want).abs() < 1e-15);
            assert!((front.tension(want) - tension).abs() < 1e-14);
        }
        let wire = front.never_pushing();
        assert_eq!(wire.tension(-10.0), 0.0);
        assert_eq!(wire.tension(2.0), front.tension(2.0));
        let corners = wire.corners();
        assert_eq!(corners.len(), 3, "slack, held, out: {corners:?}");
        assert_eq!(wire.plus(1.0, 2.0).tension(2.0), front.tension(2.0) + 5.0);
    }

    /// A pulley without friction put two corners in one place, with no slope between them: from rest no step went through.
    #[test]
    fn no_friction_changes_nothing() {
        let mass = Curve::straight(3.0, 2.0);
        assert_eq!(mass.with_friction(0.0), mass);
    }

    /// Any place of it is that of the elastic curve and what has yielded under the same tension.
    #[test]
    fn yield_adds_to_the_place() {
        let mut yields = LineYield::default();
        for (tension, compliance) in [(2.0, 0.5), (3.0, 0.25), (4.5, 1.0)] {
            yields.push(tension, compliance);
        }
        let mass = Curve::straight(3.0, 2.0);
        for (elastic, corners) in [
            (mass, 3),
            (mass.with_friction(1.5), 4),
            (
                mass.with_friction(1.5)
                    .before_spring(4.0, 0.5)
                    .never_pushing(),
                5,
            ),
            (Curve::straight(3.0, 0.0), 1),
        ] {
            let curve = elastic.before_yield(&yields);
            assert_eq!(curve.corners().len(), corners, "{curve:?}");
            for tension in [0.5, 1.9, 2.0, 2.7, 3.0, 4.0, 4.5, 4.8, 20.0] {
                let place = elastic.place(tension) + yields.longer(tension);
                if place.is_finite() && elastic.tension(elastic.place(tension)) == tension {
                    let got = curve.tension(place);
                    assert!((got - tension).abs() < 1e-13, "{tension}: {got}, {curve:?}");
                }
            }
        }
        assert_eq!(mass.before_yield(&LineYield::default()), mass);
    }

    #[test]
    fn slack_ends_where_the_first_piece_pulls() {
        let always = Curve::straight(3.0, 0.0).never_pushing();
        assert_eq!(always.tension(-1e9), 3.0);
        let never = Curve::straight(-3.0, 0.0).never_pushing();
        assert_eq!(never.tension(1e9), 0.0);
        let late = Curve::straight(-3.0, 1.5).never_pushing();
        assert_eq!((late.tension(1.9), late.tension(4.0)), (0.0, 3.0));
        // slack all along: the nearest place to 0 with no tension
        assert_eq!(late.place(0.0), 0.0);
        assert_eq!(Curve::straight(3.0, 1.5).never_pushing().place(0.0), -2.0);
        let upright = Curve::straight(1.0, 1.0).with_friction(2.0).never_pushing();
        assert_eq!(upright.corners(), &[[0.0, 0.0], [0.0, 3.0]]);
        assert_eq!(upright.place(0.0), 0.0);
        assert_eq!(upright.place(1.0), 0.0);
    }
}
