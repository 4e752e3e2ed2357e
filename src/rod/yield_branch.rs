//! The knees of the laws of bending and twist, looked at ahead.
//!
//! A joint that yields gives way tens of times more easily than one that unloads. Newton's method at one
//! side of the knee promises the other side a moment that is far off, in every joint of a corner at
//! once. So the tangent is taken where the update leads: a joint's angle is linear in the update to
//! good accuracy, and along its own moment the law is scalar.
//!
//! A joint that yields in twist lets all wire on one side roll against that on the other, and rolls without inertia
//! have nothing else to hold them: without a look ahead Newton's method throws them to and fro across the knee, however
//! short the step.

use super::plasticity::{Law, Scalar, respond_scalar};
use crate::math::V3;

/// Joints below this share of their yield moment are left alone.
const FAR: f64 = 0.25;
/// Error of a moment that an update may promise, over the yield moment.
const PROMISE: f64 = 0.01;

/// Joints that may change their branch, by number.
#[derive(Clone, Debug, Default)]
pub struct YieldBranches {
    /// in bending
    pub bending: Vec<(u32, YieldBranch)>,
    /// in twist
    pub twist: Vec<(u32, YieldBranch)>,
}

impl YieldBranches {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.bending.clear();
        self.twist.clear();
    }
}

/// A joint whose law may change its branch.
#[derive(Clone, Copy, Debug)]
pub struct YieldBranch {
    /// derivative of the angle along the moment, of bending or twist, by the edges before and after, 1/m
    pub rows: [V3; 2],
    /// the same by their rolls; 0 where no twist is carried
    pub rolls: [f64; 2],
    /// trial moment, N m, and Voronoi length, m
    pub trial: f64,
    /// see `trial`
    pub length: f64,
    /// rise of the yield moment, N m
    pub rise: f64,
    /// moment at the iterate as the linear system has it, N m
    pub moment: f64,
    /// stiffness against the angle as the linear system has it, N m
    pub stiffness: f64,
    /// the branch that is from: 0 elastic, 1 and -1 yielding along and against the moment
    pub branch: i8,
}

impl YieldBranch {
    /// That of a joint which does not yield, without derivatives of its angle.
    pub fn elastic(trial: f64, rise: f64, length: f64, stiffness: f64) -> Self {
        Self {
            rows: [V3::zeros(); 2],
            rolls: [0.0; 2],
            trial,
            length,
            rise,
            moment: trial,
            stiffness,
            branch: 0,
        }
    }

    /// The same on the branch that its trial moment is on.
    pub fn at_present(self, law: &Law) -> Self {
        let state = Scalar {
            strain: 0.0,
            rise: self.rise,
        };
        let (moment, next, _) = respond_scalar(law, &state, self.trial / law.modulus);
        if next.strain == 0.0 {
            return self;
        }
        Self {
            moment,
            stiffness: law.tangent(next.rise) / self.length,
            branch: 1,
            ..self
        }
    }

    /// Whether a joint is near enough to yielding to be looked at.
    pub fn matters(law: &Law, trial: f64, rise: f64) -> bool {
        trial > FAR * (law.limit + rise)
    }

    /// Puts the tangent at an `angle` farther on in the place of one that promised something else; returns the
    /// changes of stiffness and moment.
    pub fn predict(&mut self, law: &Law, angle: f64) -> Option<(f64, f64)> {
        if self.branch == 0 && (self.trial + self.stiffness * angle).abs() <= law.limit + self.rise
        {
            return None;
        }
        let state = Scalar {
            strain: 0.0,
            rise: self.rise,
        };
        let strain = self.trial / law.modulus + angle / self.length;
        let (moment, next, _) = respond_scalar(law, &state, strain);
        let promised = self.moment + self.stiffness * angle;
        if (moment - promised).abs() <= PROMISE * (law.limit + self.rise) {
            return None;
        }
        let mut branch = match next.strain {
            0.0 => 0,
            yielded if yielded > 0.0 => 1,
            _ => -1,
        };
        if branch == -self.branch {
            // from yielding to yielding the other way: both are soft, so it would be thrown to and fro
            branch = 0;
        }
        let (stiffness, moment) = if branch == 0 {
            (law.modulus / self.length, self.trial)
        } else {
            let stiffness = law.tangent(next.rise) / self.length;
            (stiffness, moment - stiffness * angle)
        };
        let change = (stiffness - self.stiffness, moment - self.moment);
        self.branch = branch;
        self.stiffness += change.0;
        self.moment += change.1;
        Some(change)
    }
}
