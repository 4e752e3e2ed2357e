//! One touch of a contact point: the normal law, the bristle of friction, and what they push with.

use super::law::{ContactLaw, TANGENTIAL_SHARE};
use crate::math::V3;
use crate::rod::{Block, add_outer};
use serde::{Deserialize, Serialize};

/// Share of the zero stiffness of a sliding bristle along its slide that the Hessian takes over. With
/// all of it updates overshoot to the far side of the anchor, with none they crawl.
pub(super) const ALONG_SLIDE: f64 = 0.9;

/// What the touches of one point add to potential, gradient and Hessian.
#[derive(Clone, Copy, Debug, Default)]
pub struct Push {
    /// potential with the friction limits of the iterate before, J
    pub energy_lagged: f64,
    /// potential with the limits of this one, J
    pub energy: f64,
    /// gradient with respect to the point, N
    pub gradient: V3,
    /// Hessian with respect to the point, N/m
    pub hessian: Block,
}

/// One possible touch of a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Touch {
    /// where to look for the closest point of frozen wire
    pub(super) start: u32,
    /// whether an anchor holds
    pub(super) held: bool,
    /// core frame, m
    pub(super) anchor: V3,
    /// largest friction force by the normal force of the last iterate, N
    pub(super) lag: f64,
    /// the same at the last accepted instant, N
    pub(super) kept: f64,
    /// the same by the iterate in hand, N
    pub(super) fresh: f64,
    /// direction of the slide as the linear system has it; 0: the bristle holds
    pub(super) slide: V3,
    pub(super) normal: V3,
    pub(super) depth: f64,
    /// depth at the last accepted instant, 0: none, m
    pub(super) before: f64,
}

/// Nothing touched yet.
pub(super) const NONE: Touch = Touch {
    start: u32::MAX,
    held: false,
    anchor: V3::new(0.0, 0.0, 0.0),
    lag: 0.0,
    kept: 0.0,
    fresh: 0.0,
    slide: V3::new(0.0, 0.0, 0.0),
    normal: V3::new(0.0, 0.0, 0.0),
    depth: 0.0,
    before: 0.0,
};

impl Touch {
    /// Adds the push of a touch with `depth` and `normal` at `p`; returns its own friction limit, N, and the
    /// direction of its slide.
    #[inline]
    pub(super) fn push(&self, p: V3, c: &Circumstances, sum: &mut Push) -> (f64, V3) {
        let (e, f, s) = if c.brake > 0.0 {
            damped_law(self.depth, c.onset, c.brake, self.before)
        } else {
            onset_law(self.depth, c.onset)
        };
        let n = self.normal;
        let force = c.stiffness * f;
        sum.energy += c.stiffness * e;
        sum.energy_lagged += c.stiffness * e;
        sum.gradient -= n * force;
        let mut along = c.stiffness * s;
        let (mut limit, mut slide) = (0.0, V3::zeros());
        if c.law.mu_static > 0.0 {
            limit = match c.limit {
                Limit::Lagged => self.lag,
                Limit::Latest => self.fresh,
                Limit::Own => {
                    let way = p - c.last;
                    let slide = (way - n * way.dot(&n)).norm() / c.step;
                    c.law.mu(slide) * force
                }
            };
            let (b, k_t) = bristle(self, p, c.last, c.stiffness * TANGENTIAL_SHARE, c.brake);
            let size = b.norm();
            sum.energy_lagged += huber(k_t, self.lag, size);
            sum.energy += huber(k_t, limit, size);
            let dir = b / size;
            // from sliding to sliding the other way: it would be thrown to and fro
            let turns = c.limit == Limit::Latest && dir.dot(&self.slide) < 0.0;
            if k_t * size <= limit || turns {
                sum.gradient += b * k_t;
                add_identity(&mut sum.hessian, k_t);
                along -= k_t;
            } else {
                slide = dir;
                sum.gradient += dir * limit;
                let h = limit / size;
                add_identity(&mut sum.hessian, h);
                add_outer(&mut sum.hessian, &(dir * (-ALONG_SLIDE * h)), &dir);
                along -= h;
            }
        }
        add_outer(&mut sum.hessian, &(n * along), &n);
        (limit, slide)
    }
}

/// Which friction limit a push takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Limit {
    /// that of the iterate before
    Lagged,
    /// by its own normal force
    Own,
    /// that of the last evaluation
    Latest,
}

/// What a push depends on besides the touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circumstances<'a> {
    pub(super) law: &'a ContactLaw,
    pub(super) onset: f64,
    /// stiffness of what the point stands for, N/m
    pub(super) stiffness: f64,
    /// dashpot over stiffness, for this step
    pub(super) brake: f64,
    pub(super) step: f64,
    /// place at the last accepted instant, m
    pub(super) last: V3,
    pub(super) limit: Limit,
}

/// Stretch of a touch's bristle and its stiffness, with a dashpot of `brake` times the stiffness `k`
/// against the way from `last`: together a stiffer bristle from a place in between.
#[inline]
pub(super) fn bristle(touch: &Touch, p: V3, last: V3, k: f64, brake: f64) -> (V3, f64) {
    let anchor = if touch.held { touch.anchor } else { last };
    let anchor = if brake > 0.0 {
        (anchor + last * brake) / (1.0 + brake)
    } else {
        anchor
    };
    let b = p - anchor;
    let b = b - touch.normal * b.dot(&touch.normal);
    (b, k * (1.0 + brake))
}

/// Energy, force and stiffness over contact stiffness at a depth: quadratic up to the onset depth,
/// then linear.
#[inline]
pub(super) fn onset_law(depth: f64, onset: f64) -> (f64, f64, f64) {
    if depth < onset {
        let s = depth / onset;
        (s * depth * depth / 6.0, 0.5 * s * depth, s)
    } else {
        (
            0.5 * depth * depth - 0.5 * depth * onset + onset * onset / 6.0,
            depth - 0.5 * onset,
            1.0,
        )
    }
}

/// Work of a touch that acts at one end of a step only, on a `way` over which the books take half its `force`, beyond the
/// `energy` it stores at that end; all over its stiffness, see [`super::LineContact::commit`].
#[inline]
pub(super) fn unstored(force: f64, energy: f64, way: f64) -> f64 {
    0.5 * force * way - energy
}

/// [`onset_law`] with a dashpot of `brake` times the stiffness against the way in from the depth `before`.
///
/// A dashpot alone would pull on what leaves faster than the spring can push. Here the sum ends where
/// it is 0, so that the potential stays convex and without a kink.
#[inline]
pub(super) fn damped_law(depth: f64, onset: f64, brake: f64, before: f64) -> (f64, f64, f64) {
    let sum = |depth: f64| {
        let (e, f, s) = onset_law(depth, onset);
        let way = depth - before;
        (e + 0.5 * brake * way * way, f + brake * way, s + brake)
    };
    if before == 0.0 || brake == 0.0 {
        return sum(depth);
    }
    let linear = (brake * before + 0.5 * onset) / (1.0 + brake);
    let end = if linear >= onset {
        linear
    } else {
        2.0 * brake * before / (brake + (brake * (brake + 2.0 * before / onset)).sqrt())
    };
    if depth <= end {
        return (0.0, 0.0, 0.0);
    }
    let (e, f, s) = sum(depth);
    ((e - sum(end).0).max(0.0), f, s)
}

/// Potential of a bristle of stiffness `k` that gives way at `limit`.
#[inline]
pub(super) fn huber(k: f64, limit: f64, size: f64) -> f64 {
    if k * size <= limit {
        0.5 * k * size * size
    } else {
        limit * (size - 0.5 * limit / k)
    }
}

/// Product of a symmetric block with a vector.
pub(super) fn times(m: &Block, v: &V3) -> V3 {
    V3::new(
        m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
        m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
        m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z,
    )
}

/// Difference of two blocks.
pub(super) fn less(a: &Block, b: &Block) -> Block {
    std::array::from_fn(|r| std::array::from_fn(|c| a[r][c] - b[r][c]))
}

fn add_identity(m: &mut Block, c: f64) {
    for (k, row) in m.iter_mut().enumerate() {
        row[k] += c;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force and stiffness are the derivatives of energy and force, and the force never pulls.
    #[test]
    fn normal_law_is_a_family() {
        let onset = 1e-6;
        for brake in [0.0, 0.3, 20.0] {
            for before in [0.0, 4e-7, 2e-6, 1e-5] {
                for i in 1..400 {
                    let depth = 1.37e-8 * f64::from(i) * (1.0 + 0.01 * f64::from(i));
                    let law = |d: f64| damped_law(d, onset, brake, before);
                    let h = 1e-12;
                    let (e, f, s) = law(depth);
                    let (a, b) = (law(depth - h), law(depth + h));
                    assert!(e >= 0.0 && f >= 0.0 && s >= 0.0);
                    let scale = onset * (1.0 + brake);
                    assert!(((b.0 - a.0) / (2.0 * h) - f).abs() < 1e-4 * scale);
                    // the stiffness jumps where the push ends
                    if a.1 > 0.0 || b.1 == 0.0 {
                        assert!(((b.1 - a.1) / (2.0 * h) - s).abs() < 1e-4 * (1.0 + brake));
                    }
                }
            }
        }
    }
}
