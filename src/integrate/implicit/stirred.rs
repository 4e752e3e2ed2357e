//! Which touches have to be looked at again: those with a node that another touch has moved since.

use super::impulse::Impulse;

/// Bits in a word.
const WORD: usize = u64::BITS as usize;

/// Touches to be looked at again, and which of them share nodes.
#[derive(Debug, Default)]
pub(super) struct Stirred {
    /// how many touches there are
    count: usize,
    /// touches to be looked at, a bit each
    again: Vec<u64>,
    /// touches that may be looked at still, a bit each
    open: Vec<u64>,
    /// how often that is, touch by touch
    pub(super) left: Vec<u8>,
    /// words of `again` and the bits in them that share a node with a touch, touch by touch
    near: Vec<(usize, u64)>,
    /// by touches, where theirs begin in `near`; then the end
    first: Vec<usize>,
    /// touches, node by node
    touches: Vec<usize>,
    /// by nodes, where theirs end in `touches`
    end: Vec<usize>,
}

impl Stirred {
    /// Finds out which of the touches on so many `nodes` share one.
    pub(super) fn list(&mut self, impulses: &[Impulse], nodes: usize) {
        self.count = impulses.len();
        self.list_by_node(impulses, nodes);
        self.near.clear();
        self.first.clear();
        for (k, impulse) in impulses.iter().enumerate() {
            let begin = self.near.len();
            self.first.push(begin);
            for (node, _) in impulse.nodes() {
                let first = node.checked_sub(1).map_or(0, |before| self.end[before]);
                for other in self.touches[first..self.end[node]]
                    .iter()
                    .filter(|o| **o != k)
                {
                    let (word, bit) = (other / WORD, 1 << (other % WORD));
                    match self.near[begin..].iter_mut().find(|near| near.0 == word) {
                        Some(near) => near.1 |= bit,
                        None => self.near.push((word, bit)),
                    }
                }
            }
        }
        self.first.push(self.near.len());
    }

    /// Sorts the touches by their nodes, in the order of their numbers.
    fn list_by_node(&mut self, impulses: &[Impulse], nodes: usize) {
        self.end.clear();
        self.end.resize(nodes, 0);
        for (node, _) in impulses.iter().flat_map(Impulse::nodes) {
            self.end[node] += 1;
        }
        let mut sum = 0;
        for end in &mut self.end {
            (*end, sum) = (sum, sum + *end);
        }
        self.touches.clear();
        self.touches.resize(sum, 0);
        for (k, impulse) in impulses.iter().enumerate() {
            for (node, _) in impulse.nodes() {
                self.touches[self.end[node]] = k;
                self.end[node] += 1;
            }
        }
    }

    /// Each touch may be looked at so often from now on.
    pub(super) fn begin(&mut self, looks: u8) {
        self.left.clear();
        self.left.resize(self.count, looks);
        self.open.clear();
        self.open.resize(self.count.div_ceil(WORD), u64::MAX);
        if let Some(last) = self.open.last_mut() {
            *last >>= (WORD - self.count % WORD) % WORD;
        }
        self.again.clear();
        self.again.resize(self.open.len(), 0);
    }

    /// All touches are to be looked at that may be.
    pub(super) fn all(&mut self) {
        self.again.clone_from(&self.open);
    }

    /// Those that share a node with the touch `k` are to be looked at.
    #[inline]
    pub(super) fn around(&mut self, k: usize) {
        for (word, bits) in &self.near[self.first[k]..self.first[k + 1]] {
            self.again[*word] |= bits & self.open[*word];
        }
    }

    /// Takes the next touch to be looked at: from number `place` on, or `backwards` the next below it.
    #[inline]
    pub(super) fn take(&mut self, place: usize, backwards: bool) -> Option<usize> {
        let k = if backwards {
            self.below(place)
        } else {
            self.from(place)
        }?;
        let (word, bit) = (k / WORD, 1 << (k % WORD));
        self.again[word] &= !bit;
        self.left[k] -= 1;
        if self.left[k] == 0 {
            self.open[word] &= !bit;
        }
        Some(k)
    }

    fn from(&self, place: usize) -> Option<usize> {
        let mut mask = u64::MAX << (place % WORD);
        for word in place / WORD..self.again.len() {
            let bits = self.again[word] & mask;
            if bits != 0 {
                return Some(word * WORD + bits.trailing_zeros() as usize);
            }
            mask = u64::MAX;
        }
        None
    }

    fn below(&self, place: usize) -> Option<usize> {
        let mut mask = (1 << (place % WORD)) - 1;
        for word in (0..self.again.len().min(place / WORD + 1)).rev() {
            let bits = self.again[word] & mask;
            if bits != 0 {
                return Some(word * WORD + bits.ilog2() as usize);
            }
            mask = u64::MAX;
        }
        None
    }
}
