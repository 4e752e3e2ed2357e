//! The latest station at each polar angle and place along the core's axis.

use super::STATIONS_PER_TURN;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Station numbers by polar station, and by `floor(y / d)` within it. A copy shares what neither has changed since, so that it
/// costs the same however long the coil is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Buckets {
    columns: Vec<Arc<BTreeMap<i64, usize>>>,
}

impl Default for Buckets {
    fn default() -> Self {
        Self {
            columns: vec![Arc::default(); STATIONS_PER_TURN],
        }
    }
}

impl Buckets {
    /// The latest station in a bucket.
    pub(super) fn get(&self, (polar, place): (usize, i64)) -> Option<usize> {
        self.columns[polar].get(&place).copied()
    }

    /// Makes `station` the latest in a bucket, and returns the one before.
    pub(super) fn insert(&mut self, (polar, place): (usize, i64), station: usize) -> Option<usize> {
        Arc::make_mut(&mut self.columns[polar]).insert(place, station)
    }

    /// Empties a bucket.
    pub(super) fn remove(&mut self, (polar, place): (usize, i64)) {
        Arc::make_mut(&mut self.columns[polar]).remove(&place);
    }
}
