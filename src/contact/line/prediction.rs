//! Tangents of contact where an update of Newton's method leads.

use super::line_contact::LineContact;
use super::near::Tangent;
use crate::contact::slip_coupling::SlipCoupling;
use crate::contact::stencil::ContactPoint;
use crate::contact::tolerance::NEGLIGIBLE;
use crate::math::{Block, V3, block_difference, block_times};

/// Change of an update that calls for no new look, as a share of the prediction tolerance. Chosen.
const SAME_UPDATE: f64 = 0.2;

impl LineContact<'_> {
    /// Evaluates the response where the update `move_of(point)` (m) leads every point, and replaces the models that promise
    /// something else by the tangents there; returns whether there were any. No node goes farther than `farthest`, m. A promise may
    /// be off by `share` of what the model allows. That of a bristle held beyond its friction limit may be off by no more than the
    /// limit. A row of them that each held a little more would hold the wire.
    ///
    /// `correct(point, change of the Hessian, change of the gradient at the iterate)` hands the replacement over, N/m and N.
    /// Without it a point on its way through a surface that the Hessian does not hold yet would be thrown back
    /// and forth, with all its neighbours on a flat. So would one that slides round a corner, or whose bristle
    /// comes to hold.
    #[inline(never)]
    pub fn predict(
        &mut self,
        step: f64,
        (farthest, share): (f64, f64),
        move_of: impl Fn(usize) -> V3,
        mut correct: impl FnMut(usize, &Block, &V3),
    ) -> bool {
        let mut any = false;
        let tolerance = share * self.model.prediction;
        let same = SAME_UPDATE * tolerance;
        let mut near = std::mem::take(&mut self.scratch.near);
        for n in &mut near {
            // no point goes farther than its nodes
            if n.room > farthest {
                continue;
            }
            let way = move_of(n.point as usize);
            let far = way.norm_squared();
            // too short a way to change the force by more than the tolerance, or as good as the one looked along
            let still = n
                .looked_along
                .map_or(far <= tolerance * tolerance, |before| {
                    (way - before).norm_squared() <= same * same
                });
            if far < n.room * n.room || still {
                continue;
            }
            n.looked_along = Some(way);
            let most = tolerance * self.model.law.stiffness * n.length;
            let place = n.place + way;
            let (there, held) =
                self.respond_ahead(n.point as usize, place, n.length, step, NEGLIGIBLE * most);
            let known = n.tangent.unwrap_or_default();
            let off = there.gradient - known.gradient - block_times(&known.hessian, &way);
            if off.amax() <= most.min(n.held) {
                continue;
            }
            any = true;
            let tangent = Tangent {
                gradient: there.gradient - block_times(&there.hessian, &way),
                hessian: there.hessian,
                slip_coupling: there.slip_coupling,
            };
            correct(
                n.point as usize,
                &block_difference(&tangent.hessian, &known.hessian),
                &(tangent.gradient - known.gradient),
            );
            (n.tangent, n.room, n.held) = (Some(tangent), 0.0, held);
            for touch in &mut self.state.points[n.point as usize].touch {
                touch.limit.follows = false;
            }
        }
        self.scratch.near = near;
        any
    }

    /// Adds the slip couplings of the linear system to `list`.
    pub fn list_slip_couplings(&self, list: &mut Vec<SlipCoupling>) {
        for near in &self.scratch.near {
            if let Some(tangent) = &near.tangent
                && tangent.slip_coupling != Block::default()
            {
                list.push(SlipCoupling {
                    point: ContactPoint::of_number(near.point as usize).weights(),
                    foot: None,
                    block: tangent.slip_coupling,
                });
            }
        }
        self.scratch.pairs.list_slip_couplings(list);
    }
}
