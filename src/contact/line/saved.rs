//! The state of line contact in a saved state.

use super::line_contact::LineContact;
use super::point::PointState;
use crate::contact::law::ContactLoss;
use crate::contact::self_contact::SelfContact;
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// The part of [`LineContact`] that follows neither from the scene nor from the frozen wire.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedLine {
    #[expect(clippy::vec_box, reason = "those of the line")]
    points: Vec<Box<PointState>>,
    loss: ContactLoss,
    deepest: f64,
    /// counts wire that thawed as well, so that it does not follow from the frozen wire
    height: f64,
    /// nodes into which the frozen wire continues
    ahead: Option<[(V3, f64); 2]>,
    hold_limits: bool,
    self_contact: Option<SelfContact>,
}

impl LineContact {
    /// What a saved state has to hold.
    pub(crate) fn saved(&self) -> SavedLine {
        // a new field asks here whether it is state
        let Self {
            shape: _,
            tube: _,
            law: _,
            onset: _,
            damping: _,
            radius: _,
            loss,
            lifted: _,
            hold_limits,
            height,
            deepest,
            self_contact,
            near: _,
            points,
            undo: _,
            found: _,
        } = self;
        SavedLine {
            points: points.clone(),
            loss: *loss,
            deepest: *deepest,
            height: *height,
            ahead: self.tube.ahead(),
            hold_limits: *hold_limits,
            self_contact: self_contact.clone(),
        }
    }

    /// Goes back to a state saved with the same frozen wire and the same number of live nodes.
    pub(crate) fn take_back(&mut self, saved: SavedLine) {
        self.points = saved.points;
        self.self_contact = saved.self_contact;
        (self.loss, self.deepest) = (saved.loss, saved.deepest);
        (self.height, self.hold_limits) = (saved.height, saved.hold_limits);
    }

    /// Takes over a saved state of `nodes` live nodes whose frozen `wire` has these places (m) and unstretched lengths from
    /// the clamp (m). No edge is as long as `far` (m). An error says what is impossible about the state.
    pub(crate) fn restore(
        &mut self,
        saved: SavedLine,
        wire: impl Iterator<Item = (V3, f64)>,
        nodes: usize,
        far: f64,
    ) -> Result<(), &'static str> {
        let mut fresh = Self::new(self.shape.clone(), self.law, self.radius, nodes);
        wire.for_each(|(point, arc)| fresh.lay(point, arc));
        let mut last = (fresh.tube.points().last().copied()).zip(fresh.tube.arc().last().copied());
        for (point, arc) in saved.ahead.into_iter().flatten() {
            let sound = last.is_some_and(|(before, so_far)| {
                let way = (point - before).norm();
                way > 0.0 && way < far && arc >= so_far
            });
            if !sound {
                return Err("frozen wire goes on as none");
            }
            last = Some((point, arc));
        }
        fresh.tube.go_on(saved.ahead);
        let frozen = fresh.tube.controls().len() as u32;
        if saved.points.len() != 2 * nodes {
            return Err("contact points do not go with the nodes");
        }
        for p in &saved.points {
            let touches = p.touch.get(1..=p.passages);
            let all = touches.ok_or("a contact point has too many touches")?;
            if p.reach >= 0.0 && all.iter().any(|t| t.start >= frozen) {
                return Err("a touch is beyond the frozen wire");
            }
        }
        if !saved.self_contact.as_ref().is_none_or(|s| s.fits(nodes)) {
            return Err("a pair is beyond the live wire");
        }
        (fresh.points, fresh.self_contact) = (saved.points, saved.self_contact);
        (fresh.loss, fresh.deepest) = (saved.loss, saved.deepest);
        (fresh.height, fresh.hold_limits) = (saved.height, saved.hold_limits);
        *self = fresh;
        Ok(())
    }
}
