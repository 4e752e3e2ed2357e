//! A run as bytes, and back.
//!
//! The bytes hold the state and not the scene, which the caller hands over to restore.
//! Restoring starts a second run from the scene and then replaces its state.
//! Search trees and measures of settled wire are rebuilt from the state to the bit.

use super::communication::Ahead;
use super::communication::Pool;
use super::communication::Talk;
use super::motion::Course;
use super::winding::RunState;
use super::{Simulation, Winding};
use crate::integrate::{SolverStatistics, Stepper};
use crate::measure::{Defect, SavedCoil};
use crate::scene::{Core, Scene};
use crate::system::State;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Changes whenever the bytes of the same state do.
const VERSION: u32 = 33;

/// More turns than any run winds: the stations of that many would take a hundred gigabytes. Of a fault that lies beyond them, the
/// table of turns would take all memory.
const MOST_TURNS: u32 = 1_000_000;

/// Bytes that are no state of a run of this scene.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// written by another version of this program
    #[error("the state is of version {found}, this program reads version {VERSION}")]
    Version {
        /// version in the bytes
        found: u32,
    },
    /// the bytes end too soon or hold what no state can
    #[error("the state cannot be read: {0}")]
    Unreadable(#[from] postcard::Error),
    /// bytes beyond the end
    #[error("the state ends {left} bytes before the data does")]
    TooLong {
        /// how many
        left: usize,
    },
    /// readable, but no state of a run
    #[error("the state contradicts itself: {0}")]
    Impossible(&'static str),
    /// the scene's core is another one, or its mesh file has changed since
    #[error("{}", other_core(.file.as_deref()))]
    OtherCore {
        /// file of the mesh; nothing where the core has none
        file: Option<PathBuf>,
    },
    /// the motion is another one, or the file of a table has changed since
    #[error("{}", other_motion(.files))]
    OtherMotion {
        /// keys and files of the tables that the motion follows; nothing where it follows none
        files: Vec<(&'static str, String)>,
    },
    /// the scene does not start
    #[error("the scene of the state does not start: {0}")]
    Scene(#[from] super::SimError),
}

/// What to do about a core that the state was not saved with.
fn other_core(file: Option<&Path>) -> String {
    match file {
        Some(file) => format!(
            "the mesh in {} (core.file) is not the one that the state was saved with; put that one back to go on",
            file.display()
        ),
        None => {
            "the core is not the one that the state was saved with; set the core section as it was to go on".to_owned()
        }
    }
}

/// What to do about a motion that the state was not saved with.
fn other_motion(files: &[(&str, String)]) -> String {
    let named = files
        .iter()
        .map(|(key, file)| format!("the table in {file} ({key})"));
    let named: Vec<String> = named.collect();
    match &named[..] {
        [] => {
            "the motion is not the one that the state was saved with; set the sections spindle and traverse as they were to go on".to_owned()
        }
        [one] => format!("{one} is not the one that the state was saved with; put that one back to go on"),
        more => format!(
            "{} are not those that the state was saved with; put those back to go on",
            more.join(" or ")
        ),
    }
}

/// Keys and files of the tables that a scene's motion follows.
fn tables(scene: &Scene) -> Vec<(&'static str, String)> {
    let (traverse, spindle) = (&scene.traverse, &scene.spindle);
    let mut files = Vec::new();
    if traverse.mode == "table" {
        files.push(("traverse.file", traverse.file.clone()));
    }
    if !spindle.file.is_empty() {
        files.push(("spindle.file", spindle.file.clone()));
    }
    files
}

/// All that the scene does not give.
#[derive(Debug, Serialize, Deserialize)]
struct Saved<'a> {
    /// over vertices and triangles of the core
    core: u32,
    /// over the scene's own motion
    motion: u32,
    sys: Cow<'a, State>,
    coil: SavedCoil,
    /// of the implicit method: next step and the one that the error asks for, s, and what it took so far
    implicit: Option<([f64; 2], SolverStatistics)>,
    run: Cow<'a, RunState>,
}

/// A run and what has been said of it.
#[derive(Debug, Serialize, Deserialize)]
struct SavedRun<'a> {
    winding: Saved<'a>,
    talk: Cow<'a, Talk>,
    /// of a step ahead: its course, and whether it is the first along it
    ahead: Option<(Course, bool)>,
}

impl Simulation {
    /// The state of this run, for [`Simulation::from_bytes`] with the same scene.
    ///
    /// # Errors
    ///
    /// If it cannot be encoded.
    pub fn to_bytes(&self) -> Result<Vec<u8>, RestoreError> {
        let saved = SavedRun {
            winding: self.now.saved(),
            talk: Cow::Borrowed(&self.talk),
            ahead: self.ahead.as_ref().map(|ahead| (ahead.course, ahead.first)),
        };
        Ok(postcard::to_stdvec(&(VERSION, saved))?)
    }

    /// A run of `scene` that goes on, to the bit, as the one did that `bytes` were made of. A step ahead is taken again.
    ///
    /// The bytes need not be trusted: what they hold is checked before it is used. That they are the
    /// ones written (a checksum) is for the caller to see to.
    ///
    /// # Errors
    ///
    /// If the bytes are no state of a run of this scene.
    pub fn from_bytes(scene: &Scene, bytes: &[u8]) -> Result<Self, RestoreError> {
        let (found, rest) = postcard::take_from_bytes::<u32>(bytes)?;
        if found != VERSION {
            return Err(RestoreError::Version { found });
        }
        let (saved, rest) = postcard::take_from_bytes::<SavedRun>(rest)?;
        if !rest.is_empty() {
            return Err(RestoreError::TooLong { left: rest.len() });
        }
        let mut winding = Winding::new(scene)?;
        if saved.winding.core != winding.core_checksum() {
            let file = match &scene.core {
                Core::Mesh { path, .. } => Some(path.clone()),
                _ => None,
            };
            return Err(RestoreError::OtherCore { file });
        }
        if saved.winding.motion != winding.motion_profile.checksum() {
            return Err(RestoreError::OtherMotion {
                files: tables(scene),
            });
        }
        winding
            .take_over(saved.winding)
            .map_err(RestoreError::Impossible)?;
        let talk = saved.talk.into_owned();
        if !talk.is_sound(&winding, saved.ahead.is_some()) {
            return Err(RestoreError::Impossible(
                "what was said last cannot have been",
            ));
        }
        let ahead = match saved.ahead {
            Some((course, first)) if course.is_sound() && !course.ends_by(winding.time()) => {
                let ahead = Ahead::of(Arc::new(winding.clone()), course, first);
                Some(ahead.map_err(|_| RestoreError::Impossible("no step leads ahead"))?)
            }
            Some(_) => return Err(RestoreError::Impossible("nothing moves like that")),
            None => None,
        };
        Ok(Self {
            now: Arc::new(winding),
            ahead,
            talk,
            pool: Pool::default(),
            steps_beyond: false,
        })
    }
}

impl Winding {
    fn saved(&self) -> Saved<'_> {
        Saved {
            core: self.core_checksum(),
            motion: self.motion_profile.checksum(),
            sys: Cow::Borrowed(&self.sys.state),
            coil: self.coil.saved(),
            implicit: match &self.stepper {
                Stepper::Implicit(method) => {
                    Some(([method.next, method.wanted], method.statistics))
                }
                Stepper::Explicit { .. } => None,
            },
            run: Cow::Borrowed(&self.run),
        }
    }

    fn take_over(&mut self, saved: Saved) -> Result<(), &'static str> {
        self.sys.restore(saved.sys.into_owned())?;
        let far = self.sys.far().ok_or("there is no core")?;
        self.take_yardstick_for(saved.run.yardstick_tension)?;
        self.coil_mut().restore(saved.coil, far)?;
        if !saved.run.watch.fits(self.sys.state.rod.nodes()) {
            return Err("the watch does not go with the nodes");
        }
        if !saved.run.traverse.fits(self.coil.passes()) {
            return Err("the way of the nozzle does not go with the passes");
        }
        let placed = |fault: &Defect| {
            let turns = 1..=MOST_TURNS;
            turns.contains(&fault.turn) && (0.0..=360.0).contains(&fault.angle_deg)
        };
        if !saved.run.faults.iter().all(placed) {
            return Err("the wire failed in a turn that there is not");
        }
        match (&mut self.stepper, saved.implicit) {
            (Stepper::Implicit(method), Some(([next, wanted], statistics))) => {
                method.next = next.clamp(method.shortest, method.longest);
                method.wanted = wanted;
                method.statistics = statistics;
            }
            (Stepper::Explicit { .. }, None) => {}
            _ => return Err("the method is another one"),
        }
        self.run = saved.run.into_owned();
        Ok(())
    }

    /// Tells cores apart whose scene is the same: the file of a mesh may have changed.
    fn core_checksum(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        if let Some(surface) = &self.sys.model.core {
            let mesh = surface.mesh();
            for x in mesh.vertices.iter().flatten() {
                sum.update(&x.to_bits().to_le_bytes());
            }
            for k in mesh.triangles.iter().flatten() {
                sum.update(&k.to_le_bytes());
            }
        }
        sum.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::DefectKind;
    use crate::settings::SceneSettings;

    /// The table of turns of such a state grew to the turn of the fault: 800 GB, and the process was gone.
    #[test]
    fn a_fault_in_a_turn_that_nobody_winds_is_no_state() {
        let scene = SceneSettings::load("fig8").expect("packed");
        let scene = scene.build().expect("valid");
        let sim = Simulation::new(&scene).expect("starts");
        let restored = |turn, angle_deg| {
            let mut sim = sim.clone();
            Arc::make_mut(&mut sim.now).run.faults.push(Defect {
                kind: DefectKind::Slack,
                turn,
                layer: 1,
                angle_deg,
                found_turn: turn,
                found_angle_deg: angle_deg,
                time_s: 0.0,
                until_s: None,
                size_m: None,
                size_d: None,
                place_m: [0.0; 3],
            });
            Simulation::from_bytes(&scene, &sim.to_bytes().expect("bytes"))
        };
        assert_eq!(restored(3, 90.0).expect("a state").turns().len(), 3);
        for (turn, angle) in [(0, 90.0), (u32::MAX, 90.0), (3, f64::NAN), (3, 1e300)] {
            let error = restored(turn, angle).expect_err("no state");
            assert!(error.to_string().contains("failed in a turn"), "{error}");
        }
    }
}
