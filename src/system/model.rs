//! What does not change in a run: wire, laws, loads, feed, core.

use super::ContactModel;
use crate::feed::FeedSpec;
use crate::geometry::Surface;
use crate::math::V3;
use crate::rod::{Laws, Section, Twist};
use std::sync::Arc;

/// Loads besides contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// acceleration on every mass point, m/s^2
    pub gravity: V3,
    /// dead forces on nodes, N
    pub nodal: Vec<(usize, V3)>,
    /// dead moments on edges, N m, lab frame
    pub moments: Vec<(usize, V3)>,
    /// drag per mass, 1/s (verification only: lets a static answer settle)
    pub drag: f64,
}

/// How the wire's mass goes with its nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mass {
    /// each node carries the mass of the length it stands for
    #[default]
    Lumped,
    /// as straight edges carry it, whose points move in proportion to their ends: 1/3 of an edge's mass on either end
    /// and 1/6 between them, which takes away the leading error of bending waves. For the implicit method, and wire that nothing feeds
    Consistent,
}

/// What the scene gives and a run leaves as it is.
#[derive(Clone, Debug)]
pub struct Model {
    /// section of the wire
    pub section: Section,
    /// its laws
    pub laws: Laws,
    /// how its mass goes with its nodes
    pub mass: Mass,
    /// how twist is carried; the explicit methods know no quasi-static one
    pub twist: Twist,
    /// loads besides contact
    pub loads: Loads,
    /// feed at the last node, if there is one
    pub feed: Option<FeedSpec>,
    /// what the wire touches and how
    pub contact: ContactModel,
    /// the core's mesh, if there is a core that has one
    pub core: Option<Arc<Surface>>,
}

impl Model {
    /// Whether the wire is prepared for the steps of the implicit method. Contact along the wire is made for these; wire that
    /// touches nothing is prepared as for the explicit methods.
    pub(crate) fn is_for_implicit_steps(&self) -> bool {
        self.contact.is_line()
    }
}
