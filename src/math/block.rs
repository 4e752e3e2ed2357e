//! 3 by 3 blocks of Hessians.

use super::V3;

/// A 3 by 3 block of a Hessian, row by row.
pub type Block = [[f64; 3]; 3];

/// Adds `a b^T` to `m`.
#[inline]
pub fn add_outer(m: &mut Block, a: &V3, b: &V3) {
    let (a, b) = ([a.x, a.y, a.z], [b.x, b.y, b.z]);
    for (row, a) in m.iter_mut().zip(a) {
        for (x, b) in row.iter_mut().zip(b) {
            *x += a * b;
        }
    }
}

/// Adds `c` times the identity to `m`.
#[inline]
pub fn add_identity(m: &mut Block, c: f64) {
    for (k, row) in m.iter_mut().enumerate() {
        row[k] += c;
    }
}

/// The product `m v`.
#[inline]
pub fn block_times(m: &Block, v: &V3) -> V3 {
    V3::new(
        m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
        m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
        m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z,
    )
}

/// The difference `a - b`.
#[inline]
pub fn block_difference(a: &Block, b: &Block) -> Block {
    std::array::from_fn(|r| std::array::from_fn(|c| a[r][c] - b[r][c]))
}

/// The block `c m`.
#[inline]
pub fn scaled_block(m: &Block, c: f64) -> Block {
    std::array::from_fn(|r| std::array::from_fn(|k| m[r][k] * c))
}
