//! The core the wire is wound on, as geometry in its own (turning) frame.
