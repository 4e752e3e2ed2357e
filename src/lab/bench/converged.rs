//! Converged runs kept with a scene: what `coilwind bench W` measures errors against.
//!
//! One file per scene, one entry per spindle speed: means over an ensemble of runs with fine
//! spacing and tight tolerance, since a single run scatters. Made by `coilwind bench W --store FILE`.

use super::error::BenchError;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Files inside the program, by scene.
const PACKED: &[(&str, &str)] = &[(
    "fig8",
    include_str!("../../scene/packed/fig8_converged.json"),
)];

/// Kept digits: a nanometre, a tenth of a millinewton.
const LENGTH_DIGIT: f64 = 1e9;
const FORCE_DIGIT: f64 = 1e4;

/// Converged runs of one scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Converged {
    /// packed name or file stem
    pub scene: String,
    /// by spindle speed, ascending
    pub speeds: Vec<Speed>,
}

/// Smallest and largest tension of a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extremes {
    /// N
    #[serde(rename = "min_N")]
    pub min: f64,
    /// N
    #[serde(rename = "max_N")]
    pub max: f64,
}

/// Ensemble means at one spindle speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Speed {
    /// rad/s
    pub omega: f64,
    /// of the implicit method, m
    pub tolerance: f64,
    /// edge length near the core, m
    pub spacing_near: f64,
    /// the ensemble, m
    pub nozzle_distances: Vec<f64>,
    /// mean bulge at the stations of turn 2, m
    pub bulge_m: Vec<Option<f64>>,
    /// mean gap there, m
    pub gap_m: Vec<Option<f64>>,
    /// rms over the stations of the ensemble's standard deviation, m
    pub bulge_scatter_m: f64,
    /// see `bulge_scatter_m`
    pub gap_scatter_m: f64,
    /// mean extremes of each turn of the spindle
    pub tension: Vec<Extremes>,
}

/// What a run is judged by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wound {
    /// bulge at the stations of turn 2, m; `None` where nothing is measured
    pub bulge: Vec<Option<f64>>,
    /// gap to turn 1 there, m; `None` where nothing is measured or no neighbour is found
    pub gap: Vec<Option<f64>>,
    /// tension extremes of each turn of the spindle
    pub tension: Vec<Extremes>,
}

impl Extremes {
    /// Of no values.
    pub(super) fn none() -> Self {
        Self {
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
        }
    }

    /// With these as well.
    pub(super) fn add(&mut self, min: f64, max: f64) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }
}

impl Speed {
    /// Means over the runs of an ensemble.
    pub(super) fn of(
        omega: f64,
        tolerance: f64,
        spacing_near: f64,
        nozzle_distances: Vec<f64>,
        runs: &[Wound],
    ) -> Self {
        let (bulge_m, bulge_scatter_m) = mean(runs, |r| &r.bulge);
        let (gap_m, gap_scatter_m) = mean(runs, |r| &r.gap);
        let turns = runs.iter().map(|r| r.tension.len()).min().unwrap_or(0);
        let share = 1.0 / runs.len().max(1) as f64;
        let tension = (0..turns)
            .map(|turn| {
                let of = |value: fn(&Extremes) -> f64| {
                    let sum: f64 = runs.iter().map(|r| value(&r.tension[turn])).sum();
                    rounded(share * sum, FORCE_DIGIT)
                };
                Extremes {
                    min: of(|e| e.min),
                    max: of(|e| e.max),
                }
            })
            .collect();
        Self {
            omega,
            tolerance,
            spacing_near,
            nozzle_distances,
            bulge_m,
            gap_m,
            bulge_scatter_m,
            gap_scatter_m,
            tension,
        }
    }
}

/// Means by station over the runs that have the station, where most of them do, and the rms of
/// their standard deviations.
fn mean(runs: &[Wound], of: fn(&Wound) -> &Vec<Option<f64>>) -> (Vec<Option<f64>>, f64) {
    let stations = runs.iter().map(|r| of(r).len()).max().unwrap_or(0);
    let (mut variance, mut count) = (0.0, 0);
    let means = (0..stations)
        .map(|k| {
            let values: Vec<f64> = runs
                .iter()
                .filter_map(|r| of(r).get(k).copied().flatten())
                .collect();
            if 2 * values.len() <= runs.len() {
                return None;
            }
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            if values.len() > 1 {
                variance += values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
            }
            count += 1;
            Some(rounded(mean, LENGTH_DIGIT))
        })
        .collect();
    let scatter = (variance / f64::from(count.max(1))).sqrt();
    (means, rounded(scatter, LENGTH_DIGIT))
}

fn rounded(x: f64, digit: f64) -> f64 {
    (x * digit).round() / digit
}

/// Root mean square difference over the stations that both have, and their number.
pub(super) fn rms(a: &[Option<f64>], b: &[Option<f64>]) -> (Option<f64>, usize) {
    let pairs = || a.iter().zip(b).filter_map(|(a, b)| a.zip(*b));
    let count = pairs().count();
    let sum: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
    ((count > 0).then(|| (sum / count as f64).sqrt()), count)
}

impl Converged {
    /// Those that come with the program, if the scene has any.
    pub fn packed(scene: &str) -> Result<Option<Self>, BenchError> {
        let found = PACKED.iter().find(|p| p.0 == scene);
        found
            .map(|(name, text)| Self::parse(text, &format!("{name}_converged.json (packed)")))
            .transpose()
    }

    /// Reads a file.
    pub fn load(path: &Path) -> Result<Self, BenchError> {
        let text = std::fs::read_to_string(path).map_err(|e| file_error(path, e.to_string()))?;
        Self::parse(&text, &path.display().to_string())
    }

    fn parse(text: &str, file: &str) -> Result<Self, BenchError> {
        let read: Self = serde_json::from_str(text).map_err(|e| BenchError::File {
            file: file.to_owned(),
            reason: format!("not a file of converged runs: {e}"),
        })?;
        Ok(read)
    }

    /// The file as it is, or a new one for the scene where there is none.
    pub(super) fn load_or_new(path: &Path, scene: &str) -> Result<Self, BenchError> {
        if !path.exists() {
            return Ok(Self {
                scene: scene.to_owned(),
                speeds: Vec::new(),
            });
        }
        let read = Self::load(path)?;
        if read.scene != scene {
            let reason = format!("has runs of scene {}, not of {scene}", read.scene);
            return Err(file_error(path, reason));
        }
        Ok(read)
    }

    /// With this speed added or replaced.
    pub(super) fn with(mut self, speed: Speed) -> Self {
        self.speeds.retain(|s| s.omega != speed.omega);
        self.speeds.push(speed);
        self.speeds.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        self
    }

    pub(super) fn save(&self, path: &Path) -> Result<(), BenchError> {
        let text = serde_json::to_string(self).unwrap_or_default();
        // a line per speed keeps changes to the file readable
        let text = text.replace("{\"omega\"", "\n{\"omega\"") + "\n";
        std::fs::write(path, text).map_err(|e| file_error(path, e.to_string()))
    }

    /// The entry of a speed, rad/s.
    pub fn at(&self, omega: f64) -> Option<&Speed> {
        self.speeds.iter().find(|s| (s.omega - omega).abs() < 1e-9)
    }
}

fn file_error(path: &Path, reason: String) -> BenchError {
    BenchError::File {
        file: path.display().to_string(),
        reason,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wound(bulge: f64, gap: &[Option<f64>]) -> Wound {
        Wound {
            bulge: vec![Some(bulge); gap.len()],
            gap: gap.to_vec(),
            tension: vec![Extremes {
                min: 10.0 + bulge,
                max: 20.0,
            }],
        }
    }

    #[test]
    fn means_and_scatter_are_those_of_the_ensemble() {
        let runs = [
            wound(1e-3, &[None, Some(1e-4)]),
            wound(3e-3, &[Some(5e-4), Some(3e-4)]),
        ];
        let speed = Speed::of(30.0, 2e-7, 2.5e-4, vec![0.06, 0.061], &runs);
        assert_eq!(speed.bulge_m, [Some(2e-3); 2]);
        assert_eq!(speed.gap_m, [None, Some(2e-4)]);
        assert!((speed.bulge_scatter_m - 2.0_f64.sqrt() * 1e-3).abs() < 1e-8);
        assert!((speed.tension[0].min - 10.002).abs() < 1e-9);
    }

    #[test]
    fn a_file_keeps_one_entry_per_speed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.json");
        let entry = |omega| Speed::of(omega, 2e-7, 2.5e-4, vec![0.06], &[wound(1e-3, &[None])]);
        for omega in [500.0, 30.0, 500.0] {
            let file = Converged::load_or_new(&path, "fig8").unwrap();
            file.with(entry(omega)).save(&path).unwrap();
        }
        let read = Converged::load(&path).unwrap();
        assert_eq!(read.speeds.len(), 2);
        assert_eq!(read.at(30.0), Some(&entry(30.0)));
        assert_eq!(read.at(31.0), None);
        let error = Converged::load_or_new(&path, "bobbin").unwrap_err();
        assert!(error.to_string().contains("not of bobbin"));
    }

    #[test]
    fn packed_files_are_readable_and_belong_to_their_scenes() {
        for (scene, _) in PACKED {
            assert_eq!(Converged::packed(scene).unwrap().unwrap().scene, *scene);
        }
    }

    #[test]
    fn the_rms_is_over_common_stations() {
        let a = [Some(1.0), None, Some(3.0)];
        let b = [Some(4.0), Some(9.0), Some(7.0)];
        assert_eq!(rms(&a, &b), (Some(12.5_f64.sqrt()), 2));
        assert_eq!(rms(&[None], &[None]).0, None);
    }
}
