//! Response of one touch of the production method: normal force and friction from one potential.
//!
//! Friction is a spring, the bristle, that gives way at the friction limit: the coefficient times a normal
//! force that is held while the potential is differentiated. For given limits normal and tangential force
//! derive from one potential, with a symmetric Hessian. That the limit follows the normal force adds a derivative which is
//! not symmetric, the slip coupling. Wire on core, wire on frozen wire and wire on
//! live wire use the same law; they differ in where the stretch of the bristle comes from.

use super::law::{ContactLaw, NormalLaw};
use crate::math::{Block, V3, add_identity, add_outer};
use serde::{Deserialize, Serialize};

/// Share of the zero stiffness of a sliding bristle along its slide that the Hessian takes over while the friction limit is held.
/// With all of it updates of lightly pressed wire go to the far side of the anchor and back, with none they crawl.
const ALONG_SLIDE: f64 = 0.9;

/// What the touches of one contact point add to potential, gradient and Hessian of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactResponse {
    /// potential with the friction limits of the iterate before, J
    pub energy_lagged: f64,
    /// potential with the friction limits of this iterate, J
    pub energy: f64,
    /// gradient with respect to the point (minus the force on it), N
    pub gradient: V3,
    /// Hessian with respect to the point, for given friction limits, N/m
    pub hessian: Block,
    /// derivative of the gradient by way of the friction limits that follow the normal force, N/m; not symmetric
    pub slip_coupling: Block,
}

/// The largest friction force of a touch by the normal force of three iterates, N, and the coefficient in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionLimit {
    /// of the iterate accepted last within the step
    pub(super) lagged: f64,
    /// of the last accepted instant
    pub(super) accepted: f64,
    /// of the last evaluation
    pub(super) current: f64,
    /// coefficient of friction by the last evaluation of this solve that went by the speed of the slide; 0: there was none
    #[serde(skip)]
    pub(super) coefficient: f64,
    /// the linear system has the limit follow the normal force
    #[serde(skip)]
    pub(super) follows: bool,
}

impl FrictionLimit {
    /// No friction.
    pub(super) const ZERO: Self = Self {
        lagged: 0.0,
        accepted: 0.0,
        current: 0.0,
        coefficient: 0.0,
        follows: false,
    };

    /// Nothing touches.
    pub(super) fn lift(&mut self) {
        (self.current, self.coefficient, self.follows) = (0.0, 0.0, false);
    }

    /// The friction limit that a solve went by which ended with this normal `force`, N.
    pub(super) fn used(&self, force: f64) -> f64 {
        if self.follows {
            self.coefficient * force
        } else {
            self.current
        }
    }

    /// The last evaluation becomes the accepted instant.
    pub(super) fn accept(&mut self) {
        (self.lagged, self.accepted) = (self.current, self.current);
    }
}

/// Which friction limit a response takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LimitFrom {
    /// that of the iterate before. A guess may lie deep in what it lands on; friction from such a normal force would throw the
    /// wire sideways.
    Lagged,
    /// the normal force of this response, the coefficient by the speed of this slide
    #[default]
    Slide,
    /// the normal force of this response, the coefficient by the last [`LimitFrom::Slide`]. Where friction falls with the speed
    /// of the slide, more than one slide may be in balance; iterates that each had a coefficient of their own would go from
    /// one to the other.
    NormalForce,
    /// that of the last evaluation: the response is that of a prediction, which keeps the limit of the iterate
    Current,
}

/// The state of one touch, as far as its response depends on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touching<'a> {
    pub(super) law: &'a ContactLaw,
    /// contact stiffness of the wire that the point stands for, N/m
    pub(super) stiffness: f64,
    /// unit normal towards the point
    pub(super) normal: V3,
    /// the normal law at the depth
    pub(super) pressed: NormalLaw,
    /// stretch of the bristle, across the normal, m
    pub(super) bristle: V3,
    /// stiffness of the bristle, N/m
    pub(super) bristle_stiffness: f64,
    /// way of the point relative to what it touches since the last accepted instant, m
    pub(super) way: V3,
    /// time since then, s
    pub(super) step: f64,
    pub(super) limit: FrictionLimit,
    pub(super) limit_from: LimitFrom,
    /// direction in which the linear system has the bristle slide; 0: it holds
    pub(super) slide: V3,
    /// friction limit up to which a prediction lets the slide turn at once, N
    pub(super) negligible: f64,
}

/// What a response makes of a bristle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    /// friction limits after it
    pub(super) limit: FrictionLimit,
    /// direction of the slide; 0: it holds
    pub(super) slide: V3,
    /// friction limit of a bristle that a prediction holds although it is stretched beyond that, N; infinite: of none
    pub(super) held: f64,
}

impl ContactResponse {
    /// Adds the response of one touch.
    ///
    /// A prediction that leaves the sliding branch for a slide the other way is evaluated on the sticking branch
    /// once; otherwise the update alternates between both slides.
    #[inline(always)]
    pub(super) fn add_touch(&mut self, t: &Touching) -> Grip {
        let n = t.normal;
        let force = t.stiffness * t.pressed.force;
        let pressed = t.stiffness * t.pressed.energy;
        self.energy += pressed;
        self.energy_lagged += pressed;
        self.gradient -= n * force;
        let mut along = t.stiffness * t.pressed.stiffness;
        let (mut limit, mut slide, mut held) = (0.0, V3::zeros(), f64::INFINITY);
        let (mut coefficient, mut follows) = (t.limit.coefficient, false);
        if t.law.mu_static > 0.0 {
            if t.limit_from == LimitFrom::Slide || coefficient == 0.0 {
                let slid = (t.way - n * t.way.dot(&n)).norm();
                coefficient = t.law.mu(slid / t.step);
            }
            let by_force = matches!(t.limit_from, LimitFrom::Slide | LimitFrom::NormalForce);
            limit = match t.limit_from {
                LimitFrom::Lagged => t.limit.lagged,
                LimitFrom::Current => t.limit.current,
                LimitFrom::Slide | LimitFrom::NormalForce => coefficient * force,
            };
            let (b, k_t) = (t.bristle, t.bristle_stiffness);
            let size = b.norm();
            self.energy_lagged += bristle_energy(k_t, t.limit.lagged, size);
            self.energy += bristle_energy(k_t, limit, size);
            let unit = b / size;
            let slides = k_t * size > limit;
            let turns = t.limit_from == LimitFrom::Current
                && limit > t.negligible
                && unit.dot(&t.slide) < 0.0;
            if !slides || turns {
                if slides {
                    held = limit;
                }
                self.gradient += b * k_t;
                add_identity(&mut self.hessian, k_t);
                along -= k_t;
            } else {
                slide = unit;
                let h = limit / size;
                self.gradient += unit * limit;
                add_identity(&mut self.hessian, h);
                let slack = if t.limit_from == LimitFrom::Lagged {
                    ALONG_SLIDE
                } else {
                    1.0
                };
                add_outer(&mut self.hessian, &(unit * (-slack * h)), &unit);
                along -= h;
                if by_force {
                    follows = true;
                    let stiffness = t.stiffness * t.pressed.stiffness;
                    add_outer(
                        &mut self.slip_coupling,
                        &unit,
                        &(n * (-coefficient * stiffness)),
                    );
                }
            }
        }
        add_outer(&mut self.hessian, &(n * along), &n);
        let limit = FrictionLimit {
            current: limit,
            coefficient,
            follows,
            ..t.limit
        };
        Grip { limit, slide, held }
    }
}

/// Potential (J) of a bristle of stiffness `k` (N/m) and stretch `size` (m) that gives way at the force `limit`
/// (N): Huber's function.
#[inline]
fn bristle_energy(k: f64, limit: f64, size: f64) -> f64 {
    if k * size <= limit {
        0.5 * k * size * size
    } else {
        limit * (size - 0.5 * limit / k)
    }
}

/// The part of `v` across the unit normal `n`.
#[inline]
pub(super) fn across(v: V3, n: &V3) -> V3 {
    v - n * v.dot(n)
}
