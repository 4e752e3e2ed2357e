//! Files that a scene names: what a saved state keeps of their places, and where they are found again.

use coilwind::settings::SceneSettings;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf, absolute};

/// The place of a file when a state was saved.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct SavedFile {
    /// whole path
    path: String,
    /// the way to it from the FMU's resources, where it is one of them
    resource: Option<Vec<String>>,
}

/// The places of all files of a scene, in the order of [`SceneSettings::files`]; none for those that are not named.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SavedFiles([Option<SavedFile>; 3]);

impl SavedFile {
    fn of(name: &str, resources: Option<&Path>) -> Option<Self> {
        if name.is_empty() {
            return None;
        }
        let path = absolute(name).ok()?;
        let resources = resources.and_then(|folder| absolute(folder).ok());
        let way = resources.and_then(|folder| path.strip_prefix(folder).ok().map(Path::to_owned));
        let part = |part: &std::ffi::OsStr| part.to_str().map(str::to_owned);
        Some(Self {
            resource: way.and_then(|way| way.iter().map(part).collect()),
            path: path.to_str()?.to_owned(),
        })
    }

    /// Where it may be now, the likeliest place first.
    fn places(&self, resources: Option<&Path>) -> Vec<PathBuf> {
        let way = self.resource.as_ref().zip(resources);
        let among = way.map(|(way, folder)| folder.join(way.iter().collect::<PathBuf>()));
        let mut places: Vec<PathBuf> = among.into_iter().collect();
        places.push(PathBuf::from(&self.path));
        places.dedup();
        places
    }
}

impl SavedFiles {
    /// Returns the places of the files of `settings`, for an FMU that is unpacked with its `resources` there.
    pub(crate) fn of(settings: &SceneSettings, resources: Option<&Path>) -> Self {
        Self(settings.files().map(|name| SavedFile::of(name, resources)))
    }

    /// Names each file of `settings` by where it is now, if it is in one of its places. The present working directory, and what lies
    /// there, do not matter.
    pub(crate) fn find(&self, settings: &mut SceneSettings, resources: Option<&Path>) {
        for (name, saved) in settings.files_mut().into_iter().zip(&self.0) {
            let mut places = saved.iter().flat_map(|saved| saved.places(resources));
            let found = places.find(|place| place.is_file());
            if let Some(found) = found.as_deref().and_then(Path::to_str) {
                found.clone_into(name);
            }
        }
    }

    /// The places in which each file was looked for, in words; empty for those that were not saved.
    pub(crate) fn places(&self, resources: Option<&Path>) -> [Vec<String>; 3] {
        let shown = |place: PathBuf| place.display().to_string();
        self.0.each_ref().map(|saved| {
            let places = saved.iter().flat_map(|saved| saved.places(resources));
            places.map(shown).collect()
        })
    }
}
