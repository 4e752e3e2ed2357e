//! Potential, gradient, Hessian and couplings of the pairs, at an iterate and where an update leads.

use super::coupling::Coupling;
use super::pairs::{Pair, SelfContact};
use super::scratch::{NearPair, PairScratch};
use crate::contact::friction::{ContactResponse, Grip, LimitFrom, Touching, across};
use crate::contact::law::{ContactLaw, NormalLaw, TANGENTIAL_SHARE};
use crate::contact::stencil::{ContactPoint, NodeWeights};
use crate::contact::tolerance::NEGLIGIBLE;
use crate::math::{Block, V3, block_difference, block_times};

/// What the response of the pairs depends on besides the wire.
#[derive(Clone, Copy, Debug)]
pub struct PairConditions<'a> {
    /// the law
    pub law: &'a ContactLaw,
    /// depth over which the normal force sets in, m
    pub onset: f64,
    /// wire diameter, m
    pub diameter: f64,
    /// error of a contact force that an update of Newton's method may promise, as a depth, m
    pub prediction: f64,
    /// time since the last accepted instant, s
    pub step: f64,
    /// which friction limits an evaluation takes
    pub limit_from: LimitFrom,
}

impl Pair {
    /// Response of a touching pair that slid by `way` (m) since the last accepted instant, by the distance vector, and what it makes of
    /// the bristle. `slide` is the one in the linear system.
    #[inline]
    fn respond(
        &self,
        around: &PairConditions,
        limit_from: LimitFrom,
        stiffness: f64,
        way: V3,
        slide: V3,
    ) -> (ContactResponse, Grip) {
        let mut sum = ContactResponse::default();
        let grip = sum.add_touch(&Touching {
            law: around.law,
            stiffness,
            normal: self.normal,
            pressed: NormalLaw::at(self.depth, around.onset),
            bristle: across(self.bristle + way, &self.normal),
            bristle_stiffness: stiffness * TANGENTIAL_SHARE,
            way,
            step: around.step,
            limit: self.limit,
            limit_from,
            slide,
            negligible: NEGLIGIBLE * around.prediction * stiffness,
        });
        (sum, grip)
    }
}

impl SelfContact {
    /// Evaluates all pairs with the wire at `q`; `last` is the wire at the last accepted instant (core frame, m), `length`
    /// tells what the point of a number stands for, m. Hands the coupling and the response of each touching pair
    /// to `take`, and keeps the couplings in `scratch`.
    ///
    /// The gradient of a response acts on the point; its negative acts on the foot.
    pub fn evaluate(
        &mut self,
        scratch: &mut PairScratch,
        around: &PairConditions,
        (q, last): (&[V3], &[V3]),
        length: impl Fn(usize) -> f64,
        mut take: impl FnMut(&Coupling, &ContactResponse),
    ) {
        let PairScratch {
            couplings,
            near: all_near,
            ..
        } = scratch;
        couplings.clear();
        all_near.clear();
        let curve = self.curve(q);
        for pair in &mut self.pairs {
            let young = ContactPoint::of_number(pair.point as usize).weights();
            let p = young.sum(q);
            let foot = curve.foot(p, pair.segment);
            pair.segment = foot.segment;
            (pair.share, pair.normal) = (foot.share, foot.normal);
            // (a loop that opens leaves no passage to touch: downhill from there lies the point's own wire)
            pair.depth = if foot.segment as usize + 1 >= pair.node_before() {
                -around.diameter
            } else {
                foot.depth(around.diameter)
            };
            let old = NodeWeights::from(curve.weights(foot.segment as usize, foot.share));
            let stiffness = around.law.stiffness * length(pair.point as usize);
            let mut near = NearPair {
                pair: all_near.len() as u32,
                young,
                old: old.negative(),
                stiffness,
                gradient: V3::zeros(),
                hessian: Block::default(),
                slip_coupling: Block::default(),
                room: (-pair.depth).max(0.0),
                predicted: false,
                slide: V3::zeros(),
                held: f64::INFINITY,
                coupling: None,
            };
            if pair.depth <= 0.0 {
                pair.limit.lift();
                all_near.push(near);
                continue;
            }
            let way = (p - young.sum(last)) - (foot.point - old.sum(last));
            let (response, grip) =
                pair.respond(around, around.limit_from, stiffness, way, V3::zeros());
            pair.limit = grip.limit;
            near.coupling = Some(couplings.len() as u32);
            (near.gradient, near.hessian) = (response.gradient, response.hessian);
            near.slip_coupling = response.slip_coupling;
            near.slide = grip.slide;
            all_near.push(near);
            let coupling = Coupling {
                young,
                old: near.old,
                block: response.hessian,
            };
            take(&coupling, &response);
            couplings.push(coupling);
        }
    }

    /// Does for pairs what [`LineContact::predict`](crate::contact::LineContact::predict) does for points. The wire is
    /// at the iterate `q`, was at `last` at the last accepted instant, and the update leads to `there`. `correct` gets the
    /// point, its foot with negative weights, and the changes of Hessian and gradient.
    pub fn predict(
        &mut self,
        scratch: &mut PairScratch,
        around: &PairConditions,
        (q, last, there): (&[V3], &[V3], &[V3]),
        mut correct: impl FnMut(&NodeWeights, &NodeWeights, &Block, &V3),
    ) -> bool {
        let PairScratch {
            couplings,
            near: all_near,
            ..
        } = scratch;
        let mut any = false;
        let curve = self.curve(there);
        let tolerance = around.prediction;
        for near in all_near {
            let relative = |q: &[V3]| near.young.sum(q) + near.old.sum(q);
            let way = relative(there) - relative(q);
            let far = way.norm_squared();
            // the foot moves along with its wire, whose turning is small beside that
            let still = far <= tolerance * tolerance && !near.predicted;
            if 4.0 * far < near.room * near.room || still {
                continue;
            }
            let now = self.pairs[near.pair as usize];
            let foot = curve.foot(near.young.sum(there), now.segment);
            let pair = Pair {
                depth: foot.depth(around.diameter),
                normal: foot.normal,
                ..now
            };
            let (mut gradient, mut hessian, mut held) =
                (V3::zeros(), Block::default(), f64::INFINITY);
            if pair.depth > 0.0 {
                let slid = relative(there) - relative(last);
                let (response, grip) =
                    pair.respond(around, LimitFrom::Current, near.stiffness, slid, near.slide);
                (gradient, hessian) = (response.gradient, response.hessian);
                (near.slide, held) = (grip.slide, grip.held);
            }
            let off = gradient - near.gradient - block_times(&near.hessian, &way);
            if off.amax() <= (tolerance * near.stiffness).min(near.held) {
                continue;
            }
            any = true;
            gradient -= block_times(&hessian, &way);
            let more = block_difference(&hessian, &near.hessian);
            correct(&near.young, &near.old, &more, &(gradient - near.gradient));
            let at = *near.coupling.get_or_insert_with(|| {
                couplings.push(Coupling {
                    young: near.young,
                    old: near.old,
                    block: Block::default(),
                });
                couplings.len() as u32 - 1
            });
            couplings[at as usize].block = hessian;
            (near.gradient, near.hessian, near.room) = (gradient, hessian, 0.0);
            near.slip_coupling = Block::default();
            self.pairs[near.pair as usize].limit.follows = false;
            (near.predicted, near.held) = (true, held);
        }
        any
    }
}
