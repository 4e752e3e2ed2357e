//! Defects of settled wire: their kinds, their limits, and how they are reported.

use serde::{Deserialize, Serialize};

/// Limits of the defect flags.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DefectLimits {
    /// gap above which a station counts, diameters
    pub gap: f64,
    /// least length of a run of such stations, as a fraction of a turn
    pub gap_fraction: f64,
    /// bulge over the quasi-static height above which it is a defect, diameters
    pub bulge_excess: f64,
    /// absolute bulge limit, m; 0: use `bulge_excess`
    pub bulge_absolute: f64,
    /// axial distance to the neighbour below which wire may overlap, diameters
    pub overlap_axial: f64,
    /// bulge from which on such wire overlaps, diameters
    pub overlap_height: f64,
    /// polar angle after the clamp in which nothing is judged, rad
    pub skip_angle: f64,
    /// least length over which wire stands on its own row to be a double turn, as a fraction of a turn
    pub double_turn: f64,
    /// least length over which a groove lies empty beside the wire, as a fraction of a turn
    pub skipped_groove: f64,
    /// turns by which a change of layer may miss the place where it is planned
    pub jump: f64,
    /// bulge over the quasi-static height above which wire touches nothing, diameters
    pub loose_height: f64,
    /// largest share of a turn that may touch nothing
    pub loose_fraction: f64,
    /// least mean tension of a turn at rest, as a share of the set tension
    pub loose_tension: f64,
    /// largest plastic stretch
    pub stretch: f64,
}

/// What a bulge is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "by", rename_all = "snake_case")]
pub enum BulgeLimit {
    /// the quasi-static height
    OverRest {
        /// allowed over it, m
        limit_m: f64,
        /// largest quasi-static height, m
        highest_m: f64,
    },
    /// the absolute limit of the scene
    Absolute {
        /// allowed bulge, m
        limit_m: f64,
    },
    /// an absolute limit of one diameter, since there is no quasi-static height
    Fallback {
        /// allowed bulge, m
        limit_m: f64,
    },
}

/// Bulge that is a defect where no quasi-static height is known, diameters: it takes the room of another wire.
pub(crate) const FALLBACK_BULGE: f64 = 1.0;

/// How many kinds of defect there are.
pub(crate) const KINDS: usize = DefectKind::ALL.len();
/// How many kinds of defect are measured on settled wire.
pub(crate) const MEASURED: usize = DefectKind::MEASURED.len();

/// Kinds of defect: those before slack are measured on settled wire, the others are faults of the wire itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DefectKind {
    /// stands off further than allowed
    Bulge = 0,
    /// lies beside its place
    Gap = 1,
    /// rides on its neighbour or has changed places with it
    Overlap = 2,
    /// stands on turns of its own row for a good part of a turn
    DoubleTurn = 3,
    /// leaves a groove of the layer below empty beside it
    SkippedGroove = 4,
    /// climbed to the next layer before the turn that the scene plans
    EarlyJump = 5,
    /// climbed to the next layer after the turn that the scene plans
    LateJump = 6,
    /// touches nothing over a good part of a turn, or lies there with hardly any tension
    LooseTurn = 7,
    /// has been drawn longer for good by more than allowed
    Overstretch = 8,
    /// the tension at the nozzle fell to zero
    Slack = 9,
    /// the coil has grown into the nozzle
    Collision = 10,
    /// the wire shoots out of the nozzle
    Runaway = 11,
    /// the wire parted
    Break = 12,
}

impl DefectKind {
    /// Every kind, the mildest last.
    pub const ALL: [Self; 13] = [
        Self::Break,
        Self::Runaway,
        Self::Collision,
        Self::Overstretch,
        Self::DoubleTurn,
        Self::Overlap,
        Self::SkippedGroove,
        Self::EarlyJump,
        Self::LateJump,
        Self::Gap,
        Self::Bulge,
        Self::LooseTurn,
        Self::Slack,
    ];

    /// Those measured on settled wire, by their numbers.
    pub(crate) const MEASURED: [Self; 9] = [
        Self::Bulge,
        Self::Gap,
        Self::Overlap,
        Self::DoubleTurn,
        Self::SkippedGroove,
        Self::EarlyJump,
        Self::LateJump,
        Self::LooseTurn,
        Self::Overstretch,
    ];

    /// Its bit in `defect_code` and in the field `defect` of `coil.vtp`.
    pub fn code(self) -> i32 {
        match self {
            Self::Bulge => 1,
            Self::Gap => 2,
            Self::Overlap => 4,
            Self::Break => 8,
            Self::Slack => 16,
            Self::DoubleTurn => 32,
            Self::SkippedGroove => 64,
            Self::EarlyJump => 128,
            Self::LateJump => 256,
            Self::LooseTurn => 512,
            Self::Overstretch => 1024,
            Self::Collision => 2048,
            Self::Runaway => 4096,
        }
    }

    /// The name for it, as in `defects.csv`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Bulge => "bulge",
            Self::Gap => "gap",
            Self::Overlap => "overlap",
            Self::DoubleTurn => "double_turn",
            Self::SkippedGroove => "skipped_groove",
            Self::EarlyJump => "early_jump",
            Self::LateJump => "late_jump",
            Self::LooseTurn => "loose_turn",
            Self::Overstretch => "overstretch",
            Self::Slack => "slack",
            Self::Collision => "collision",
            Self::Runaway => "runaway",
            Self::Break => "break",
        }
    }

    /// The words for it in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::DoubleTurn => "double turn",
            Self::SkippedGroove => "skipped groove",
            Self::EarlyJump => "early layer jump",
            Self::LateJump => "late layer jump",
            Self::LooseTurn => "loose turn",
            kind => kind.as_str(),
        }
    }

    /// Whether each station of its run has it. A jump is at one place, and a loose turn shows at the end of its turn.
    pub(crate) fn lies_where_it_shows(self) -> bool {
        !matches!(self, Self::EarlyJump | Self::LateJump | Self::LooseTurn)
    }

    /// Whether no wire moves from then on.
    pub fn ends_winding(self) -> bool {
        matches!(self, Self::Break | Self::Collision | Self::Runaway)
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
    /// turn in which it was found: from that place on it lasts long enough to count, and there the run tells of it
    pub found_turn: u32,
    /// polar angle from the clamp at which it was found, 0..360
    pub found_angle_deg: f64,
    /// when the wire there came to rest, or when the wire went slack or broke
    pub time_s: f64,
    /// when slack wire was last slack; nothing for other kinds
    pub until_s: Option<f64>,
    /// how large it is, see the guide; nothing for what befalls the wire
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
    /// wire stands on turns of its own row
    pub double_turn: bool,
    /// wire leaves a groove empty beside it
    pub skipped_groove: bool,
    /// wire climbed before its turn
    pub early_jump: bool,
    /// wire climbed after its turn
    pub late_jump: bool,
    /// wire is loose
    pub loose_turn: bool,
    /// wire is stretched
    pub overstretch: bool,
}

impl DefectFlags {
    /// The kinds that are present.
    pub fn kinds(self) -> impl Iterator<Item = DefectKind> {
        let up = [
            self.bulge,
            self.gap,
            self.overlap,
            self.double_turn,
            self.skipped_groove,
            self.early_jump,
            self.late_jump,
            self.loose_turn,
            self.overstretch,
        ];
        let kinds = DefectKind::MEASURED.into_iter().zip(up);
        kinds.filter(|(_, up)| *up).map(|(kind, _)| kind)
    }
}

/// Where a defect was found: the end of the first run long enough to count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DefectPlace {
    /// what was found
    pub kind: DefectKind,
    /// its size there, m
    pub size: f64,
    /// turn, from 1
    pub turn: u32,
    /// polar angle from the clamp within that turn, rad in 0..2 pi
    pub angle: f64,
    /// when the wire there came to rest, s
    pub time: f64,
}
