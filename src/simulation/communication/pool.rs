//! Windings that nobody needs any more, to be written over.

use crate::simulation::Winding;
use std::sync::Arc;

/// How many are kept: a run, its step ahead, and the same of the communication step before, of which a master may ask.
const MOST: usize = 4;

/// Windings of one scene. A copy of a pool is empty.
#[derive(Debug, Default)]
pub(in crate::simulation) struct Pool(Vec<Arc<Winding>>);

impl Clone for Pool {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Pool {
    /// Takes a winding in, which others may still share.
    pub(super) fn give(&mut self, winding: Arc<Winding>) {
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(winding);
    }

    /// A copy of `winding` that nobody shares.
    pub(super) fn copy(&mut self, winding: &Winding) -> Arc<Winding> {
        let free = self.0.iter_mut().position(|w| Arc::get_mut(w).is_some());
        if let Some(mut copy) = free.map(|free| self.0.swap_remove(free))
            && let Some(room) = Arc::get_mut(&mut copy)
        {
            room.become_copy_of(winding);
            return copy;
        }
        Arc::new(winding.clone())
    }

    /// `winding`, or a copy of it where others share it.
    pub(super) fn own<'a>(&mut self, winding: &'a mut Arc<Winding>) -> &'a mut Winding {
        if Arc::get_mut(winding).is_none() {
            let copy = self.copy(winding);
            self.give(std::mem::replace(winding, copy));
        }
        Arc::make_mut(winding)
    }
}
