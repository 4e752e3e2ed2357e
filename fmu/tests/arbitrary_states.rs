//! Random bytes are given to `fmi2DeSerializeFMUstate`, by the function that the fuzz target calls.
#![allow(non_snake_case)]

use proptest::prelude::*;

#[path = "../../fuzz/state_entry.rs"]
mod state_entry;

#[test]
fn no_bytes_at_all() {
    state_entry::deserialize(&[]);
}

proptest! {
    // Each case starts a simulation.
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        state_entry::deserialize(&bytes);
    }
}
