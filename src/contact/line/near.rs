//! Contact points with surfaces near them, as the linear system sees them.

use crate::math::{Block, V3};

/// A contact point with surfaces near it, and the quadratic model of its potential in the linear system.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearPoint {
    /// its number
    pub(super) point: u32,
    /// length of wire that it stands for, m
    pub(super) length: f64,
    /// place at the iterate, m
    pub(super) place: V3,
    /// tangent at the iterate; none where nothing touches (then there is nothing to write down)
    pub(super) tangent: Option<Tangent>,
    /// way from the iterate without any touch, while the model has none, m
    pub(super) room: f64,
    /// way that the last prediction looked along, m; none: the model is that of the iterate
    pub(super) looked_along: Option<V3>,
    /// least friction limit of its bristles that the model holds beyond that, N; infinite: there is none
    pub(super) held: f64,
}

/// Gradient and Hessian of a contact point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tangent {
    /// gradient at the iterate, N
    pub(super) gradient: V3,
    /// Hessian, N/m
    pub(super) hessian: Block,
    /// see [`ContactResponse::slip_coupling`](crate::contact::ContactResponse::slip_coupling)
    pub(super) slip_coupling: Block,
}
