//! A saved state of an instance: a copy in memory, and the bytes of one.
//!
//! ```text
//! magic, 8 bytes | version, 4 | GUID, 38 | length of the rest, 8 | CRC-32 of the rest, 4 | the rest
//! ```
//!
//! Numbers in the header have the low byte first. The checksum finds damage, not forgery; what is
//! decoded is checked all the same before it is used.

use crate::clock::Clock;
use crate::lifecycle::State;
use crate::parameters::{Parameters, SavedParameters};
use crate::refusal::Refusal;
use coilwind::output::Mark;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

const MAGIC: &[u8; 8] = b"\x89CoilFMU";
/// Changes whenever the bytes of the same state do.
const VERSION: u32 = 2;
/// A GUID with its braces.
const GUID: usize = 38;
const HEADER: usize = 8 + 4 + GUID + 8 + 4;

/// Bytes that are no state of an instance of this FMU.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BytesError {
    /// other magic, or too short for a header
    #[error("these {size} bytes are not a state of this FMU")]
    Foreign { size: usize },
    /// of another version of the format
    #[error("the state is of version {found}, this FMU reads version {VERSION}")]
    Version { found: u32 },
    /// of an FMU with other variables
    #[error("the state is of the FMU {found}, this one is {expected}")]
    Guid {
        found: String,
        expected: &'static str,
    },
    /// the end is missing
    #[error("the state takes {needed} bytes, {size} are there")]
    Truncated { size: usize, needed: u64 },
    /// changed on the way
    #[error("the state is damaged: its checksum is wrong")]
    Damaged,
    /// what it says cannot be
    #[error("the state contradicts itself: {0}")]
    Impossible(&'static str),
    /// cannot be decoded or encoded
    #[error("the state cannot be read: {0}")]
    Code(#[from] postcard::Error),
}

/// What an instance is between two calls, without name, logging and open files.
#[derive(Clone, Debug)]
pub(crate) struct Snapshot {
    pub(crate) state: State,
    pub(crate) clock: Clock,
    pub(crate) parameters: Parameters,
    /// inputs and their derivatives set before the start, by reference
    pub(crate) start_inputs: BTreeMap<u32, f64>,
    pub(crate) start_rates: BTreeMap<u32, f64>,
    pub(crate) run: Option<SavedRun>,
}

/// A started simulation. Its settled wire is shared with the instance and with other copies.
#[derive(Clone, Debug)]
pub(crate) struct SavedRun {
    pub(crate) simulation: Simulation,
    pub(crate) inputs: Inputs,
    pub(crate) rates: Inputs,
    /// place in the history, where one is written
    pub(crate) mark: Option<Mark>,
}

/// The same as bytes have it.
#[derive(Serialize, Deserialize)]
struct Contents {
    state: State,
    clock: Clock,
    parameters: SavedParameters,
    start_inputs: BTreeMap<u32, f64>,
    start_rates: BTreeMap<u32, f64>,
    run: Option<(Vec<u8>, Inputs, Inputs, Option<Mark>)>,
}

impl Snapshot {
    /// As bytes, for an FMU with this GUID.
    pub(crate) fn to_bytes(&self, guid: &str) -> Result<Vec<u8>, Refusal> {
        let run = match &self.run {
            Some(run) => {
                let simulation = run.simulation.to_bytes()?;
                Some((simulation, run.inputs, run.rates, run.mark))
            }
            None => None,
        };
        let contents = postcard::to_stdvec(&Contents {
            state: self.state,
            clock: self.clock,
            parameters: self.parameters.saved(),
            start_inputs: self.start_inputs.clone(),
            start_rates: self.start_rates.clone(),
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

    /// The other way round; nothing of the instance is needed for it.
    pub(crate) fn from_bytes(bytes: &[u8], guid: &'static str) -> Result<Self, Refusal> {
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
        let parameters = Parameters::restored(contents.parameters)?;
        let run = match contents.run {
            Some((simulation, inputs, rates, mark)) => {
                let (scene, _) = parameters.scene()?;
                Some(SavedRun {
                    simulation: Simulation::from_bytes(&scene, &simulation)?,
                    inputs,
                    rates,
                    mark,
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
            run,
        })
    }
}

/// Text in a field of fixed length.
fn fixed(text: &str) -> [u8; GUID] {
    let mut field = [0; GUID];
    field.iter_mut().zip(text.bytes()).for_each(|(f, b)| *f = b);
    field
}

/// What is behind the header, once that is right.
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
        return Err(BytesError::Version { found: version });
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
    let contents = contents.ok_or(BytesError::Truncated {
        size,
        needed: length.saturating_add(HEADER as u64),
    })?;
    if u64::from(crc32fast::hash(contents)) != number(4 + GUID + 8, 4) {
        return Err(BytesError::Damaged);
    }
    Ok(contents)
}
