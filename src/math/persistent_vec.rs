//! A stack that copies share: what is covered by later entries lies in chunks behind an `Arc`.
//!
//! Settled wire only grows at its end, and shrinks there where it is unwound. A copy of such an
//! array costs the entries of its last chunk and a pointer for each of the others. So hundreds
//! of saved states of one run hold its settled wire once.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::Index;
use std::sync::Arc;

/// A stack in chunks of `N` entries, oldest first.
#[derive(Clone, Debug)]
pub struct PersistentVec<T, const N: usize> {
    /// of `N` entries each
    full: Vec<Arc<Vec<T>>>,
    /// fewer than `N`
    top: Vec<T>,
}

impl<T, const N: usize> Default for PersistentVec<T, N> {
    fn default() -> Self {
        Self {
            full: Vec::new(),
            top: Vec::new(),
        }
    }
}

impl<T, const N: usize> PersistentVec<T, N> {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.full.len() * N + self.top.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.full.is_empty() && self.top.is_empty()
    }

    /// Puts an entry on top.
    pub fn push(&mut self, entry: T) {
        self.top.push(entry);
        if self.top.len() == N {
            let chunk = std::mem::replace(&mut self.top, Vec::with_capacity(N));
            self.full.push(Arc::new(chunk));
        }
    }

    /// The topmost entry.
    pub fn last(&self) -> Option<&T> {
        self.top
            .last()
            .or_else(|| self.full.last().and_then(|chunk| chunk.last()))
    }

    /// Entry `i` from the bottom.
    #[inline]
    pub fn get(&self, i: usize) -> Option<&T> {
        match self.full.get(i / N) {
            Some(chunk) => chunk.get(i % N),
            None => self.top.get(i - self.full.len() * N),
        }
    }

    /// The entries, oldest first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + ExactSizeIterator {
        (0..self.len()).map(|i| &self[i])
    }

    /// The chunks, all of `N` entries but the last.
    pub fn chunks(&self) -> impl Iterator<Item = &[T]> {
        let top = (!self.top.is_empty()).then_some(self.top.as_slice());
        self.full.iter().map(|chunk| chunk.as_slice()).chain(top)
    }
}

impl<T: Clone, const N: usize> PersistentVec<T, N> {
    /// Entry `i` from the bottom, to be changed; copies keep what it was.
    pub fn get_mut(&mut self, i: usize) -> Option<&mut T> {
        let full = self.full.len() * N;
        match self.full.get_mut(i / N) {
            Some(chunk) => Arc::make_mut(chunk).get_mut(i % N),
            None => self.top.get_mut(i - full),
        }
    }

    /// Takes the entries from `len` on off the top.
    pub fn truncate(&mut self, len: usize) {
        while self.full.len() * N > len
            && let Some(chunk) = self.full.pop()
        {
            self.top = Arc::try_unwrap(chunk).unwrap_or_else(|shared| (*shared).clone());
        }
        self.top.truncate(len - self.full.len() * N);
    }

    /// Takes the last `count` entries off and hands them over, oldest first.
    pub fn split_off(&mut self, count: usize) -> Vec<T> {
        let keep = self.len().saturating_sub(count);
        let gone = (keep..self.len()).map(|i| self[i].clone()).collect();
        self.truncate(keep);
        gone
    }
}

impl<T, const N: usize> Index<usize> for PersistentVec<T, N> {
    type Output = T;

    fn index(&self, i: usize) -> &T {
        let entry = self.get(i);
        entry.unwrap_or_else(|| panic!("entry {i} of a stack of {}", self.len()))
    }
}

impl<T, const N: usize> FromIterator<T> for PersistentVec<T, N> {
    fn from_iter<I: IntoIterator<Item = T>>(entries: I) -> Self {
        let mut stack = Self::default();
        entries.into_iter().for_each(|entry| stack.push(entry));
        stack
    }
}

impl<T: PartialEq, const N: usize> PartialEq for PersistentVec<T, N> {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().zip(other.iter()).all(|(a, b)| a == b)
    }
}

impl<T: Serialize, const N: usize> Serialize for PersistentVec<T, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for PersistentVec<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Vec::<T>::deserialize(deserializer)?.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Small = PersistentVec<u32, 4>;

    proptest! {
        /// Whatever is put on and taken off, a stack is a vector; copies stay what they were.
        #[test]
        fn a_stack_is_a_vector(changes in proptest::collection::vec((0u32..9, any::<bool>()), 0..60)) {
            let (mut stack, mut plain) = (Small::default(), Vec::new());
            let mut copies = Vec::new();
            for (k, (count, grow)) in changes.into_iter().enumerate() {
                if grow {
                    for i in 0..count {
                        stack.push(100 * k as u32 + i);
                        plain.push(100 * k as u32 + i);
                    }
                } else if count % 2 == 0 {
                    let keep = plain.len().saturating_sub(count as usize);
                    stack.truncate(keep);
                    plain.truncate(keep);
                } else {
                    let keep = plain.len().saturating_sub(count as usize);
                    prop_assert_eq!(stack.split_off(count as usize), plain.split_off(keep));
                }
                copies.push((stack.clone(), plain.clone()));
            }
            for (stack, plain) in &copies {
                prop_assert_eq!(stack.iter().copied().collect::<Vec<_>>(), plain.clone());
                prop_assert_eq!(stack.chunks().flatten().copied().collect::<Vec<_>>(), plain.clone());
                prop_assert_eq!(stack.last(), plain.last());
                prop_assert_eq!(stack.is_empty(), plain.is_empty());
                prop_assert_eq!(stack.get(plain.len()), None);
                prop_assert!(stack == &plain.iter().copied().collect::<Small>());
                let bytes = postcard::to_stdvec(stack).expect("written");
                let read: Small = postcard::from_bytes(&bytes).expect("read");
                prop_assert!(&read == stack);
            }
        }
    }

    #[test]
    fn copies_share_what_is_covered() {
        let stack: Small = (0..9).collect();
        let copy = stack.clone();
        assert_eq!(copy.full.len(), 2);
        for (a, b) in stack.full.iter().zip(&copy.full) {
            assert!(Arc::ptr_eq(a, b));
        }
    }
}
