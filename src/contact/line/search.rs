//! The surfaces near a contact point: when they are looked up, and what is found.

use super::line_contact::LineContact;
use super::model::LineModel;
use super::point::{CORE, FLANGE, PASSAGES, PointState, WIRE};
use super::scratch::LineScratch;
use super::touch::TouchState;
use crate::contact::own_wire::SAME_PASSAGE;
use crate::contact::stencil::ContactPoint;
use crate::geometry::SplineTube;
use crate::math::V3;

/// Distance beyond touching within which surfaces are listed, and the way after which a point with surfaces near it looks
/// them up again, in wire diameters. Chosen.
const SKIN: f64 = 0.15;

/// Way, in wire diameters, that a point with nothing near it has to spare before its surroundings are looked up again. Chosen: well
/// below [`SKIN`], and more than an update of Newton's method mostly moves a node.
const ROOM: f64 = 0.03;

/// How far the normal of a touch may turn in a step, rad.
#[derive(Clone, Copy)]
pub struct MostTurn {
    /// Of a touch that begins in the step.
    pub landing: f64,
    /// Of one that was there before.
    pub lasting: f64,
}

impl MostTurn {
    fn least(&self) -> f64 {
        self.landing.min(self.lasting)
    }
}

/// Depth (m) of the wire at `p` (m) in what a slot is with, unit normal towards `p`, and where that was found. That is the
/// segment of frozen wire or the triangle of a mesh, which is looked for from `start` on.
#[inline(always)]
pub(super) fn depth_at(
    model: &LineModel,
    tube: &SplineTube,
    slot: usize,
    start: u32,
    p: V3,
) -> (f64, V3, u32) {
    if slot < WIRE
        && let Some(surface) = model.shape.with_walls()
    {
        return match surface.wall_foot(p, start) {
            Some(foot) => (model.radius - foot.distance, foot.normal, foot.triangle),
            // looked at again after that way
            None => (-2.0 * SKIN * model.radius, V3::zeros(), start),
        };
    }
    match slot {
        CORE => {
            let (near, triangle) = model.shape.nearness_from(p, start);
            (model.radius - near.distance, near.normal, triangle)
        }
        FLANGE => match model.flange(p) {
            Some(near) => (model.radius - near.distance, near.normal, start),
            None => (f64::NEG_INFINITY, V3::zeros(), start),
        },
        _ => {
            let foot = tube.foot(p, start);
            let depth = foot.depth(model.radius + tube.radius());
            (depth, foot.normal, foot.segment)
        }
    }
}

impl LineContact<'_> {
    /// Makes points near frozen wire from node `from` on look their surroundings up again: that wire has just
    /// been laid.
    pub fn forget_near(&mut self, from: usize) {
        let skin = SKIN * 2.0 * self.scratch.tube.radius();
        let wire = self.model.radius + self.scratch.tube.radius();
        // the share of the curve that belongs to the node before has changed as well
        let laid = &self.scratch.tube.controls()[from.saturating_sub(2)..];
        for p in &mut self.state.points {
            let reach = wire + p.reach.max(skin);
            let near = |ends: &[V3]| {
                let (middle, length) = ((ends[0] + ends[1]) * 0.5, (ends[1] - ends[0]).norm());
                (middle - p.centre).norm() < reach + length
            };
            if p.reach >= 0.0 && laid.windows(2).any(near) {
                p.reach = -1.0;
            }
        }
    }

    /// Lists in `scratch.busy` the points that something may be near with the nodes at `x`, m, which `to_core` takes to the core
    /// frame. Nothing is near the others: each of them is where its surroundings hold that were looked up, with [`ROOM`] to spare.
    ///
    /// Most points have nothing near them, and are asked for nothing but that, in one loop along the wire.
    #[inline(always)]
    pub fn list_busy(&mut self, x: &[V3], to_core: impl Fn(V3) -> V3) {
        self.list_busy_with(x, to_core, |_, _| {});
    }

    /// [`Self::list_busy`] with the nodes at `q`, core frame, m, as a list for [`Self::keep_busy`].
    pub fn list_busy_at(&mut self, q: &[V3]) {
        self.list_busy(q, |p| p);
        self.scratch.listed_at.extend_from_slice(q);
    }

    /// Lists the points again where a node is farther from where it was at [`Self::list_busy_at`] than the others have to spare;
    /// `q` as there. In the iterates of a step that is seldom: in one of fifty evaluations (`fig8`, 300 rad/s, 2e-6 m).
    pub fn keep_busy(&mut self, q: &[V3]) {
        // (a little less, for rounding)
        let most = 0.999 * ROOM * 2.0 * self.scratch.tube.radius();
        let far = |(now, then): (&V3, &V3)| (now - then).norm_squared() > most * most;
        let then = &self.scratch.listed_at;
        if then.len() != q.len() || q.iter().zip(then).any(far) {
            self.list_busy_at(q);
        }
        debug_assert!(
            ContactPoint::all(q.len() - 1).all(|point| {
                let (k, state) = (point.number(), &self.state.points[point.number()]);
                !state.has_surroundings() && !state.has_left(point.place(q))
                    || self.scratch.busy.contains(&(k as u32))
            }),
            "a busy point is not listed"
        );
    }

    /// [`Self::list_busy`], which hands the other points to `idle` with their places in the core frame, m.
    #[inline(always)]
    pub(super) fn list_busy_with(
        &mut self,
        x: &[V3],
        to_core: impl Fn(V3) -> V3,
        idle: impl Fn(&mut PointState, V3),
    ) {
        let spare = ROOM * 2.0 * self.scratch.tube.radius();
        let (points, busy) = (&mut self.state.points, &mut self.scratch.busy);
        busy.clear();
        self.scratch.listed_at.clear();
        let mut look = |k: usize, point: &mut PointState, p: V3| {
            let p = to_core(p);
            let room = point.reach - spare;
            let stays = room > 0.0 && (p - point.centre).norm_squared() < room * room;
            if stays && !point.has_surroundings() {
                idle(point, p);
            } else {
                busy.push(k as u32);
            }
        };
        // the edge before each inner node and that node, with the nodes around it
        let (inner, last) = points[1..2 * x.len() - 2].as_chunks_mut::<2>();
        let around = x.windows(3);
        for (j, ([edge, node], x)) in inner.iter_mut().zip(around).enumerate() {
            look(2 * j + 1, edge, ContactPoint::Edge(0).place(x));
            look(2 * j + 2, node, ContactPoint::Node(1).place(x));
        }
        let ends = &x[x.len() - 2..];
        look(
            2 * x.len() - 3,
            &mut last[0],
            ContactPoint::Edge(0).place(ends),
        );
    }

    /// Whether core or frozen wire is near point `k` at `p`; looks its surroundings up if they may have changed since they were.
    #[inline(always)]
    pub(super) fn has_near(&mut self, k: usize, p: V3, own: impl FnOnce() -> f64) -> bool {
        let point = &self.state.points[k];
        if point.has_left(p) {
            self.look_up(k, p, own());
            return self.state.points[k].has_surroundings();
        }
        point.has_surroundings()
    }

    /// Share of the way of point `k` to `to`, m, on which none of its touches turns its normal by more than `most` after it
    /// began; 1: all of it. Ways below `unseen`, m, are no matter. `own` as in [`Self::push`].
    #[inline(always)]
    pub fn share_to_turn(
        &mut self,
        k: usize,
        to: V3,
        own: impl FnOnce() -> f64,
        most: MostTurn,
        unseen: f64,
    ) -> f64 {
        let point = &self.state.points[k];
        let way = to - point.last;
        // no surface that the centreline lies on is bent more sharply than the wire
        if !point.placed || way.norm() < unseen.max(most.least() * self.model.radius) {
            return 1.0;
        }
        if self.has_near(k, to, own) {
            self.share_to_turn_near(k, to, most)
        } else {
            1.0
        }
    }

    /// [`Self::share_to_turn`] for a point with surfaces near it.
    #[inline(never)]
    fn share_to_turn_near(&self, k: usize, to: V3, most: MostTurn) -> f64 {
        let point = &self.state.points[k];
        let from = point.last;
        let way = to - from;
        if (to - point.clear_at).norm() < point.clear_within {
            return 1.0;
        }
        let touch_at = |slot: usize, p: V3| {
            let (depth, normal, _) = depth_at(
                self.model,
                &self.scratch.tube,
                slot,
                point.touch[slot].start,
                p,
            );
            (depth, normal)
        };
        let mut share: f64 = 1.0;
        for slot in point.slots() {
            let (depth, normal) = touch_at(slot, to);
            if depth <= 0.0 {
                continue;
            }
            let (before, first) = touch_at(slot, from);
            let (began, first, most) = if before < 0.0 {
                let began = before / (before - depth);
                (began, touch_at(slot, from + way * began).1, most.landing)
            } else {
                (0.0, first, most.lasting)
            };
            let turn = (normal - first).norm();
            if turn > most {
                share = share.min(began + (1.0 - began) * most / turn);
            }
        }
        share
    }

    /// Looks up the surroundings of point `k` at `p`, and how far they hold. Frozen wire beyond the unstretched length
    /// `own` from the clamp belongs to the point's own neighbourhood.
    fn look_up(&mut self, k: usize, p: V3, own: f64) {
        let skin = SKIN * 2.0 * self.scratch.tube.radius();
        let point = &mut self.state.points[k];
        self.scratch.undo.push((k as u32, **point));
        point.centre = p;
        point.clear_within = 0.0;
        let core = self.model.shape.lower_bound(p);
        let (core, triangle) = if core > skin + self.model.radius {
            (core, u32::MAX)
        } else {
            let guess = point.touch[CORE].start;
            let (near, triangle) = self.model.shape.nearness_from(p, guess);
            (near.distance, triangle)
        };
        let core_room = core - self.model.radius;
        point.near[CORE] = core_room < skin;
        let flange_room = match self.model.flange(p) {
            Some(flange) => flange.distance - self.model.radius,
            None => f64::INFINITY,
        };
        point.near[FLANGE] = flange_room < skin;
        if let Some(surface) = self.model.shape.with_walls() {
            let LineScratch { found, feet, .. } = &mut *self.scratch;
            feet.clear();
            if point.near[CORE] {
                surface.walls(p, self.model.radius + skin, found, feet);
            }
            point.keep_walls(p, surface, feet);
        } else {
            if point.near[CORE] {
                point.touch[CORE].start = triangle;
            } else {
                point.touch[CORE] = TouchState::UNUSED;
            }
            if !point.near[FLANGE] {
                point.touch[FLANGE] = TouchState::UNUSED;
            }
        }
        let wire = self.model.radius + self.scratch.tube.radius();
        // above all frozen wire there is nothing to search for; elsewhere the search ball must stay small
        let above = core_room - self.state.height;
        let reach = if above > skin {
            above
        } else {
            (core_room + skin).clamp(skin, 4.0 * skin)
        };
        self.scratch.found.clear();
        if above <= skin {
            self.scratch
                .tube
                .gather(p, wire + reach, own, &mut self.scratch.found);
        }
        let mut next = [TouchState::UNUSED; PASSAGES];
        let mut count = 0;
        let mut nearest = f64::INFINITY;
        for &start in &self.scratch.found {
            let foot = self.scratch.tube.foot(p, start);
            nearest = nearest.min(-foot.depth(wire));
            if -foot.depth(wire) > skin || count == PASSAGES {
                continue;
            }
            // a passage keeps its friction: it is the one whose segment is close by along the wire
            let known = point.touch[WIRE..WIRE + point.passages]
                .iter()
                .filter(|t| t.start.abs_diff(foot.segment) < SAME_PASSAGE)
                .min_by_key(|t| (t.start.abs_diff(foot.segment), !t.anchored));
            next[count] = known.copied().unwrap_or(TouchState::UNUSED);
            next[count].start = foot.segment;
            count += 1;
        }
        point.touch[WIRE..].copy_from_slice(&next);
        point.passages = count;
        let wire_room = nearest.min(reach);
        let solids_room = match point.near == [false; WIRE] {
            true => core_room.min(flange_room),
            false => 0.0,
        };
        let room = solids_room.min(if count > 0 { 0.0 } else { wire_room });
        point.reach = if room > 0.0 { room } else { skin };
    }
}
