//! Vectors, 3 by 3 blocks, frames and angles, arithmetic on many numbers at once, and a stack whose
//! copies share what is covered.

mod angle;
mod block;
mod frame;
mod persistent_vec;
mod scale;
mod segment;
pub mod simd;
mod vector;

pub use angle::{polar_angle, unwrap_angles, wrap_to_pi};
pub use block::{Block, add_identity, add_outer, block_difference, block_times, scaled_block};
pub use frame::{align, frame_along, relative, rotate, rotate_back, turn_about_y};
pub use persistent_vec::PersistentVec;
pub use scale::scaled;
pub use segment::{closest_point_segment, nearest_shares};
pub use vector::{M3, Quat, Spin, V3, spin_velocity};
