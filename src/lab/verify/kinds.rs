//! Every kind of case, the function that computes its answers, and the set-ups it takes.

use super::case::{Answers, Context, VerifyError};
use super::{
    axial_wave, bending_modes, bulge_linear, capstan, corner_edge, cyclic_bending,
    elastica_cantilever, end_couple, feed_tension, frozen_helix, groove_seat, grooved_capstan,
    hanging_wire, helix, helix_gap, live_pair, mandrel_springback, penalty_impact, rolling_path,
    shoulder_drop, shoulder_static, spinning_ring, square_loop, torsion, twist_buckling,
    wave_damping, winding_feed,
};

/// Computes the answers of one case.
pub type Solve = fn(&Context) -> Result<Answers, VerifyError>;

/// A kind of case.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// its name in case files
    pub name: &'static str,
    /// computes the answers of a case
    pub run: Solve,
    /// in what the kind's own set-up differs from that of a wind; none if it has only a wind's
    pub own: Option<&'static str>,
    /// what a wind's set-up can answer
    pub wind: Wind,
}

/// What the set-up of a wind can answer of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wind {
    /// every quantity
    All,
    /// every quantity but these
    But(&'static [&'static str]),
    /// nothing
    Nothing,
}

impl Wind {
    /// Whether it answers `quantity`.
    pub fn answers(self, quantity: &str) -> bool {
        match self {
            Self::All => true,
            Self::But(lacking) => !lacking.contains(&quantity),
            Self::Nothing => false,
        }
    }
}

/// Contact law, stiffness, spacing, tolerance, twist and formula of time of the default scene.
pub const WIND: &str = "wind";
/// Frequencies of rolls follow from stiffness and rotary inertia.
const ROLLS: &str =
    "rolls with inertia, small oscillations found without steps in time; spacing of the kind";

/// A row for each kind: module, words for its own set-up, what a wind's answers.
macro_rules! kinds {
    ($($name:ident: $own:expr, $wind:expr;)*) => {
        &[$(Kind { name: stringify!($name), run: $name::run, own: $own, wind: $wind }),*]
    };
}

/// Every kind there is.
pub const KINDS: &[Kind] = kinds! {
    elastica_cantilever: None, Wind::All;
    end_couple: None, Wind::All;
    bending_modes: None, Wind::All;
    axial_wave: None, Wind::All;
    torsion: Some(ROLLS), Wind::But(&["fixed_free_f1_Hz", "fixed_free_f2_Hz", "fixed_fixed_f1_Hz"]);
    hanging_wire: None, Wind::All;
    helix: None, Wind::All;
    mandrel_springback: None, Wind::All;
    cyclic_bending: None, Wind::All;
    bulge_linear: None, Wind::All;
    corner_edge: None, Wind::All;
    square_loop: None, Wind::All;
    capstan: None, Wind::All;
    grooved_capstan: None, Wind::All;
    twist_buckling: None, Wind::All;
    shoulder_static: None, Wind::All;
    groove_seat: None, Wind::All;
    shoulder_drop: None, Wind::All;
    spinning_ring: None, Wind::All;
    rolling_path: None, Wind::All;
    wave_damping: None, Wind::All;
    helix_gap: None, Wind::All;
    frozen_helix: None, Wind::All;
    live_pair: None, Wind::All;
    penalty_impact: Some("the paper's nodal contact, whose dashpot may pull; RK4"), Wind::Nothing;
    winding_feed: None, Wind::All;
    feed_tension: None, Wind::All;
};
