//! `turns.csv`, `stations.csv` and `defects.csv`: the measures as tables, SI units, empty where nothing applies.

use super::{OutputError, write_whole};
use crate::measure::{Defect, DefectKind, STATIONS_PER_TURN, Station, TurnMeasures, Verdict};
use serde::Serialize;
use std::f64::consts::TAU;
use std::path::Path;

#[derive(Serialize)]
struct TurnRow {
    turn: u32,
    layer: u32,
    turn_in_layer: u32,
    verdict: Verdict,
    settled: f64,
    stations: u32,
    gap_mean: Option<f64>,
    gap_rms: Option<f64>,
    gap_max: Option<f64>,
    gap_over: f64,
    gap_run: f64,
    flange_gap: Option<f64>,
    axial_mean: Option<f64>,
    bulge_max: f64,
    bulge_excess_max: Option<f64>,
    bulge_face_px: f64,
    bulge_face_pz: f64,
    bulge_face_nx: f64,
    bulge_face_nz: f64,
    overlap_max: f64,
    layer_max: u32,
    out_of_groove: f64,
}

/// Writes `turns.csv`: one row per turn.
pub fn write_turns(path: &Path, turns: &[TurnMeasures]) -> Result<(), OutputError> {
    write_rows(path, turns.iter().map(TurnRow::from), TURN_HEADER)
}

#[derive(Serialize)]
struct DefectRow {
    kind: DefectKind,
    turn: u32,
    layer: u32,
    angle_deg: f64,
    time_s: f64,
    size_m: Option<f64>,
    size_d: Option<f64>,
    found_turn: u32,
    found_angle_deg: f64,
}

/// Writes `defects.csv`: one row per defect, in the order given.
pub fn write_defects(path: &Path, defects: &[Defect]) -> Result<(), OutputError> {
    write_rows(path, defects.iter().map(DefectRow::from), DEFECT_HEADER)
}

impl From<&Defect> for DefectRow {
    fn from(defect: &Defect) -> Self {
        Self {
            kind: defect.kind,
            turn: defect.turn,
            layer: defect.layer,
            angle_deg: defect.angle_deg,
            time_s: defect.time_s,
            size_m: defect.size_m,
            size_d: defect.size_d,
            found_turn: defect.found_turn,
            found_angle_deg: defect.found_angle_deg,
        }
    }
}

#[derive(Serialize)]
struct StationRow {
    turn: usize,
    station: usize,
    angle: f64,
    polar: f64,
    x: f64,
    y: f64,
    z: f64,
    radius: f64,
    arc: f64,
    time: f64,
    height: f64,
    bulge: f64,
    bulge_excess: Option<f64>,
    gap: Option<f64>,
    axial: Option<f64>,
    flange_gap: Option<f64>,
    overlap: f64,
    layer: u32,
    pass: u32,
    measured: u8,
    crosses: u8,
    out_of_groove: u8,
}

/// Writes `stations.csv`: one row per station, in the order of
/// [`Coil::stations`](crate::measure::Coil::stations).
///
/// `angle` runs from the clamp without end, `polar` is `atan2(z, x)` in the core frame.
pub fn write_stations<'a>(
    path: &Path,
    stations: impl Iterator<Item = &'a Station>,
) -> Result<(), OutputError> {
    write_rows(
        path,
        stations.enumerate().map(StationRow::from),
        STATION_HEADER,
    )
}

impl From<&TurnMeasures> for TurnRow {
    fn from(turn: &TurnMeasures) -> Self {
        let [px, pz, nx, nz] = turn.bulge_faces;
        Self {
            turn: turn.turn,
            layer: turn.layer,
            turn_in_layer: turn.turn_in_layer,
            verdict: turn.verdict,
            settled: turn.settled,
            stations: turn.stations,
            gap_mean: turn.gap_mean,
            gap_rms: turn.gap_rms,
            gap_max: turn.gap_max,
            gap_over: turn.gap_over,
            gap_run: turn.gap_run,
            flange_gap: turn.flange_gap,
            axial_mean: turn.axial_mean,
            bulge_max: turn.bulge_max,
            bulge_excess_max: turn.bulge_excess_max,
            bulge_face_px: px,
            bulge_face_pz: pz,
            bulge_face_nx: nx,
            bulge_face_nz: nz,
            overlap_max: turn.overlap_max,
            layer_max: turn.layer_max,
            out_of_groove: turn.out_of_groove,
        }
    }
}

impl From<(usize, &Station)> for StationRow {
    fn from((index, station): (usize, &Station)) -> Self {
        let p = station.position;
        Self {
            turn: index / STATIONS_PER_TURN + 1,
            station: index % STATIONS_PER_TURN,
            angle: station.angle,
            polar: crate::math::polar_angle(p).rem_euclid(TAU),
            x: p.x,
            y: p.y,
            z: p.z,
            radius: station.radius(),
            arc: station.arc,
            time: station.time,
            height: station.height,
            bulge: station.bulge,
            bulge_excess: station.bulge_excess,
            gap: station.neighbour.map(|n| n.gap),
            axial: station.neighbour.map(|n| n.axial),
            flange_gap: station.flange_gap,
            overlap: station.overlap_depth,
            layer: station.layer,
            pass: station.pass,
            measured: station.measured.into(),
            crosses: station.crosses.into(),
            out_of_groove: station.out_of_groove.into(),
        }
    }
}

/// Headers, for a table without rows; with rows they come from the fields (a test compares).
const TURN_HEADER: &str = "turn,layer,turn_in_layer,verdict,settled,stations,gap_mean,gap_rms,gap_max,gap_over,\
    gap_run,flange_gap,axial_mean,bulge_max,bulge_excess_max,bulge_face_px,bulge_face_pz,bulge_face_nx,\
    bulge_face_nz,overlap_max,layer_max,out_of_groove";
const DEFECT_HEADER: &str =
    "kind,turn,layer,angle_deg,time_s,size_m,size_d,found_turn,found_angle_deg";
const STATION_HEADER: &str = "turn,station,angle,polar,x,y,z,radius,arc,time,height,bulge,\
    bulge_excess,gap,axial,flange_gap,overlap,layer,pass,measured,crosses,out_of_groove";

fn write_rows(
    path: &Path,
    rows: impl Iterator<Item = impl Serialize>,
    header: &str,
) -> Result<(), OutputError> {
    let wrap = |source| OutputError::Csv {
        path: path.to_owned(),
        source,
    };
    write_whole(path, |file| {
        let mut writer = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(file);
        writer.write_record(header.split(',')).map_err(wrap)?;
        for row in rows {
            writer.serialize(row).map_err(wrap)?;
        }
        writer.flush().map_err(OutputError::io(path))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_name_the_fields_in_their_order() {
        let header_of = |row: &dyn Fn(&mut csv::Writer<Vec<u8>>)| {
            let mut writer = csv::Writer::from_writer(Vec::new());
            row(&mut writer);
            let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
            text.lines().next().unwrap().to_owned()
        };
        let turn = TurnRow::from(&TurnMeasures::default());
        assert_eq!(
            header_of(&|writer| writer.serialize(&turn).unwrap()),
            TURN_HEADER
        );
        let defect = DefectRow {
            kind: DefectKind::Break,
            turn: 1,
            layer: 1,
            angle_deg: 0.0,
            time_s: 0.0,
            size_m: None,
            size_d: None,
            found_turn: 1,
            found_angle_deg: 0.0,
        };
        assert_eq!(
            header_of(&|writer| writer.serialize(&defect).unwrap()),
            DEFECT_HEADER
        );
        let station = Station {
            angle: 7.0,
            position: crate::math::V3::new(0.0, 0.0, 1.0),
            arc: 0.0,
            time: 0.0,
            height: 0.0,
            bulge: 0.0,
            bulge_excess: None,
            neighbour: None,
            overlap_depth: 0.0,
            flange_gap: None,
            layer: 1,
            pass: 1,
            measured: true,
            crosses: false,
            out_of_groove: false,
        };
        let station = StationRow::from((0, &station));
        assert_eq!(
            header_of(&|writer| writer.serialize(&station).unwrap()),
            STATION_HEADER
        );
    }
}
