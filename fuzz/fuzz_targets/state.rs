//! Serialised states from arbitrary bytes, through the C functions as an importer calls them.
#![no_main]

#[path = "../state_entry.rs"]
mod state_entry;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| state_entry::deserialize(bytes));
