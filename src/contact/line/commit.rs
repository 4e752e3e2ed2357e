//! An iterate becomes accepted: friction limits, anchors, losses; and the energy that touches store.

use super::line_contact::LineContact;
use super::model::LineModel;
use super::point::{PointState, SLOTS};
use super::state::LineState;
use super::touch::TouchState;
use crate::contact::accepted_touch::{AcceptedTouch, OUTSIDE, TouchOwner, friction_of};
use crate::contact::friction::{FrictionLimit, across};
use crate::contact::law::{NormalLaw, TANGENTIAL_SHARE, work_beyond_stored};
use crate::contact::stencil::ContactPoint;
use crate::math::V3;

impl LineContact<'_> {
    /// Begins an attempt at a step.
    pub fn begin_attempt(&mut self) {
        self.scratch.undo.clear();
        self.scratch.listed_at.clear();
    }

    /// Takes back all that a failed attempt at a step changed.
    pub fn undo_attempt(&mut self) {
        for (k, point) in self.scratch.undo.drain(..).rev() {
            *self.state.points[k as usize] = point;
        }
        for p in &mut self.state.points {
            if p.has_surroundings() {
                for t in p.touches_mut() {
                    t.limit.lagged = t.limit.accepted;
                }
            }
        }
    }

    /// Accounts for touches that ended because their point went far from what it touched within the step. To be called before
    /// [`Self::commit`], which does it for the others. `place` (m) and `length` (m) are those of a point at the step's end.
    pub fn commit_left(&mut self, place: impl Fn(usize) -> V3, length: impl Fn(usize) -> f64) {
        let undo = &self.scratch.undo;
        for (entry, (k, old)) in undo.iter().enumerate() {
            let k = *k as usize;
            let now = self.state.points[k].touches();
            let left = old
                .touches()
                .iter()
                .filter(|t| t.anchored && !now.iter().any(|n| n.anchored && n.anchor == t.anchor));
            for t in left {
                // (only the first look within a step saw the accepted instant)
                if undo[..entry].iter().any(|(other, _)| *other as usize == k) {
                    continue;
                }
                let out = (place(k) - old.last).dot(&t.normal);
                if out >= t.depth_before {
                    let before = NormalLaw::at(t.depth_before, self.model.onset);
                    self.scratch.lifted += self.model.law.stiffness
                        * length(k)
                        * work_beyond_stored(before.force, before.energy, out);
                }
            }
        }
    }

    /// [`Self::list_busy`], and makes the places of the other points the accepted ones: they touch nothing, so nothing else of
    /// them moves on.
    #[inline(always)]
    pub fn commit_idle(&mut self, x: &[V3], to_core: impl Fn(V3) -> V3) {
        self.list_busy_with(x, to_core, |point, p| {
            debug_assert!(point.touch.iter().all(TouchState::is_unused));
            point.last = p;
        });
    }

    /// Makes `p` (m) the accepted place of point `k` after a step of `step` (s): anchors follow, slip and landings are
    /// added to the losses. Returns the force on the point, core frame, N. Arguments as in [`Self::push`].
    ///
    /// The energy balance takes half the sum of the forces at both ends of a step for what acted on its way. A touch
    /// that begins within the step acted on the last of the way only, and stores what its law says. The
    /// rest of the work that the balance ascribes to it is lost: the landing, and half of its slip. A touch that ends
    /// within the step acted at its beginning only.
    #[inline(always)]
    pub fn commit(
        &mut self,
        k: usize,
        p: V3,
        length: impl FnOnce() -> f64,
        own: impl FnOnce() -> f64,
        step: f64,
    ) -> V3 {
        let point = &self.state.points[k];
        let limits = point.has_surroundings().then(|| point.limits());
        if self.has_near(k, p, own) {
            self.commit_near(
                k,
                p,
                length(),
                step,
                limits.unwrap_or([FrictionLimit::ZERO; SLOTS]),
            )
        } else {
            // no touch is in use, so none has anything to move on
            let point = &mut self.state.points[k];
            debug_assert!(point.touch.iter().all(TouchState::is_unused));
            point.last = p;
            V3::zeros()
        }
    }

    /// [`Self::commit`] for a point with surfaces near it, whose touches were solved with the friction limits `used`.
    #[inline(never)]
    fn commit_near(
        &mut self,
        k: usize,
        p: V3,
        length: f64,
        step: f64,
        used: [FrictionLimit; SLOTS],
    ) -> V3 {
        let force = self
            .push_near(k, p, length, step)
            .map_or(V3::zeros(), |s| -s.gradient);
        let stiffness = self.model.law.stiffness * length;
        let k_t = stiffness * TANGENTIAL_SHARE;
        let onset = self.model.onset;
        let point = &mut self.state.points[k];
        let last = point.last;
        for slot in point.slots() {
            let t = &mut point.touch[slot];
            t.limit.accept();
            let out = (p - last).dot(&t.normal);
            if t.depth <= 0.0 {
                if t.anchored && out >= t.depth_before {
                    let before = NormalLaw::at(t.depth_before, onset);
                    self.scratch.lifted +=
                        stiffness * work_beyond_stored(before.force, before.energy, out);
                }
                t.anchored = false;
                (t.depth_before, t.rebound) = (0.0, 0.0);
                continue;
            }
            let began = !t.anchored;
            let lands = began && t.depth + out <= OUTSIDE * onset;
            let pressed = NormalLaw::at(t.depth, onset);
            if lands {
                self.state.loss.damping +=
                    stiffness * work_beyond_stored(pressed.force, pressed.energy, -out);
            }
            t.depth_before = t.depth;
            self.state.deepest = self.state.deepest.max(t.depth);
            let b = t.bristle(p, last);
            let force = stiffness * pressed.force;
            let (friction, surplus) = friction_of(&b, k_t, t.limit.current, used[slot].used(force));
            self.scratch.accepted.push(AcceptedTouch {
                point: ContactPoint::of_number(k),
                old: None,
                normal: t.normal,
                force: t.normal * force + friction,
                surplus,
                began,
                lands,
                rebound: t.rebound,
                owner: TouchOwner::Point { point: k, slot },
            });
            let size = b.norm();
            t.anchored = true;
            let share = if lands { 0.5 } else { 1.0 };
            t.anchor = p - b;
            if k_t * size > t.limit.current {
                let kept = t.limit.current / k_t;
                t.anchor = p - b * (kept / size);
                self.state.loss.friction += share * t.limit.current * (size - kept);
            }
        }
        point.last = p;
        force
    }
}

impl LineState {
    /// Keeps the speed at which a touch may open, m/s.
    pub(crate) fn keep_rebound(&mut self, owner: TouchOwner, speed: f64) {
        match owner {
            TouchOwner::Point { point, slot } => self.points[point].touch[slot].rebound = speed,
            TouchOwner::Pair(pair) => {
                if let Some(pairs) = &mut self.self_contact {
                    pairs.keep_rebound(pair, speed);
                }
            }
        }
    }

    /// Normal force of each touch of point `k` at the last evaluation, which stands for `length` (m), core frame, N: the
    /// core's first, then those of frozen wire.
    pub fn normal_forces<'a>(
        &'a self,
        model: &LineModel,
        k: usize,
        length: f64,
    ) -> impl Iterator<Item = V3> + 'a {
        let onset = model.onset;
        let k_n = model.law.stiffness * length;
        self.points[k]
            .touches()
            .iter()
            .filter(|t| t.depth > 0.0)
            .map(move |t| t.normal * (k_n * NormalLaw::at(t.depth, onset).force))
    }
}

impl PointState {
    /// Energy stored in the touches of the point, which stands for `length` (m), J.
    pub(super) fn stored(&self, model: &LineModel, length: f64) -> f64 {
        if !self.has_surroundings() {
            return 0.0;
        }
        let k_n = model.law.stiffness * length;
        self.touches()
            .iter()
            .filter(|t| t.depth > 0.0)
            .map(|t| {
                let pressed = k_n * NormalLaw::at(t.depth, model.onset).energy;
                if !t.anchored {
                    return pressed;
                }
                let b = across(self.last - t.anchor, &t.normal);
                pressed + 0.5 * k_n * TANGENTIAL_SHARE * b.norm_squared()
            })
            .sum()
    }
}
