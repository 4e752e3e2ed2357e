//! What the scene gives of contact at the nodes, and a run leaves as it is.

use crate::contact::law::ContactLaw;
use crate::geometry::Surface;
use std::sync::Arc;

/// Distance beyond touching within which surfaces are listed, in wire diameters. Chosen: a handful of triangles lies within,
/// and the list lasts some steps.
const SKIN: f64 = 0.1;

/// Core, law and wire of contact at the nodes.
#[derive(Clone, Debug)]
pub struct NodalModel {
    /// the core's mesh
    pub surface: Arc<Surface>,
    /// the law
    pub law: ContactLaw,
    /// radius with which the wire touches, m (0: the centreline itself touches)
    pub radius: f64,
    /// diameter of the wire, m
    pub diameter: f64,
}

impl NodalModel {
    /// Way beyond touching that a search covers, m.
    pub(super) fn skin(&self) -> f64 {
        SKIN * self.diameter
    }
}
