//! `history.csv`: every input, output and diagnostic over time, header from the variable table.

use super::OutputError;
use crate::simulation::Simulation;
use crate::variables::{Access, Value, table};
use serde::{Deserialize, Serialize};
#[cfg(not(windows))]
use std::fs::TryLockError;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows reach the disk at least this often, so that a run that dies leaves what it computed.
const FLUSH: Duration = Duration::from_millis(500);
/// Bytes that the writer keeps at most. Rows leave it together and whole, so that a file ends with a whole row. A kill within
/// the write itself may still cut the last one: the system looks for signals at every page of a file.
const BUFFER: usize = 1 << 17;
/// Bytes from which on they leave; a row has some thousand.
const FULL: usize = BUFFER / 2;

/// A place in a history: how long the file was then, and a checksum of what was in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    bytes: u64,
    checksum: u32,
}

/// A file that knows what was written to it.
#[derive(Debug)]
struct Counted {
    file: File,
    bytes: u64,
    checksum: crc32fast::Hasher,
}

impl Counted {
    fn new(file: File) -> Self {
        Self {
            file,
            bytes: 0,
            checksum: crc32fast::Hasher::new(),
        }
    }

    /// The first `mark.bytes` of a file, if they are what they were; what comes after is cut off.
    fn cut(file: File, mark: &Mark) -> std::io::Result<Option<Self>> {
        let mut counted = Self::new(file);
        let mut left = mark.bytes;
        let mut buffer = [0; 1 << 16];
        while left > 0 {
            let most = buffer
                .len()
                .min(usize::try_from(left).unwrap_or(usize::MAX));
            let got = counted.file.read(&mut buffer[..most])?;
            if got == 0 {
                return Ok(None);
            }
            counted.checksum.update(&buffer[..got]);
            left -= got as u64;
        }
        if counted.checksum.clone().finalize() != mark.checksum {
            return Ok(None);
        }
        counted.bytes = mark.bytes;
        counted.file.set_len(mark.bytes)?;
        Ok(Some(counted))
    }
}

/// What is written at once is in the file afterwards, or nothing of it: a full disk leaves whole rows.
impl Write for Counted {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        if let Err(error) = self.file.write_all(data) {
            // (a device has no end to go back to)
            let _ = self.file.set_len(self.bytes);
            let _ = self.file.seek(SeekFrom::Start(self.bytes));
            return Err(error);
        }
        self.bytes += data.len() as u64;
        self.checksum.update(data);
        Ok(data.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

/// The open file.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    writer: csv::Writer<Counted>,
    flushed: Instant,
    /// bytes that the writer keeps
    pending: usize,
}

impl History {
    /// Creates the file and writes the header.
    ///
    /// # Errors
    /// Where it cannot be written, or another run writes it.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let file = open_alone(path).map_err(OutputError::io(path))?;
        let mut history = Self {
            path: path.to_owned(),
            writer: whole_rows(Counted::new(file)),
            flushed: Instant::now(),
            pending: 0,
        };
        let names = columns().map(|(name, _)| name);
        let written = history
            .writer
            .write_record(std::iter::once("time").chain(names));
        history.checked(written)?;
        history.flush()?;
        Ok(history)
    }

    /// The present end of the file, for [`Self::resume`].
    pub fn mark(&mut self) -> Result<Mark, OutputError> {
        self.flush()?;
        let counted = self.writer.get_ref();
        Ok(Mark {
            bytes: counted.bytes,
            checksum: counted.checksum.clone().finalize(),
        })
    }

    /// Opens the file again at a mark and cuts off what was written after it.
    ///
    /// `None` if the file is not there or is not the one that the mark was made in.
    ///
    /// # Errors
    ///
    /// Where another run writes it, or it cannot be cut.
    pub fn resume(path: &Path, mark: &Mark) -> Result<Option<Self>, OutputError> {
        let file = match alone(File::options().read(true).write(true), path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                return Err(OutputError::io(path)(error));
            }
            Err(_) => return Ok(None),
        };
        let counted = Counted::cut(file, mark).map_err(OutputError::io(path))?;
        Ok(counted.map(|counted| Self {
            path: path.to_owned(),
            writer: whole_rows(counted),
            flushed: Instant::now(),
            pending: 0,
        }))
    }

    /// Writes the state at a communication point, `time` in s. Numbers are in the shortest form
    /// that reads back to the same bits; Booleans are 0 and 1, so that every column reads as
    /// numbers.
    pub fn row(&mut self, time: f64, simulation: &Simulation) -> Result<(), OutputError> {
        let (inputs, outputs) = (simulation.inputs(), simulation.outputs());
        let cells = columns().map(|(_, access)| match access {
            Access::Input { get, .. } => Value::Real(get(&inputs)).to_string(),
            Access::Output(get) => match get(outputs) {
                Value::Boolean(flag) => i32::from(flag).to_string(),
                value => value.to_string(),
            },
            Access::Parameter { .. } | Access::Choice(_) => String::new(),
        });
        let time = Value::Real(time).to_string();
        let mut bytes = 0;
        let cells = std::iter::once(time).chain(cells);
        let written = (self.writer).write_record(cells.inspect(|cell| bytes += cell.len() + 1));
        self.checked(written)?;
        self.pending += bytes;
        if self.pending >= FULL || self.flushed.elapsed() >= FLUSH {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes buffered rows to disk.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.writer.flush().map_err(OutputError::io(&self.path))?;
        self.flushed = Instant::now();
        self.pending = 0;
        Ok(())
    }

    fn checked(&self, written: Result<(), csv::Error>) -> Result<(), OutputError> {
        written.map_err(|source| OutputError::Csv {
            path: self.path.clone(),
            source,
        })
    }
}

/// A writer that is flushed before it is full.
fn whole_rows(counted: Counted) -> csv::Writer<Counted> {
    let mut builder = csv::WriterBuilder::new();
    builder.buffer_capacity(BUFFER).from_writer(counted)
}

/// Opens an empty file that no other run has open; two of them would mix their rows.
fn open_alone(path: &Path) -> std::io::Result<File> {
    let mut options = File::options();
    let file = alone(options.write(true).create(true).truncate(false), path)?;
    let regular = file.metadata()?.is_file();
    if regular {
        file.set_len(0)?;
    }
    Ok(file)
}

/// Opens a file for one writer; an error of the kind `WouldBlock` where it has one.
#[cfg(not(windows))]
fn alone(options: &mut OpenOptions, path: &Path) -> std::io::Result<File> {
    let file = options.open(path)?;
    // (not every file system has locks)
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(taken()),
        _ => Ok(file),
    }
}

/// A lock would keep readers out as well here; who opens a file says what others may do with it.
#[cfg(windows)]
fn alone(options: &mut OpenOptions, path: &Path) -> std::io::Result<File> {
    use std::os::windows::fs::OpenOptionsExt;
    // FILE_SHARE_READ and ERROR_SHARING_VIOLATION of the Windows API
    const READERS: u32 = 1;
    const SHARING_VIOLATION: i32 = 32;
    let opened = options.share_mode(READERS).open(path);
    opened.map_err(|error| match error.raw_os_error() {
        Some(SHARING_VIOLATION) => taken(),
        _ => error,
    })
}

fn taken() -> Error {
    let text = "another run writes here; give each run a folder of its own";
    Error::new(ErrorKind::WouldBlock, text)
}

/// Name and accessor of what changes over time.
fn columns() -> impl Iterator<Item = (&'static str, Access)> {
    table()
        .iter()
        .filter(|v| matches!(v.access, Access::Input { .. } | Access::Output(_)))
        .map(|v| (v.name, v.access))
}
