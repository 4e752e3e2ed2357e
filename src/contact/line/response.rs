//! Potential, gradient and Hessian of a contact point at an iterate, and where an update leads it.

use super::line_contact::LineContact;
use super::near::{NearPoint, Tangent};
use super::search::depth_at;
use super::touch::{Conditions, TouchState};
use crate::contact::friction::{ContactResponse, LimitFrom};
use crate::math::V3;

impl LineContact<'_> {
    /// Begins a solve that [`Self::begin_attempt`] did not begin: points are listed again.
    pub fn begin_solve(&mut self) {
        self.scratch.listed_at.clear();
    }

    /// Begins an evaluation of all points.
    pub fn begin(&mut self) {
        self.scratch.near.clear();
    }

    /// Potential, gradient and Hessian of point `k` at `p` (m), which stands for `length` (m) of wire; `None` where
    /// it touches nothing.
    ///
    /// `own` is the unstretched length from the clamp (m) beyond which frozen wire belongs to the point's own
    /// neighbourhood, `step` the time since the last accepted instant (s). Most points have nothing near them, and are done
    /// with here; of these neither length is asked for.
    #[inline(always)]
    pub fn push(
        &mut self,
        k: usize,
        p: V3,
        length: impl FnOnce() -> f64,
        own: impl FnOnce() -> f64,
        step: f64,
    ) -> Option<ContactResponse> {
        if self.has_near(k, p, own) {
            self.push_near(k, p, length(), step)
        } else {
            None
        }
    }

    /// [`Self::push`] for a point with surfaces near it. Most of these touch nothing within a way that is known.
    #[inline(always)]
    pub(super) fn push_near(
        &mut self,
        k: usize,
        p: V3,
        length: f64,
        step: f64,
    ) -> Option<ContactResponse> {
        let point = &self.state.points[k];
        if point.clear_within > 0.0 {
            let way = (p - point.clear_at).norm();
            if way < point.clear_within {
                self.scratch.near.push(NearPoint {
                    point: k as u32,
                    length,
                    place: p,
                    tangent: None,
                    room: point.clear_within - way,
                    looked_along: None,
                    held: f64::INFINITY,
                });
                return None;
            }
        }
        self.respond(k, p, length, step)
    }

    /// [`Self::push`] for a point that may touch.
    #[inline(never)]
    fn respond(&mut self, k: usize, p: V3, length: f64, step: f64) -> Option<ContactResponse> {
        let Self {
            model,
            state,
            scratch,
        } = self;
        let (law, tube) = (&model.law, &scratch.tube);
        let point = &mut state.points[k];
        let around = Conditions {
            law,
            onset: model.onset,
            stiffness: law.stiffness * length,
            step,
            last: point.last,
            limit_from: state.limit_from,
            negligible: 0.0,
        };
        let mut sum = ContactResponse::default();
        let mut any = false;
        let mut gap = f64::INFINITY;
        for slot in point.slots() {
            let touch = &mut point.touch[slot];
            (touch.depth, touch.normal, touch.start) = depth_at(model, tube, slot, touch.start, p);
        }
        for slot in point.slots() {
            let double = point.is_double(slot);
            let touch = &mut point.touch[slot];
            if double {
                touch.depth = 0.0;
                touch.limit.lift();
                continue;
            }
            if touch.depth <= 0.0 {
                touch.limit.lift();
                gap = gap.min(-touch.depth);
                continue;
            }
            any = true;
            let grip = touch.respond(p, &around, &mut sum);
            (touch.limit, touch.slide) = (grip.limit, grip.slide);
        }
        (point.clear_at, point.clear_within) = (p, if any { 0.0 } else { gap });
        scratch.near.push(NearPoint {
            point: k as u32,
            length,
            place: p,
            tangent: any.then_some(Tangent {
                gradient: sum.gradient,
                hessian: sum.hessian,
                slip_coupling: sum.slip_coupling,
            }),
            room: point.clear_within,
            looked_along: None,
            held: f64::INFINITY,
        });
        any.then_some(sum)
    }

    /// Response of point `k` at a place `p` to which an update leads, as far as its surroundings are known, and the least friction
    /// limit of a bristle that it holds beyond that, N. The friction limits stay those of the iterate; one up to `negligible`, N, lets its
    /// slide turn at once.
    pub(super) fn respond_ahead(
        &mut self,
        k: usize,
        p: V3,
        length: f64,
        step: f64,
        negligible: f64,
    ) -> (ContactResponse, f64) {
        let point = &mut self.state.points[k];
        let around = Conditions {
            law: &self.model.law,
            onset: self.model.onset,
            stiffness: self.model.law.stiffness * length,
            step,
            last: point.last,
            limit_from: LimitFrom::Current,
            negligible,
        };
        let (mut sum, mut held) = (ContactResponse::default(), f64::INFINITY);
        for slot in point.slots() {
            let touch = point.touch[slot];
            if point.is_double(slot) {
                continue;
            }
            let (depth, normal, _) = depth_at(self.model, &self.scratch.tube, slot, touch.start, p);
            if depth > 0.0 {
                let there = TouchState {
                    depth,
                    normal,
                    ..touch
                };
                let grip = there.respond(p, &around, &mut sum);
                point.touch[slot].slide = grip.slide;
                held = held.min(grip.held);
            }
        }
        (sum, held)
    }
}
