//! What holds each touch by friction, for a judge that computes the force itself.

use super::point::{CORE, FLANGE, WIRE};
use super::state::LineState;
use super::touch::TouchState;
use crate::math::V3;

/// What a touch is with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldBy {
    /// what wire is wound on
    Core,
    /// a flange
    Flange,
    /// the wall of a mesh that this triangle belongs to
    Wall(u32),
    /// frozen wire, near this segment of it
    Wire(u32),
}

/// A touch whose bristle holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTouch {
    /// number of its contact point
    pub point: usize,
    /// the friction anchor, core frame, m
    pub anchor: V3,
    /// what it touches
    pub with: HeldBy,
}

/// A contact point that touches: its number, and what it is with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TouchMark {
    /// core, wall of a mesh or flange, or a passage of frozen wire
    Settled(usize, usize),
    /// older live wire
    Live(usize),
}

impl LineState {
    /// The touches, and whether each slides; of pairs of live wire that is not told.
    pub fn marks(&self) -> impl Iterator<Item = (TouchMark, bool)> {
        let settled = self.points.iter().enumerate().flat_map(|(point, state)| {
            let touches = state.touches().iter().enumerate();
            let touching = touches.filter(|(_, t)| t.anchored);
            touching.map(move |(slot, t)| (TouchMark::Settled(point, slot), t.slide != V3::zeros()))
        });
        let pairs = self.self_contact.iter().flat_map(|pairs| pairs.held());
        settled.chain(pairs.map(|pair| (TouchMark::Live(pair.point), false)))
    }

    /// The touches with core and frozen wire that friction holds.
    pub fn held(&self) -> impl Iterator<Item = HeldTouch> {
        self.points.iter().enumerate().flat_map(|(point, state)| {
            let touches = state.touches().iter().enumerate();
            let holding = touches.filter(|(_, t)| t.depth > 0.0 && t.anchored);
            holding.map(move |(slot, t)| HeldTouch {
                point,
                anchor: t.anchor,
                with: match slot {
                    wall if wall < WIRE && t.start != TouchState::UNUSED.start => {
                        HeldBy::Wall(t.start)
                    }
                    CORE => HeldBy::Core,
                    FLANGE => HeldBy::Flange,
                    _ => HeldBy::Wire(t.start),
                },
            })
        })
    }

    /// Moves the anchors of a point, m: what a judge has to notice.
    pub fn stretch_bristles(&mut self, point: usize, by: V3) {
        for t in self.points[point].touches_mut() {
            t.anchor += by;
        }
    }
}
