//! Defects of settled wire: their kinds, their limits, and how they are reported.

use serde::Serialize;

/// Limits of the defect flags.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DefectLimits {
    /// gap above which a station counts, diameters
    pub gap: f64,
    /// least length of a run of such stations, as a fraction of a turn
    pub gap_fraction: f64,
    /// height over the quasi-static height above which wire bulges, diameters
    pub bulge_excess: f64,
    /// absolute bulge limit, m; 0: use `bulge_excess`
    pub bulge_absolute: f64,
    /// axial distance to the neighbour below which wire may overlap, diameters
    pub overlap_axial: f64,
    /// height over its layer from which on such wire overlaps, diameters
    pub overlap_height: f64,
    /// polar angle after the clamp in which nothing is judged, rad
    pub skip_angle: f64,
}

/// Kinds of defect that are measured on settled wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DefectKind {
    Bulge = 0,
    Gap = 1,
    Overlap = 2,
}

impl DefectKind {
    pub(crate) const ALL: [Self; 3] = [Self::Bulge, Self::Gap, Self::Overlap];
}

/// Defects present in the settled wire. A flag falls only when the spindle unwinds the defect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DefectFlags {
    /// wire stands off further than allowed
    pub bulge: bool,
    /// wire lies beside its place
    pub gap: bool,
    /// wire rides on its neighbour or has changed places with it
    pub overlap: bool,
}

/// Where a defect was found: the end of the first run long enough to count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DefectPlace {
    /// turn, from 1
    pub turn: u32,
    /// polar angle from the clamp within that turn, rad in 0..2 pi
    pub angle: f64,
}
