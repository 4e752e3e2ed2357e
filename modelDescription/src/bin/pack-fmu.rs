//! `pack-fmu LIBRARY OUT.fmu [SCENES]`: the last step of `scripts/build_fmu.sh`.

use coilwind_model_description::{Contents, pack};
use std::path::PathBuf;
use std::process::ExitCode;

/// Where the packed scenes are when run from the root of the sources.
const SCENES: &str = "src/scene/packed";

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let (library, out, scenes) = match arguments.as_slice() {
        [library, out] => (library, out, PathBuf::from(SCENES)),
        [library, out, scenes] => (library, out, scenes.clone()),
        _ => {
            eprintln!("usage: pack-fmu LIBRARY OUT.fmu [SCENES]");
            return ExitCode::from(2);
        }
    };
    let contents = Contents {
        libraries: vec![library.clone()],
        scenes: Some(scenes),
    };
    match pack(&contents, out) {
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
