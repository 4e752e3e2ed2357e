//! A traverse that turns back: layer on layer, between two ends.

/// Where the nozzle goes to and fro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// how many
    pub count: u32,
    /// turns of each
    pub turns: f64,
}

impl Layers {
    /// A single layer, however long.
    pub const ONE: Self = Self {
        count: 1,
        turns: f64::INFINITY,
    };

    /// Turns by which the nozzle has come from its start after so many turns of the core.
    pub fn way(&self, turned: f64) -> f64 {
        if self.count == 1 {
            return turned;
        }
        let there_and_back = 2.0 * self.turns;
        let at = turned.rem_euclid(there_and_back);
        at.min(there_and_back - at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nozzle_goes_to_and_fro() {
        let layers = Layers {
            count: 3,
            turns: 2.0,
        };
        let ways = [0.0, 1.0, 2.0, 3.0, 4.0, 5.5, -1.0].map(|t| layers.way(t));
        assert_eq!(ways, [0.0, 1.0, 2.0, 1.0, 0.0, 1.5, 1.0]);
        assert_eq!(Layers::ONE.way(7.25), 7.25);
    }
}
