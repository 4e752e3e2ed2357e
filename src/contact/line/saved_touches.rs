//! Touches of a contact point in a saved state: a mask of those in use, then these.

use super::touch::TouchState;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the touches that were ever used and a mask of their places.
pub(super) fn serialize<S: Serializer, const N: usize>(
    touches: &[TouchState; N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let used = |k: usize| !touches[k].is_unused();
    let mask = (0..N).fold(0u8, |mask, k| mask | (u8::from(used(k)) << k));
    let list: Vec<&TouchState> = touches.iter().filter(|t| !t.is_unused()).collect();
    (mask, list).serialize(serializer)
}

/// Reads what [`serialize`] wrote; fails if the mask names more touches than follow.
pub(super) fn deserialize<'de, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<[TouchState; N], D::Error> {
    let (mask, list) = <(u8, Vec<TouchState>)>::deserialize(deserializer)?;
    let mut touches = [TouchState::UNUSED; N];
    let mut list = list.into_iter();
    for k in (0..N).filter(|k| mask >> k & 1 == 1) {
        let next = list.next();
        touches[k] = next.ok_or_else(|| D::Error::custom("a touch is missing"))?;
    }
    Ok(touches)
}
