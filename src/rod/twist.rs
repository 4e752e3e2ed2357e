//! How much of the wire's twist a method carries.

/// What becomes of twist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Twist {
    /// none: edges have no torsional stiffness
    Off,
    /// edges roll to where their torques balance, without inertia (implicit method and statics)
    QuasiStatic,
    /// edges have the rotary inertia of a round wire about its axis, `1/2 rho A r^2` per length
    #[default]
    Dynamic,
}

impl Twist {
    /// Whether the wire has torsional stiffness.
    pub fn is_carried(self) -> bool {
        self != Self::Off
    }
}
