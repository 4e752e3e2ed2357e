//! `pack-fmu OUT.fmu LIBRARY...` packs shared libraries into an FMU.
//!
//! It is the last step of `scripts/build_fmu.sh` and runs at the root of the sources.

use coilwind_model_description::{Contents, pack, third_party};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Folder of the packed scenes.
const SCENES: &str = "src/scene/packed";

/// The package that the libraries are built from.
const LINKED: &str = "coilwind-fmu";

/// Platforms whose crates are listed. All of them are listed whatever is packed, since a licence too
/// many does no harm.
const TRIPLES: [&str; 2] = ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu"];

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let Some((out, libraries)) = arguments.split_first().filter(|split| !split.1.is_empty()) else {
        eprintln!("usage: pack-fmu OUT.fmu LIBRARY...");
        return ExitCode::from(2);
    };
    match run(out, libraries) {
        Ok(()) => {
            println!("{}", out.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("pack-fmu: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(out: &Path, libraries: &[PathBuf]) -> Result<(), Box<dyn Error>> {
    let contents = Contents {
        libraries: libraries.to_vec(),
        scenes: Some(PathBuf::from(SCENES)),
        third_party: third_party(&metadata()?, LINKED)?,
    };
    Ok(pack(&contents, out)?)
}

/// Returns what cargo knows about the packages of the lock file, as JSON.
fn metadata() -> Result<String, Box<dyn Error>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["metadata", "--locked", "--format-version", "1"]);
    // As the FMU is linked: without what the command line of the library brings in.
    command.arg("--no-default-features");
    for triple in TRIPLES {
        command.args(["--filter-platform", triple]);
    }
    let output = command.output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("cargo metadata failed: {}", said.trim()).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}
