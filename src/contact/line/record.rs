//! Contact state of frozen nodes, kept for the case that they thaw.

use super::point::{PointState, SLOTS, WIRE};
use super::touch::TouchState;
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// Contact state that a frozen node keeps of its two points, its own and the middle of the edge after it.
///
/// It holds the points' places and the touches in use; most nodes have one touch or none. There is one record for
/// every frozen node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactRecord {
    /// places at the last accepted instant, core frame, m
    last: [V3; 2],
    placed: [bool; 2],
    /// touches of the first point, then of the second, with their slots in `PointState::touch`
    touches: Box<[(u8, TouchState)]>,
    /// how many of them belong to the first
    first: u8,
}

impl ContactRecord {
    /// The record of two successive points.
    pub(super) fn of(points: &[Box<PointState>]) -> Self {
        let used = |p: &'_ PointState| {
            p.slots()
                .map(|slot| (slot as u8, p.touch[slot]))
                .filter(|(_, t)| *t != TouchState::UNUSED)
                .collect::<Vec<_>>()
        };
        let mut touches = used(&points[0]);
        let first = touches.len() as u8;
        touches.extend(used(&points[1]));
        Self {
            last: [points[0].last, points[1].last],
            placed: [points[0].placed, points[1].placed],
            touches: touches.into(),
            first,
        }
    }

    /// Whether every touch has a slot in its point; saved bytes may say anything.
    pub(crate) fn is_sound(&self) -> bool {
        let mut slots = self.touches.iter().map(|(slot, _)| *slot as usize);
        self.first as usize <= self.touches.len() && slots.all(|slot| slot < SLOTS)
    }

    /// The two points as they froze; their surroundings are looked up again.
    pub(super) fn points(&self) -> [PointState; 2] {
        let (one, two) = self.touches.split_at(self.first as usize);
        let point = |k: usize, touches: &[(u8, TouchState)]| {
            let mut p = PointState::NEW;
            (p.last, p.placed) = (self.last[k], self.placed[k]);
            for &(slot, t) in touches {
                p.touch[slot as usize] = t;
                match slot as usize {
                    slot if slot < WIRE => p.near[slot] = true,
                    slot => p.passages = p.passages.max(slot + 1 - WIRE),
                }
            }
            p
        };
        [point(0, one), point(1, two)]
    }
}
