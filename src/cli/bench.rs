//! `coilwind bench`.

use super::failure::Failure;
use super::print;
use coilwind::lab::bench::{BenchArgs, run};

/// Runs a problem and prints its line; a run that stopped on the way has one as well.
pub(super) fn bench(args: &BenchArgs) -> Result<(), Failure> {
    let record = run(args)?;
    print(&format!("{}\n", record.line()))?;
    match record.reason {
        Some(reason) => Err(Failure::BenchStopped { reason }),
        None => Ok(()),
    }
}
