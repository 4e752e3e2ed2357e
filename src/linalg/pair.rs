//! Two numbers worked on together: one of the chain from the first node, one of the chain from the
//! last.

use std::ops::{Add, Mul, Sub};

/// Share of its original diagonal that a pivot must exceed.
///
/// Cancellation leaves an error of a few rounding units of the diagonal; 64 of them keep an exactly
/// singular matrix from passing, and allow stiffness to exceed inertia by 1e13.
const SAFE_SHARE: f64 = 64.0 * f64::EPSILON;

/// One number of the chain from the first node, one of the chain from the last.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(16))]
pub(super) struct Pair(pub(super) [f64; 2]);

impl Add for Pair {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Pair {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Pair {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl Pair {
    #[inline(always)]
    pub(super) fn reciprocal(self) -> Self {
        Self([1.0 / self.0[0], 1.0 / self.0[1]])
    }

    #[inline(always)]
    pub(super) fn is_safe(self, original: Self) -> bool {
        is_safe(self.0[0], original.0[0]) & is_safe(self.0[1], original.0[1])
    }
}

/// Whether a pivot, given by its reciprocal, exceeds its share of the original diagonal.
///
/// False for zero, negative, infinite and undefined pivots too.
#[inline(always)]
pub(super) fn is_safe(reciprocal: f64, original: f64) -> bool {
    (reciprocal > 0.0) & (reciprocal * (SAFE_SHARE * original) < 1.0)
}

/// A block of both chains.
pub(super) type PairBlock<const D: usize> = [[Pair; D]; D];
