//! placeholder for the C boundary, written next.
