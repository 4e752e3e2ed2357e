//! Ensembles: runs that differ as little as two machines do.

pub(super) mod members;
mod run;

pub(super) use run::run;
