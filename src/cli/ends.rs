//! What is asked for at the end of a run.

use clap::Args;
use serde::{Deserialize, Serialize};

/// Options for the end of a run, which change none of its numbers. A run that goes on keeps them.
#[derive(Args, Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Ends {
    /// Leave report.html out
    #[arg(long)]
    pub(super) no_report: bool,
    /// Exit with 1 if a defect was found
    #[arg(long)]
    pub(super) fail_on_defect: bool,
}

impl Ends {
    /// Those and these.
    pub(super) fn or(self, those: Self) -> Self {
        Self {
            no_report: self.no_report || those.no_report,
            fail_on_defect: self.fail_on_defect || those.fail_on_defect,
        }
    }
}
