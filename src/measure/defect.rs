//! Defects of settled wire: their kinds, their limits, and how they are reported.

use serde::{Deserialize, Serialize};

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

/// What a bulge is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "by", rename_all = "snake_case")]
pub enum BulgeLimit {
    /// height over the quasi-static height
    OverRest {
        /// allowed over it, m
        limit_m: f64,
        /// largest quasi-static height, m
        highest_m: f64,
    },
    /// the absolute limit of the scene
    Absolute {
        /// allowed height, m
        limit_m: f64,
    },
    /// an absolute limit of one diameter, since there is no quasi-static height
    Fallback {
        /// allowed height, m
        limit_m: f64,
    },
}

/// Kinds of defect: the first three are measured on settled wire, the others are faults of the wire itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DefectKind {
    /// stands off further than allowed
    Bulge = 0,
    /// lies beside its place
    Gap = 1,
    /// rides on its neighbour or has changed places with it
    Overlap = 2,
    /// the tension at the nozzle fell to zero
    Slack = 3,
    /// the wire parted
    Break = 4,
}

impl DefectKind {
    /// Every kind, the mildest last.
    pub const ALL: [Self; 5] = [
        Self::Break,
        Self::Overlap,
        Self::Gap,
        Self::Bulge,
        Self::Slack,
    ];

    /// Those measured on settled wire.
    pub(crate) const MEASURED: [Self; 3] = [Self::Bulge, Self::Gap, Self::Overlap];

    /// Its bit in `defect_code`.
    pub fn code(self) -> i32 {
        match self {
            Self::Bulge => 1,
            Self::Gap => 2,
            Self::Overlap => 4,
            Self::Break => 8,
            Self::Slack => 16,
        }
    }

    /// The word for it, as in `defects.csv`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Bulge => "bulge",
            Self::Gap => "gap",
            Self::Overlap => "overlap",
            Self::Slack => "slack",
            Self::Break => "break",
        }
    }
}

impl std::fmt::Display for DefectKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

/// One defect: what, where, when and how large. Field names carry the unit, as the tables do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Defect {
    /// what
    pub kind: DefectKind,
    /// turn from 1, on the wire from the clamp
    pub turn: u32,
    /// layer of the wire there, from 1
    pub layer: u32,
    /// polar angle from the clamp within that turn, 0..360
    pub angle_deg: f64,
    /// when the wire there came to rest, or when the wire went slack or broke
    pub time_s: f64,
    /// when slack wire was last slack; nothing for other kinds
    pub until_s: Option<f64>,
    /// largest bulge, gap or overlap depth; nothing for a wire that went slack or broke
    pub size_m: Option<f64>,
    /// the same in wire diameters
    pub size_d: Option<f64>,
    /// the wire's centreline there, core frame
    pub place_m: [f64; 3],
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
    /// what was found
    pub kind: DefectKind,
    /// bulge, gap or overlap depth there, m
    pub size: f64,
    /// turn, from 1
    pub turn: u32,
    /// polar angle from the clamp within that turn, rad in 0..2 pi
    pub angle: f64,
    /// when the wire there came to rest, s
    pub time: f64,
}
