//! `coilwind verify`.

use super::failure::Failure;
use super::print;
use coilwind::lab::verify::{VerifyArgs, run};

/// Runs the cases, a line each; fails if a number is out of tolerance.
pub(super) fn verify(args: &VerifyArgs) -> Result<(), Failure> {
    let mut printed = Ok(());
    let right = run(args, |line| {
        if printed.is_ok() {
            printed = print(&format!("{line}\n"));
        }
    })?;
    printed?;
    if right { Ok(()) } else { Err(Failure::Verify) }
}
