//! Prediction of the branch, elastic or yielding, on which a joint ends a Newton update.
//!
//! A joint that yields is tens of times softer than one that unloads. The tangent of one branch
//! gives a moment that is far off on the other, in every joint of a corner at once. So the tangent
//! is taken from the branch where the update ends. A joint's angle is linear in the update to good
//! accuracy, and along the direction of its moment the law is scalar.
//!
//! A joint that yields in twist lets all wire on one side roll against that on the other, and
//! nothing else holds rolls without inertia. Without the prediction Newton's method alternates
//! between the branches, however short the step.

use super::plasticity::{Law, Scalar, respond_scalar};
use crate::math::V3;

/// Joints below this share of their yield moment are taken as elastic.
pub(super) const FAR: f64 = 0.25;
/// Error of the linear prediction of a moment that is accepted, over the yield moment.
const PREDICTION_ERROR: f64 = 0.01;

/// Joints that may change their branch, each with its number, ascending.
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
    /// derivative of the angle along the moment, of bending or twist, by the edges before and
    /// after, 1/m
    pub rows: [V3; 2],
    /// derivative of that angle by the rolls of the edges before and after; 0 where no twist is
    /// carried
    pub rolls: [f64; 2],
    /// trial moment: the elastic one at the present angle, N m
    pub trial: f64,
    /// Voronoi length of the joint, m
    pub length: f64,
    /// rise of the yield moment, N m
    pub rise: f64,
    /// moment at the iterate as the linear system has it, N m
    pub moment: f64,
    /// stiffness against the angle as the linear system has it, N m
    pub stiffness: f64,
    /// branch of `moment` and `stiffness`: 0 elastic, 1 and -1 yielding along and against the
    /// moment
    pub branch: i8,
}

impl YieldBranch {
    /// A joint that does not yield, without derivatives of its angle: trial moment and rise of the
    /// yield moment (N m), Voronoi length (m), stiffness (N m).
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

    /// Moment and stiffness on the branch that the trial moment is on.
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

    /// Whether a joint with this trial moment and rise of its yield moment, N m, is near enough to
    /// yielding to change its branch in an update.
    pub fn matters(law: &Law, trial: f64, rise: f64) -> bool {
        trial > FAR * (law.limit + rise)
    }

    /// Replaces the tangent by that of the branch on which the joint is after turning by `angle`,
    /// rad.
    ///
    /// Gives the changes of stiffness and moment, N m; `None` where the present tangent predicts
    /// the moment well enough.
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
        let linear = self.moment + self.stiffness * angle;
        if (moment - linear).abs() <= PREDICTION_ERROR * (law.limit + self.rise) {
            return None;
        }
        let mut branch = match next.strain {
            0.0 => 0,
            yielded if yielded > 0.0 => 1,
            _ => -1,
        };
        if branch == -self.branch {
            // from yielding to yielding the other way: both are soft, so that updates would
            // alternate
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
