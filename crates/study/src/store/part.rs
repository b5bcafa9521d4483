//! The file of a part: values row by row as they are computed, then the outcome of the samples, then a hash of all
//! before.
//!
//! Values are f64 in little-endian order, each row with its lines, each line with its samples. A file appears under
//! its name when it is whole.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use sha2::{Digest, Sha256};
use tempfile::NamedTempFile;

use super::FORMAT;
use super::error::StoreError;
use super::tuning::TUNING;
use super::whole::{self, Durable};
use crate::methods::Simulated;
use crate::numerics::ScanBounds;

const MAGIC: &[u8; 8] = b"mbint\x00pt";
const HEADER: u64 = 12;
const HASH: u64 = 32;

/// The end of a part: the outcome of the samples, and the bounds of a scan.
type Outcome = (Simulated, Option<ScanBounds>);

/// Writes a part.
#[derive(Debug)]
pub struct PartWriter {
    path: PathBuf,
    begun: Instant,
    file: BufWriter<NamedTempFile>,
    hash: Sha256,
    bytes: Vec<u8>,
}

impl PartWriter {
    pub(super) fn begin(path: &Path) -> Result<Self, StoreError> {
        // A path of the store lies in one of its folders.
        let folder = path.parent().unwrap_or(Path::new("."));
        let file = whole::begin(folder).map_err(|error| StoreError::io(path, error))?;
        let (begun, file) = (Instant::now(), BufWriter::with_capacity(1 << 18, file));
        let mut writer = Self { path: path.to_owned(), begun, file, hash: Sha256::new(), bytes: Vec::new() };
        let header = [&MAGIC[..], &FORMAT.to_le_bytes()].concat();
        writer.write(&header)?;
        Ok(writer)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), StoreError> {
        self.hash.update(bytes);
        self.file.write_all(bytes).map_err(|error| StoreError::io(&self.path, error))
    }

    /// The next rows' values.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn rows(&mut self, values: &[f64]) -> Result<(), StoreError> {
        let mut bytes = std::mem::take(&mut self.bytes);
        bytes.clear();
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let written = self.write(&bytes);
        self.bytes = bytes;
        written
    }

    /// Ends the part, which is whole then.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(mut self, simulated: &Simulated, scan: Option<&ScanBounds>) -> Result<(), StoreError> {
        let outcome = postcard::to_stdvec(&(simulated, scan))?;
        self.write(&outcome)?;
        let length = outcome.len() as u64;
        self.write(&length.to_le_bytes())?;
        let hash = self.hash.finalize_reset();
        let failed = |error| StoreError::io(&self.path, error);
        self.file.write_all(&hash).map_err(failed)?;
        let file = self.file.into_inner().map_err(|error| StoreError::io(&self.path, error.into_error()))?;
        let durable = if self.begun.elapsed() > TUNING.worth_syncing { Durable::Now } else { Durable::Soon };
        whole::persist(file, &self.path, durable).map_err(|error| StoreError::io(&self.path, error))
    }
}

/// A part that is whole. Its file is open only while it is read: a study may have more parts than a process may have
/// files.
#[derive(Debug)]
pub struct PartReader {
    path: PathBuf,
    /// Offset of the next value.
    next: u64,
    /// The outcome of the samples.
    pub simulated: Simulated,
    /// The bounds, of a part of a scan.
    pub scan: Option<ScanBounds>,
    /// Values that are not read yet.
    left: u64,
    bytes: Vec<u8>,
}

impl PartReader {
    /// `None` if there is no file, or it is damaged.
    pub(super) fn open(path: &Path) -> Result<Option<Self>, StoreError> {
        let failed = |error| StoreError::io(path, error);
        let file = match File::open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(failed(error)),
        };
        let length = file.metadata().map_err(failed)?.len();
        let mut file = BufReader::with_capacity(1 << 18, file);
        if length < HEADER + HASH + 8 || !is_whole(&mut file, length).map_err(failed)? {
            return Ok(None);
        }
        let outcome = length_of_outcome(&mut file, length).map_err(failed)?;
        let Some(values) = (length - HEADER - HASH - 8).checked_sub(outcome) else { return Ok(None) };
        let mut bytes = vec![0; outcome as usize];
        file.seek(SeekFrom::Start(HEADER + values)).map_err(failed)?;
        file.read_exact(&mut bytes).map_err(failed)?;
        let Ok((simulated, scan)) = postcard::from_bytes::<Outcome>(&bytes) else { return Ok(None) };
        Ok(Some(Self { path: path.to_owned(), next: HEADER, simulated, scan, left: values / 8, bytes: Vec::new() }))
    }

    /// Values that are not read yet.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// The next values, as many as `into` takes.
    ///
    /// # Errors
    /// If there are fewer, or they cannot be read.
    pub fn read(&mut self, into: &mut [f64]) -> Result<(), StoreError> {
        self.left = self.left.checked_sub(into.len() as u64).ok_or_else(|| StoreError::damaged(&self.path))?;
        self.bytes.resize(8 * into.len(), 0);
        let failed = |error| StoreError::io(&self.path, error);
        let mut file = File::open(&self.path).map_err(failed)?;
        file.seek(SeekFrom::Start(self.next)).map_err(failed)?;
        file.read_exact(&mut self.bytes).map_err(failed)?;
        self.next += self.bytes.len() as u64;
        for (value, bytes) in into.iter_mut().zip(self.bytes.as_chunks::<8>().0) {
            *value = f64::from_le_bytes(*bytes);
        }
        Ok(())
    }
}

/// Whether the file's hash is that of its bytes, and its format is this.
fn is_whole(file: &mut BufReader<File>, length: u64) -> std::io::Result<bool> {
    let mut header = [0; HEADER as usize];
    file.read_exact(&mut header)?;
    if header[..8] != MAGIC[..] || header[8..] != FORMAT.to_le_bytes() {
        return Ok(false);
    }
    let mut hash = Sha256::new().chain_update(header);
    let mut left = length - HEADER - HASH;
    let mut bytes = vec![0; 1 << 18];
    while left > 0 {
        let count = left.min(bytes.len() as u64) as usize;
        file.read_exact(&mut bytes[..count])?;
        hash.update(&bytes[..count]);
        left -= count as u64;
    }
    let mut written = [0; HASH as usize];
    file.read_exact(&mut written)?;
    Ok(hash.finalize()[..] == written)
}

fn length_of_outcome(file: &mut BufReader<File>, length: u64) -> std::io::Result<u64> {
    let mut bytes = [0; 8];
    file.seek(SeekFrom::Start(length - HASH - 8))?;
    file.read_exact(&mut bytes)?;
    Ok(u64::from_le_bytes(bytes))
}
