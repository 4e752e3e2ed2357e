//! Files that a run leaves and that are no longer in its folder.

use quick_xml::Reader;
use quick_xml::events::Event;
use std::path::Path;

/// Names of the files that are missing in the folder of a run, relative to it. The page about the run goes without them.
///
/// A run without geometry has neither coil nor core, so that one of them is missed where the other is there.
pub fn missing_files(directory: &Path) -> Vec<String> {
    let is_there = |name: &str| directory.join(name).exists();
    let always = ["history.csv", "stations.csv"].map(|name| (name, true));
    let pair = [("coil.vtp", "core.vtp"), ("core.vtp", "coil.vtp")];
    let pair = pair.map(|(name, other)| (name, is_there(other)));
    let expected = always.into_iter().chain(pair);
    let missing = expected.filter(|(name, expected)| *expected && !is_there(name));
    let mut missing: Vec<String> = missing.map(|(name, _)| name.to_owned()).collect();
    match listed_frames(&directory.join("frames.pvd")) {
        Some(frames) => missing.extend(frames.into_iter().filter(|name| !is_there(name))),
        None if holds_files(&directory.join("frames")) => missing.push("frames.pvd".to_owned()),
        None => {}
    }
    missing
}

fn holds_files(directory: &Path) -> bool {
    std::fs::read_dir(directory).is_ok_and(|mut files| files.next().is_some())
}

/// Files in a list of frames; `None` where there is none, or it is not whole.
fn listed_frames(list: &Path) -> Option<Vec<String>> {
    let mut reader = Reader::from_file(list).ok()?;
    let (mut files, mut buffer, mut closed) = (Vec::new(), Vec::new(), false);
    loop {
        match reader.read_event_into(&mut buffer).ok()? {
            Event::Empty(element) | Event::Start(element)
                if element.name().as_ref() == "DataSet" =>
            {
                let file = element.try_get_attribute("file").ok()??;
                files.push(file.value.into_owned());
            }
            Event::End(element) => closed |= element.name().as_ref() == "VTKFile",
            Event::Eof => return closed.then_some(files),
            _ => {}
        }
        buffer.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::write_series;
    use std::fs;

    #[test]
    fn what_is_not_there_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let put = |name: &str| fs::write(folder.path().join(name), "").expect("a file");
        ["history.csv", "stations.csv"]
            .iter()
            .for_each(|name| put(name));
        assert!(missing_files(folder.path()).is_empty(), "no geometry");
        put("coil.vtp");
        assert_eq!(missing_files(folder.path()), ["core.vtp"]);
        put("core.vtp");
        fs::create_dir(folder.path().join("frames")).expect("a folder");
        assert!(missing_files(folder.path()).is_empty(), "no frame so far");
        put("frames/b.vtp");
        assert_eq!(missing_files(folder.path()), ["frames.pvd"]);
        let names = [(0.1, "frames/a.vtp"), (0.2, "frames/b.vtp")];
        let listed = names.map(|(time, name)| (time, name.to_owned()));
        write_series(&folder.path().join("frames.pvd"), &listed).expect("a list");
        assert_eq!(missing_files(folder.path()), ["frames/a.vtp"]);
        fs::write(folder.path().join("frames.pvd"), "<VTKFile><Coll").expect("a file");
        assert_eq!(missing_files(folder.path()), ["frames.pvd"]);
        fs::remove_file(folder.path().join("stations.csv")).expect("gone");
        assert_eq!(missing_files(folder.path())[0], "stations.csv");
    }
}
