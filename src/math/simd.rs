//! The same arithmetic on many numbers at once, as wide as the machine can.
//!
//! Formulas are written once, for [`Lanes`] of numbers that never meet. Each lane rounds as a lone
//! number would (no fused multiply-add, no other order). So results are the same to the bit with
//! one lane, with four (AVX2) and with eight (AVX-512). What the machine has is found out at run
//! time; only what is inlined into [`run`] is compiled for it, and closures may not be. Numbers of
//! a kind lie side by side, in columns of eight rows ([`RowBlock`]).

use crate::math::V3;
use pulp::Simd;
pub use pulp::WithSimd;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};
use std::sync::atomic::{AtomicU8, Ordering};

/// How many numbers one instruction works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
pub enum Width {
    /// one: any machine
    One = 1,
    /// four: AVX2
    Four = 4,
    /// eight: AVX-512
    Eight = 8,
}

/// Eight are slower than four in whole runs on the machine that was measured (the processor lowers
/// its clock).
static WIDEST: AtomicU8 = AtomicU8::new(Width::Four as u8);

/// Limits [`run`] to `width` numbers at once from here on, in the whole process.
///
/// For tests and measurements; results do not depend on it.
pub fn at_most(width: Width) {
    WIDEST.store(width as u8, Ordering::Relaxed);
}

/// The width that [`run`] works with.
pub fn width() -> Width {
    struct Count;
    impl WithSimd for Count {
        type Output = usize;
        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) -> usize {
            S::F64_LANES
        }
    }
    match run(Count) {
        8 => Width::Eight,
        4 => Width::Four,
        _ => Width::One,
    }
}

/// Runs `work` compiled for the widest numbers that the machine has and [`at_most`] allows.
#[inline]
pub fn run<Op: WithSimd>(work: Op) -> Op::Output {
    #[cfg(target_arch = "x86_64")]
    {
        let widest = WIDEST.load(Ordering::Relaxed);
        if widest >= Width::Eight as u8
            && let Some(simd) = pulp::x86::V4::try_new()
        {
            return Simd::vectorize(simd, work);
        }
        if widest >= Width::Four as u8
            && let Some(simd) = pulp::x86::V3::try_new()
        {
            return Simd::vectorize(simd, work);
        }
    }
    Simd::vectorize(pulp::Scalar, work)
}

/// As many numbers as one instruction works on.
#[derive(Debug)]
pub struct Lanes<S: Simd> {
    simd: S,
    v: S::f64s,
}

impl<S: Simd> Clone for Lanes<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Lanes<S> {}

impl<S: Simd> Lanes<S> {
    /// Number of lanes.
    pub const COUNT: usize = S::F64_LANES;

    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(simd: S, x: f64) -> Self {
        Self {
            simd,
            v: simd.splat_f64s(x),
        }
    }

    /// The first numbers of a slice.
    #[inline(always)]
    pub fn load(simd: S, from: &[f64]) -> Self {
        Self {
            simd,
            v: S::as_simd_f64s(&from[..Self::COUNT]).0[0],
        }
    }

    /// Writes the lanes into the first numbers of a slice.
    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        S::as_mut_simd_f64s(&mut to[..Self::COUNT]).0[0] = self.v;
    }

    /// Square root of each lane.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.sqrt_f64s(self.v),
        }
    }

    /// Inverse of each lane.
    #[inline(always)]
    pub fn recip(self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.div_f64s(self.simd.splat_f64s(1.0), self.v),
        }
    }

    /// Quotient of each lane by that of `other`.
    #[inline(always)]
    pub fn over(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.div_f64s(self.v, other.v),
        }
    }

    /// Negated in those lanes where `sign` is below 0.
    #[inline(always)]
    pub fn with_sign_of(self, sign: Self) -> Self {
        let below = self.simd.less_than_f64s(sign.v, self.simd.splat_f64s(0.0));
        Self {
            simd: self.simd,
            v: self.simd.select_f64s(below, (-self).v, self.v),
        }
    }

    /// `least` in those lanes that are below it.
    #[inline(always)]
    pub fn at_least(self, least: f64) -> Self {
        let least = self.simd.splat_f64s(least);
        let below = self.simd.less_than_f64s(self.v, least);
        Self {
            simd: self.simd,
            v: self.simd.select_f64s(below, least, self.v),
        }
    }

    /// `other` in those lanes where `test` is not above 0.
    #[inline(always)]
    pub fn unless_above_zero(self, test: Self, other: Self) -> Self {
        let zero = self.simd.splat_f64s(0.0);
        let above = self.simd.less_than_f64s(zero, test.v);
        Self {
            simd: self.simd,
            v: self.simd.select_f64s(above, self.v, other.v),
        }
    }

    /// 1 in those lanes that are above `limit`, 0 elsewhere.
    #[inline(always)]
    pub fn above(self, limit: Self) -> Self {
        let above = self.simd.less_than_f64s(limit.v, self.v);
        let [zero, one] = [0.0, 1.0].map(|x| self.simd.splat_f64s(x));
        Self {
            simd: self.simd,
            v: self.simd.select_f64s(above, one, zero),
        }
    }

    /// Size of each lane.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.abs_f64s(self.v),
        }
    }

    /// The largest lane of numbers that are all finite.
    #[inline(always)]
    pub fn most(self) -> f64 {
        self.simd.reduce_max_f64s(self.v)
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn all(self, x: f64) -> Self {
        Self::splat(self.simd, x)
    }
}

impl<S: Simd> Add for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.add_f64s(self.v, other.v),
        }
    }
}

impl<S: Simd> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> Sub for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.sub_f64s(self.v, other.v),
        }
    }
}

impl<S: Simd> Mul for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.mul_f64s(self.v, other.v),
        }
    }
}

impl<S: Simd> Mul<f64> for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, x: f64) -> Self {
        self * self.all(x)
    }
}

impl<S: Simd> Add<f64> for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, x: f64) -> Self {
        self + self.all(x)
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            simd: self.simd,
            v: self.simd.neg_f64s(self.v),
        }
    }
}

/// As many vectors as [`Lanes`] are numbers.
#[derive(Debug)]
pub struct Lanes3<S: Simd> {
    /// first components
    pub x: Lanes<S>,
    /// second components
    pub y: Lanes<S>,
    /// third components
    pub z: Lanes<S>,
}

impl<S: Simd> Clone for Lanes3<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Lanes3<S> {}

impl<S: Simd> Lanes3<S> {
    /// From components.
    #[inline(always)]
    pub fn new(x: Lanes<S>, y: Lanes<S>, z: Lanes<S>) -> Self {
        Self { x, y, z }
    }

    /// Components.
    #[inline(always)]
    pub fn components(self) -> [Lanes<S>; 3] {
        [self.x, self.y, self.z]
    }

    /// Scalar products.
    #[inline(always)]
    pub fn dot(self, b: Self) -> Lanes<S> {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Vector products.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y * b.z - self.z * b.y,
            y: self.z * b.x - self.x * b.z,
            z: self.x * b.y - self.y * b.x,
        }
    }
}

impl<S: Simd> Add for Lanes3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<S: Simd> Sub for Lanes3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<S: Simd> Neg for Lanes3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<S: Simd> Mul<Lanes<S>> for Lanes3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, c: Lanes<S>) -> Self {
        Self::new(self.x * c, self.y * c, self.z * c)
    }
}

/// Rows that lie together in a [`RowBlock`]: as many as there may be lanes.
pub const ROWS: usize = 8;

/// `N` columns of eight rows each, with the row before them and the one after them.
///
/// Loads begin at offset 0 (rows shifted back by one), 1 (the rows) or 2 (shifted on by one). They
/// never leave the block: nothing to check at run time, and all of it close together in memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct RowBlock<const N: usize>([[f64; ROWS + 2]; N]);

impl<const N: usize> Default for RowBlock<N> {
    fn default() -> Self {
        Self([[0.0; ROWS + 2]; N])
    }
}

impl<const N: usize> RowBlock<N> {
    /// Lanes of column `k` from row `first` of the block on, shifted by `offset - 1`.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S, k: usize, first: usize, offset: usize) -> Lanes<S> {
        Lanes::load(simd, &self.0[k][first + offset..])
    }

    /// Lanes of columns `k`, `k + 1` and `k + 2`.
    #[inline(always)]
    pub fn load3<S: Simd>(&self, simd: S, k: usize, first: usize, offset: usize) -> Lanes3<S> {
        Lanes3::new(
            self.load(simd, k, first, offset),
            self.load(simd, k + 1, first, offset),
            self.load(simd, k + 2, first, offset),
        )
    }

    /// Lanes of columns `k` to `k + M - 1`.
    #[inline(always)]
    pub fn load_all<S: Simd, const M: usize>(
        &self,
        simd: S,
        k: usize,
        first: usize,
        offset: usize,
    ) -> [Lanes<S>; M] {
        // (a closure, as `from_fn` takes, would not be compiled for wide numbers)
        let mut all = [Lanes::splat(simd, 0.0); M];
        for a in 0..M {
            all[a] = self.load(simd, k + a, first, offset);
        }
        all
    }

    /// Lanes into column `k` from row `first` of the block on.
    #[inline(always)]
    pub fn store<S: Simd>(&mut self, k: usize, first: usize, lanes: Lanes<S>) {
        lanes.store(&mut self.0[k][first + 1..]);
    }

    /// Lanes into columns `k`, `k + 1` and `k + 2`.
    #[inline(always)]
    pub fn store3<S: Simd>(&mut self, k: usize, first: usize, lanes: Lanes3<S>) {
        self.store(k, first, lanes.x);
        self.store(k + 1, first, lanes.y);
        self.store(k + 2, first, lanes.z);
    }

    /// Number of column `k` in row `row`; `ROWS` is the row after the block.
    #[inline(always)]
    pub fn get(&self, k: usize, row: usize) -> f64 {
        self.0[k][row + 1]
    }

    /// Numbers of columns `k`, `k + 1` and `k + 2` in row `row`.
    #[inline(always)]
    pub fn vector(&self, k: usize, row: usize) -> V3 {
        V3::new(self.get(k, row), self.get(k + 1, row), self.get(k + 2, row))
    }

    /// Writes the number of column `k` in row `row`.
    #[inline(always)]
    pub fn set(&mut self, k: usize, row: usize, x: f64) {
        self.0[k][row + 1] = x;
    }

    /// Number of column `k` in the row before the block.
    #[inline(always)]
    pub fn before(&self, k: usize) -> f64 {
        self.0[k][0]
    }

    /// The row before this block is the last of `before`, whose row after is the first of this.
    #[inline(always)]
    pub fn follow(&mut self, before: &mut Self) {
        for (own, other) in self.0.iter_mut().zip(&mut before.0) {
            own[0] = other[ROWS];
            other[ROWS + 1] = own[1];
        }
    }
}

/// `N` columns of numbers, block by block.
#[derive(Clone, Debug, Default)]
pub struct Columns<const N: usize>(Vec<RowBlock<N>>);

impl<const N: usize> Columns<N> {
    /// Makes room for `rows` rows; what is new is 0.
    pub fn fit(&mut self, rows: usize) {
        self.0.resize(rows.div_ceil(ROWS), RowBlock::default());
    }

    /// All blocks.
    #[inline(always)]
    pub fn blocks(&self) -> &[RowBlock<N>] {
        &self.0
    }

    /// All blocks, to be written.
    #[inline(always)]
    pub fn blocks_mut(&mut self) -> &mut [RowBlock<N>] {
        &mut self.0
    }

    /// Number `i` of column `k`.
    #[inline(always)]
    pub fn get(&self, k: usize, i: usize) -> f64 {
        self.0[i / ROWS].get(k, i % ROWS)
    }

    /// Puts number `i` of column `k`.
    #[inline(always)]
    pub fn set(&mut self, k: usize, i: usize, x: f64) {
        self.0[i / ROWS].set(k, i % ROWS, x);
    }

    /// Columns `k`, `k + 1` and `k + 2` at row `i`.
    #[inline(always)]
    pub fn vector(&self, k: usize, i: usize) -> V3 {
        let (block, row) = self.row(i);
        block.vector(k, row)
    }

    /// The block of row `i`, and the number of the row in it.
    #[inline(always)]
    pub fn row(&self, i: usize) -> (&RowBlock<N>, usize) {
        (&self.0[i / ROWS], i % ROWS)
    }

    /// The block of row `i`, to be written, and the number of the row in it.
    #[inline(always)]
    pub fn row_mut(&mut self, i: usize) -> (&mut RowBlock<N>, usize) {
        (&mut self.0[i / ROWS], i % ROWS)
    }

    /// Puts columns `k`, `k + 1` and `k + 2` at row `i`.
    #[inline(always)]
    pub fn set_vector(&mut self, k: usize, i: usize, v: &V3) {
        let (block, row) = (&mut self.0[i / ROWS], i % ROWS);
        block.set(k, row, v.x);
        block.set(k + 1, row, v.y);
        block.set(k + 2, row, v.z);
    }

    /// Lets `set` put each of `values` into its row of its block.
    #[inline(always)]
    pub fn put<T>(&mut self, values: &[T], set: impl Fn(&mut RowBlock<N>, usize, &T)) {
        for (block, values) in self.0.iter_mut().zip(values.chunks(ROWS)) {
            for (row, value) in values.iter().enumerate() {
                set(block, row & (ROWS - 1), value);
            }
        }
    }

    /// Puts the rows next to each block into it; the row before the first is left as it is.
    #[inline(always)]
    pub fn join(&mut self) {
        for i in 1..self.0.len() {
            let (before, rest) = self.0.split_at_mut(i);
            rest[0].follow(&mut before[i - 1]);
        }
    }

    /// Puts number `k` of the row before the first.
    pub fn set_before(&mut self, k: usize, x: f64) {
        self.0[0].0[k][0] = x;
    }
}
