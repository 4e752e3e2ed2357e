//! Contact with core, frozen wire and live wire, against slow twins, finite differences and known landings.

mod brute;
mod core_shape;
mod derivatives;
mod landing;
mod pairs;
mod parts;
mod search;
