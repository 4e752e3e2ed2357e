//! A contact point of the wire, and what it remembers when its wire freezes.

use super::touch::{NONE, Touch};
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// Passages of frozen wire a point can have near it: neighbours left and right, and a layer below.
pub(super) const PASSAGES: usize = 4;

/// A contact point of the wire.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Point {
    /// place at the last accepted instant, m
    pub(super) last: V3,
    pub(super) placed: bool,
    /// where the surroundings were looked up, and how far that holds
    pub(super) centre: V3,
    pub(super) reach: f64,
    /// within `clear` of this place it touches nothing; 0: it may
    pub(super) free: V3,
    pub(super) clear: f64,
    /// core first, then passages of frozen wire
    #[serde(with = "used")]
    pub(super) touch: [Touch; 1 + PASSAGES],
    pub(super) core_near: bool,
    pub(super) passages: usize,
}

/// One that was never anywhere.
pub(super) const FRESH: Point = Point {
    last: V3::new(0.0, 0.0, 0.0),
    placed: false,
    centre: V3::new(0.0, 0.0, 0.0),
    reach: -1.0,
    free: V3::new(0.0, 0.0, 0.0),
    clear: 0.0,
    touch: [NONE; 1 + PASSAGES],
    core_near: false,
    passages: 0,
};

/// Touches in a saved state: most are unused, and take no more than their bit in a mask.
mod used {
    use super::PASSAGES;
    use crate::contact::touch::{NONE, Touch};
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Whether nothing was ever written here, to the bit.
    fn is_none(t: &Touch) -> bool {
        let vectors = [t.anchor, t.slide, t.normal];
        let numbers = [t.lag, t.kept, t.fresh, t.depth, t.before];
        let mut all = vectors.iter().flatten().chain(&numbers);
        t.start == NONE.start && !t.held && all.all(|x| x.to_bits() == 0)
    }

    pub(super) fn serialize<S: Serializer>(
        touches: &[Touch; 1 + PASSAGES],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mask =
            (0..touches.len()).fold(0u8, |mask, k| mask | (u8::from(!is_none(&touches[k])) << k));
        let list: Vec<&Touch> = touches.iter().filter(|t| !is_none(t)).collect();
        (mask, list).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[Touch; 1 + PASSAGES], D::Error> {
        let (mask, list) = <(u8, Vec<Touch>)>::deserialize(deserializer)?;
        let mut touches = [NONE; 1 + PASSAGES];
        let mut list = list.into_iter();
        for k in (0..touches.len()).filter(|k| mask >> k & 1 == 1) {
            let next = list.next();
            touches[k] = next.ok_or_else(|| D::Error::custom("a touch is missing"))?;
        }
        Ok(touches)
    }
}

/// What a node's points of contact remember: places and touches. Most have one touch or none, and there
/// is one of these for every frozen node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    last: [V3; 2],
    placed: [bool; 2],
    /// touches of the first point, then of the second, with their places in `Point::touch`
    touches: Box<[(u8, Touch)]>,
    /// how many of them are of the first
    first: u8,
}

impl Memory {
    pub(super) fn of(points: &[Box<Point>]) -> Self {
        let known = |p: &'_ Point| {
            (0..=p.passages as u8)
                .zip(p.touch)
                .filter(|(slot, t)| if *slot == 0 { p.core_near } else { true } && *t != NONE)
                .collect::<Vec<_>>()
        };
        let mut touches = known(&points[0]);
        let first = touches.len() as u8;
        touches.extend(known(&points[1]));
        Self {
            last: [points[0].last, points[1].last],
            placed: [points[0].placed, points[1].placed],
            touches: touches.into(),
            first,
        }
    }

    /// Whether [`Self::points`] finds every touch a place; bytes from elsewhere may say anything.
    pub(crate) fn is_sound(&self) -> bool {
        let mut slots = self.touches.iter().map(|(slot, _)| *slot as usize);
        self.first as usize <= self.touches.len() && slots.all(|slot| slot <= PASSAGES)
    }

    /// The points again; what is near them is looked up anew.
    pub(super) fn points(&self) -> [Point; 2] {
        let (one, two) = self.touches.split_at(self.first as usize);
        let point = |k: usize, touches: &[(u8, Touch)]| {
            let mut p = FRESH;
            (p.last, p.placed) = (self.last[k], self.placed[k]);
            for &(slot, t) in touches {
                p.touch[slot as usize] = t;
                p.core_near |= slot == 0;
                p.passages = p.passages.max(slot as usize);
            }
            p
        };
        [point(0, one), point(1, two)]
    }
}
