//! Where layers are planned to begin.

/// Where a layer begins between flanges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerStart {
    /// inner faces of the flanges along y, m: that towards -y, and the other
    pub faces: [f64; 2],
    /// how far the flanges stand above the core, m
    pub rim: f64,
    /// room that its first turn leaves by plan beside the flange that it goes away from, m
    pub room: f64,
}
