//! An iterate becomes accepted: friction limits, bristles, losses; and the energy that pairs store.

use super::pairs::SelfContact;
use crate::contact::accepted_touch::{AcceptedTouch, OUTSIDE, TouchOwner, friction_of};
use crate::contact::friction::{FrictionLimit, across};
use crate::contact::law::{ContactLaw, NormalLaw, TANGENTIAL_SHARE, work_beyond_stored};
use crate::contact::stencil::{ContactPoint, NodeWeights};
use crate::math::V3;

impl SelfContact {
    /// Makes the friction limits of the iterate in hand the lagged ones.
    pub fn renew_limits(&mut self) {
        for p in &mut self.pairs {
            p.limit.lagged = p.limit.current;
        }
    }

    /// Makes the wire at `q` the accepted one: bristles follow, slip and landings are added to the losses. `last` is the
    /// wire at the last accepted instant. See [`LineContact::commit`](crate::contact::LineContact::commit).
    ///
    /// `used` are the friction limits that the solve went by, pair by pair. Adds the touches to `accepted`.
    pub fn commit(
        &mut self,
        (law, onset): (&ContactLaw, f64),
        (q, last): (&[V3], &[V3]),
        length: impl Fn(usize) -> f64,
        used: &[FrictionLimit],
        accepted: &mut Vec<AcceptedTouch>,
    ) {
        let curve = self.curve(q);
        for (number, pair) in self.pairs.iter_mut().enumerate() {
            pair.limit.accept();
            if pair.depth <= 0.0 {
                pair.touched = false;
                (pair.bristle, pair.rebound) = (V3::zeros(), 0.0);
                continue;
            }
            let young = ContactPoint::of_number(pair.point as usize).weights();
            let old = NodeWeights::from(curve.weights(pair.segment as usize, pair.share));
            let way = (young.sum(q) - young.sum(last)) - (old.sum(q) - old.sum(last));
            let n = pair.normal;
            let b = across(pair.bristle + way, &n);
            let stiffness = law.stiffness * length(pair.point as usize);
            let k_t = stiffness * TANGENTIAL_SHARE;
            let size = b.norm();
            let deeper = -way.dot(&n);
            let lands = !pair.touched && pair.depth - deeper <= OUTSIDE * onset;
            let spring = NormalLaw::at(pair.depth, onset);
            let force = stiffness * spring.force;
            let (friction, surplus) =
                friction_of(&b, k_t, pair.limit.current, used[number].used(force));
            accepted.push(AcceptedTouch {
                point: ContactPoint::of_number(pair.point as usize),
                old: Some(old.negative()),
                normal: n,
                force: n * force + friction,
                surplus,
                began: !pair.touched,
                lands,
                rebound: pair.rebound,
                owner: TouchOwner::Pair(number),
            });
            if lands {
                self.loss.damping +=
                    stiffness * work_beyond_stored(spring.force, spring.energy, deeper);
            }
            let share = if lands { 0.5 } else { 1.0 };
            pair.touched = true;
            pair.bristle = b;
            if k_t * size > pair.limit.current {
                let kept = pair.limit.current / k_t;
                pair.bristle = b * (kept / size);
                self.loss.friction += share * pair.limit.current * (size - kept);
            }
        }
    }

    /// The friction limits, pair by pair, into `limits`.
    pub fn limits(&self, limits: &mut Vec<FrictionLimit>) {
        limits.clear();
        limits.extend(self.pairs.iter().map(|p| p.limit));
    }

    /// Energy stored in the touches, J; `length` tells what the point of a number stands for, m.
    pub fn stored(&self, law: &ContactLaw, onset: f64, length: impl Fn(usize) -> f64) -> f64 {
        self.pairs
            .iter()
            .filter(|p| p.depth > 0.0)
            .map(|p| {
                let k_n = law.stiffness * length(p.point as usize);
                k_n * NormalLaw::at(p.depth, onset).energy
                    + 0.5 * k_n * TANGENTIAL_SHARE * p.bristle.norm_squared()
            })
            .sum()
    }
}
