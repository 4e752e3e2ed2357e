//! A saved state of an instance, as a copy in memory and as bytes.
//!
//! The bytes are a header and the contents:
//!
//! | field | bytes |
//! |---|---|
//! | magic | 8 |
//! | version of the format | 4 |
//! | GUID of the FMU | 38 |
//! | length of the contents | 8 |
//! | CRC-32 of the contents | 4 |
//! | contents, encoded with postcard | the rest |
//!
//! Numbers in the header have the low byte first. The checksum finds damage, not forgery, so that
//! decoded contents are checked before they are used.

use crate::clock::Clock;
use crate::error::{BytesError, Error};
use crate::instance::LastStep;
use crate::lifecycle::State;
use crate::parameters::{Parameters, SavedParameters};
use coilwind::measure::DefectLimits;
use coilwind::output::Mark;
use coilwind::scene::Scene;
use coilwind::settings::Friction;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

const MAGIC: &[u8; 8] = b"\x89CoilFMU";
/// Version of the format. It changes whenever the bytes of the same state do.
const VERSION: u32 = 8;
/// Bytes of a GUID with its braces.
const GUID: usize = 38;
const HEADER: usize = 8 + 4 + GUID + 8 + 4;

/// Everything that an instance is between two calls, except name, logging and open files.
#[derive(Clone, Debug)]
pub(crate) struct Snapshot {
    pub(crate) state: State,
    pub(crate) clock: Clock,
    pub(crate) parameters: Parameters,
    /// Inputs set before the start, by value reference.
    pub(crate) start_inputs: BTreeMap<u32, f64>,
    /// Derivatives of inputs set before the start, per s, by value reference.
    pub(crate) start_rates: BTreeMap<u32, f64>,
    /// Whether the FMU demonstrates the scene's motion, since nothing was set.
    pub(crate) demonstrates: bool,
    pub(crate) run: Option<SavedRun>,
}

/// A started simulation. Settled wire shares its memory with the instance and with other copies.
#[derive(Clone, Debug)]
pub(crate) struct SavedRun {
    pub(crate) simulation: Simulation,
    pub(crate) inputs: Inputs,
    pub(crate) rates: Inputs,
    /// The last step as it began, if there was one.
    pub(crate) last: Option<Arc<LastStep>>,
    /// Place in the history, if one is written.
    pub(crate) mark: Option<Mark>,
}

/// A snapshot in the form that is encoded.
#[derive(Serialize, Deserialize)]
struct Contents {
    state: State,
    clock: Clock,
    parameters: SavedParameters,
    start_inputs: BTreeMap<u32, f64>,
    start_rates: BTreeMap<u32, f64>,
    demonstrates: bool,
    run: Option<RunBytes>,
}

/// A [`SavedRun`] in the form that is encoded.
#[derive(Serialize, Deserialize)]
struct RunBytes {
    simulation: SimulationBytes,
    inputs: Inputs,
    rates: Inputs,
    /// The last step: the simulation as it began, inputs, their derivatives, length.
    last: Option<(SimulationBytes, Inputs, Inputs, f64)>,
    mark: Option<Mark>,
}

/// A simulation in the form that is encoded, with the tunable parameters that it has taken over. Others may have been set since,
/// which the next step takes over.
#[derive(Serialize, Deserialize)]
struct SimulationBytes {
    friction: Friction,
    defects: DefectLimits,
    bytes: Vec<u8>,
}

impl SimulationBytes {
    /// # Errors
    ///
    /// If the simulation cannot be encoded.
    fn of(simulation: &Simulation) -> Result<Self, Error> {
        let scene = simulation.scene();
        Ok(Self {
            friction: scene.friction,
            defects: scene.defects,
            bytes: simulation.to_bytes()?,
        })
    }

    /// Returns the simulation, of an instance with these `parameters`, whose scene is `scene`.
    ///
    /// # Errors
    ///
    /// If the bytes are not those of a simulation of that scene, or the tunable parameters are not valid.
    fn restored(&self, parameters: &Parameters, scene: &Scene) -> Result<Simulation, Error> {
        let mut simulation = if (self.friction, self.defects) == parameters.tunable() {
            Simulation::from_bytes(scene, &self.bytes)?
        } else {
            let (scene, _) = parameters.tuned(self.friction, self.defects).scene()?;
            Simulation::from_bytes(&scene, &self.bytes)?
        };
        simulation.step_beyond(scene.solver.features.steps_beyond);
        Ok(simulation)
    }
}

impl Snapshot {
    /// Returns the bytes of the state, for an FMU with this GUID.
    ///
    /// # Errors
    ///
    /// If the state cannot be encoded.
    pub(crate) fn to_bytes(&self, guid: &str) -> Result<Vec<u8>, Error> {
        let run = match &self.run {
            Some(run) => {
                let last = match run.last.as_deref() {
                    Some(last) => {
                        let simulation = SimulationBytes::of(&last.simulation)?;
                        Some((simulation, last.inputs, last.rates, last.step))
                    }
                    None => None,
                };
                Some(RunBytes {
                    simulation: SimulationBytes::of(&run.simulation)?,
                    inputs: run.inputs,
                    rates: run.rates,
                    last,
                    mark: run.mark,
                })
            }
            None => None,
        };
        let contents = postcard::to_stdvec(&Contents {
            state: self.state,
            clock: self.clock,
            parameters: self.parameters.saved(),
            start_inputs: self.start_inputs.clone(),
            start_rates: self.start_rates.clone(),
            demonstrates: self.demonstrates,
            run,
        })
        .map_err(BytesError::Code)?;
        let mut bytes = Vec::with_capacity(HEADER + contents.len());
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(fixed(guid));
        bytes.extend((contents.len() as u64).to_le_bytes());
        bytes.extend(crc32fast::hash(&contents).to_le_bytes());
        bytes.extend(contents);
        Ok(bytes)
    }

    /// Returns the state of bytes that an FMU with this GUID wrote, for one whose resources are unpacked in
    /// `resources`. [`Self::to_bytes`] is the inverse.
    ///
    /// # Errors
    ///
    /// If the bytes are not a state of this FMU, or one that no instance is ever in.
    pub(crate) fn from_bytes(
        bytes: &[u8],
        guid: &'static str,
        resources: Option<&Path>,
    ) -> Result<Self, Error> {
        let contents = open(bytes, guid)?;
        let (contents, rest) =
            postcard::take_from_bytes::<Contents>(contents).map_err(BytesError::Code)?;
        if !rest.is_empty() {
            return Err(BytesError::Impossible("there is more than a state").into());
        }
        if contents.state == State::Fatal || !contents.clock.is_sound() {
            return Err(BytesError::Impossible("no instance is like that").into());
        }
        let needs_run = [State::StepComplete, State::StepFailed];
        if needs_run.contains(&contents.state) && contents.run.is_none() {
            return Err(BytesError::Impossible("it has steps behind it, but no wire").into());
        }
        let parameters = Parameters::restored(contents.parameters, resources)?;
        let run = match contents.run {
            Some(run) => {
                parameters.find_files(resources)?;
                let (scene, _) = parameters.scene()?;
                let last = match run.last {
                    Some((simulation, inputs, rates, step)) => Some(Arc::new(LastStep {
                        simulation: simulation.restored(&parameters, &scene)?,
                        inputs,
                        rates,
                        step,
                    })),
                    None => None,
                };
                Some(SavedRun {
                    simulation: run.simulation.restored(&parameters, &scene)?,
                    inputs: run.inputs,
                    rates: run.rates,
                    last,
                    mark: run.mark,
                })
            }
            None => None,
        };
        Ok(Self {
            state: contents.state,
            clock: contents.clock,
            parameters,
            start_inputs: contents.start_inputs,
            start_rates: contents.start_rates,
            demonstrates: contents.demonstrates,
            run,
        })
    }
}

/// Returns a GUID in its field of the header.
fn fixed(text: &str) -> [u8; GUID] {
    let mut field = [0; GUID];
    field.iter_mut().zip(text.bytes()).for_each(|(f, b)| *f = b);
    field
}

/// Checks the header and the checksum, and returns the contents.
fn open<'a>(bytes: &'a [u8], guid: &'static str) -> Result<&'a [u8], BytesError> {
    let size = bytes.len();
    let foreign = || BytesError::Foreign { size };
    let (header, rest) = bytes.split_at_checked(HEADER).ok_or_else(foreign)?;
    let (magic, header) = header.split_at(MAGIC.len());
    if magic != MAGIC {
        return Err(foreign());
    }
    let number = |at: usize, bytes: usize| {
        let low_first = header[at..at + bytes].iter().rev();
        low_first.fold(0u64, |n, b| n << 8 | u64::from(*b))
    };
    let version = number(0, 4) as u32;
    if version != VERSION {
        return Err(BytesError::Version {
            found: version,
            expected: VERSION,
        });
    }
    let found = &header[4..4 + GUID];
    if found != fixed(guid) {
        return Err(BytesError::Guid {
            found: String::from_utf8_lossy(found).into_owned(),
            expected: guid,
        });
    }
    let length = number(4 + GUID, 8);
    let contents = usize::try_from(length).ok().and_then(|n| rest.get(..n));
    let needed = length.saturating_add(HEADER as u64);
    let contents = contents.ok_or(BytesError::Truncated { size, needed })?;
    // (a buffer may be larger than the state, and is zero behind it)
    if rest[contents.len()..].iter().any(|byte| *byte != 0) {
        return Err(BytesError::Longer { size, needed });
    }
    if u64::from(crc32fast::hash(contents)) != number(4 + GUID + 8, 4) {
        return Err(BytesError::Damaged);
    }
    Ok(contents)
}
