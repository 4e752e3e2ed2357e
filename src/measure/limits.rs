//! When a measure becomes a defect.

/// Limits of the defect flags, lengths in wire diameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DefectLimits {
    /// gap above this ...
    pub gap: f64,
    /// ... over at least this fraction of a turn in one run
    pub gap_fraction: f64,
    /// height over the quasi-static height
    pub bulge_excess: f64,
    /// absolute bulge limit, m; 0: use `bulge_excess`
    pub bulge_absolute: f64,
    /// axial distance to the neighbour below this ...
    pub overlap_axial: f64,
    /// ... while standing above its layer by this
    pub overlap_height: f64,
    /// polar angle after the clamp that is left out, rad
    pub skip_angle: f64,
}
