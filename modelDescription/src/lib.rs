//! placeholder for the model description, written next.
