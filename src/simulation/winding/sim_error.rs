//! Why a run ends early.

/// The run can't start or can't go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct SimError {
    /// when, s
    pub time: f64,
    /// where: live node from the clamp, if one is to blame
    pub node: Option<usize>,
    /// why
    pub reason: String,
}

impl SimError {
    /// An error of the set-up, before any time has passed.
    pub fn setup(reason: String) -> Self {
        Self {
            time: 0.0,
            node: None,
            reason,
        }
    }
}

impl std::fmt::Display for SimError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "at t = {:.9} s", self.time)?;
        if let Some(node) = self.node {
            write!(f, ", live node {node}")?;
        }
        write!(f, ": {}", self.reason)
    }
}
