//! The files that describe a run where it stands: at its end, or on the way.

use super::{
    CoreMesh, OutputError, Picture, WireFields, render_png, write_core_vtp, write_defects,
    write_frame, write_stations, write_summary, write_turns, write_vtp,
};
use crate::geometry::Surface;
use crate::math::V3;
use crate::measure::{Station, UNJUDGED, interrupted, reasons_doubted, reasons_unjudged};
use crate::simulation::{Centreline, SimError, Simulation, Summary};
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;

/// How a run ended.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
pub enum Ending {
    /// as planned
    Done,
    /// before its planned end
    Interrupted,
    /// the solver gave up, or a file could not be written
    Failed {
        /// time, place and reason
        reason: String,
    },
}

impl Ending {
    /// The word for the verdict on a run that ended so, and why, the gravest first.
    ///
    /// A coil that the program could not wind to its planned end is not judged: what is missing may hold a defect. Nor is one
    /// whose own numbers are in doubt.
    pub fn judgement(&self, simulation: &Simulation) -> (&'static str, Vec<String>) {
        match self {
            Self::Failed { reason } => (UNJUDGED, reasons_unjudged(reason, &simulation.defects())),
            Self::Done => match simulation.doubt() {
                Some(doubt) => (UNJUDGED, reasons_doubted(&doubt, &simulation.defects())),
                None => (simulation.verdict().as_str(), simulation.reasons()),
            },
            Self::Interrupted => {
                let (verdict, mut reasons) = Self::Done.judgement(simulation);
                reasons.push(interrupted(simulation.time()));
                (verdict, reasons)
            }
        }
    }
}

/// Files that a run leaves when it ends, beside its history and its scene. Those of an earlier run would pass for those of a later one that is
/// stopped in its folder.
pub const RESULTS: [&str; 11] = [
    "summary.json",
    "turns.csv",
    "stations.csv",
    "defects.csv",
    "coil.vtp",
    "coil.png",
    "core.vtp",
    "report.html",
    "compare.html",
    "frames.pvd",
    "checkpoint.bin",
];

/// What `summary.json` holds: how the run ended, how long it took, and the run itself.
#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    ending: &'a Ending,
    /// wall time of the computation, s
    wall_s: f64,
    /// simulated over wall time
    real_time_factor: f64,
    #[serde(flatten)]
    summary: Summary,
}

/// The core for pictures and heights.
#[derive(Clone, Debug)]
pub struct Snapshot {
    core: Arc<Surface>,
}

impl Snapshot {
    /// The core of this simulation.
    pub fn new(simulation: &Simulation) -> Result<Self, SimError> {
        Ok(Self {
            core: simulation.core()?,
        })
    }

    /// Writes the wire as it is now: `STEM.vtp` (with what is known of it) and `STEM.png`.
    pub fn write(&self, stem: &Path, simulation: &Simulation) -> Result<(), OutputError> {
        let wire = simulation.centreline();
        let radius = simulation.scene().wire.radius();
        let fields = self.fields(&wire, simulation);
        let geometry = write_vtp(
            &stem.with_extension("vtp"),
            &wire,
            radius,
            Some(&fields),
            simulation.time(),
        );
        let picture = Picture::new(Some(self.mesh()), &wire, radius);
        let picture = render_png(&stem.with_extension("png"), &picture);
        geometry.and(picture)
    }

    /// Writes the wire as it is now as a frame of a film, with what is known of it.
    pub fn write_frame(&self, path: &Path, simulation: &Simulation) -> Result<(), OutputError> {
        let wire = simulation.centreline();
        let radius = simulation.scene().wire.radius();
        let fields = self.fields(&wire, simulation);
        write_frame(path, &wire, radius, Some(&fields), simulation.time())
    }

    /// Height of every node, and the measures of the station nearest to it along the wire.
    fn fields(&self, wire: &Centreline, simulation: &Simulation) -> WireFields {
        let radius = simulation.scene().wire.radius();
        let flanges = simulation.scene().core.may_have_flanges();
        let height = |&p: &V3| match flanges {
            true => self.core.height_over_flank(p) - radius,
            false => self.core.nearest(p).distance - radius,
        };
        let mut fields = WireFields {
            height: wire.points.iter().map(height).collect(),
            ..WireFields::default()
        };
        let coil = simulation.coil();
        let stations: Vec<&Station> = coil.stations().collect();
        let marks = coil.defect_marks();
        let end = stations.last().map_or(f64::NEG_INFINITY, |s| s.arc);
        for &arc in &wire.arc {
            let after = stations.partition_point(|station| station.arc < arc);
            let index = match after.checked_sub(1) {
                Some(before) if after == stations.len() => before,
                Some(before) if arc - stations[before].arc < stations[after].arc - arc => before,
                _ => after,
            };
            let station = stations.get(index).filter(|_| arc <= end);
            let gap = station
                .and_then(|s| s.neighbour)
                .map_or(f64::NAN, |n| n.gap);
            fields.gap.push(gap);
            fields.bulge.push(station.map_or(f64::NAN, |s| s.bulge));
            let layer = station.map_or(0, |s| u8::try_from(s.layer).unwrap_or(u8::MAX));
            fields.layer.push(layer);
            fields.defect.push(station.map_or(0, |_| marks[index]));
        }
        fields
    }

    fn mesh(&self) -> CoreMesh<'_> {
        let mesh = self.core.mesh();
        CoreMesh {
            vertices: &mesh.vertices,
            triangles: &mesh.triangles,
        }
    }
}

/// Writes the results of a run into an existing folder: `summary.json`, `defects.csv`, and
/// `turns.csv` and `stations.csv` of wire at rest.
///
/// With a `snapshot` also `coil.vtp`, `core.vtp` and `coil.png` of all wire. `wall_s` is the time
/// computed so far, s.
///
/// # Errors
/// The first failure, after all other files have been written.
pub fn write_results(
    directory: &Path,
    simulation: &Simulation,
    snapshot: Option<&Snapshot>,
    ending: &Ending,
    wall_s: f64,
) -> Result<(), OutputError> {
    let mut summary = simulation.summary();
    let (verdict, reasons) = ending.judgement(simulation);
    (summary.verdict, summary.reasons) = (verdict.to_owned(), reasons);
    let turns = write_turns(&directory.join("turns.csv"), &summary.turns);
    let defects = write_defects(&directory.join("defects.csv"), &summary.defects);
    let real_time_factor = if wall_s > 0.0 {
        simulation.time() / wall_s
    } else {
        0.0
    };
    let report = Report {
        ending,
        wall_s,
        real_time_factor,
        summary,
    };
    let summary = write_summary(&directory.join("summary.json"), &report);
    let stations = write_stations(
        &directory.join("stations.csv"),
        simulation.coil().stations(),
    );
    // (last, since nothing takes as much memory)
    let geometry = snapshot.map_or(Ok(()), |snapshot| {
        let core = snapshot.mesh();
        let surface = write_core_vtp(&directory.join("core.vtp"), core.vertices, core.triangles);
        snapshot
            .write(&directory.join("coil"), simulation)
            .and(surface)
    });
    [turns, defects, summary, stations, geometry]
        .into_iter()
        .collect()
}
