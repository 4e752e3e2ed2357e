//! So many steps are enough.

/// Steps tried that are enough for a turn, and half of them for the start or a stop, which turn nothing; ...
const STEPS_PER_TURN: f64 = 30_000.0;
/// ... with so many nodes (more nodes, fewer steps: the bound is on the work).
const NODES: f64 = 200.0;

/// Node steps that are enough for so many turns.
pub(super) fn allowed(turns: f64) -> u64 {
    (STEPS_PER_TURN * NODES * (0.5 + turns)) as u64
}
