//! The `coilwind` command: runs, checks and lists from the terminal what the library computes.
#![forbid(unsafe_code)]

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
