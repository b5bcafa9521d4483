//! The zip archive of a unit.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use data_encoding::HEXLOWER;
use rawzip::{CompressionMethod, RECOMMENDED_BUFFER_SIZE, ZipArchive};
use sha2::{Digest, Sha256};

use super::NotRead;
use super::tuning::TUNING;

/// The file of the description.
const DESCRIPTION: &str = "modelDescription.xml";

/// SHA-256 of a file, in hexadecimal digits.
///
/// # Errors
/// If it cannot be read.
pub fn digest(path: &Path) -> std::io::Result<String> {
    let (mut file, mut hash, mut buffer) = (File::open(path)?, Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut buffer)? {
            0 => break,
            read => hash.update(&buffer[..read]),
        }
    }
    Ok(HEXLOWER.encode(&hash.finalize()))
}

/// Text of the description of a unit.
///
/// # Errors
/// If the file is not an archive with a description.
pub(super) fn description(path: &Path) -> Result<String, NotRead> {
    let mut text = None;
    each(path, |name, content| {
        if name == DESCRIPTION {
            let mut found = String::new();
            content.take(TUNING.description_bytes).read_to_string(&mut found)?;
            text = Some(found);
        }
        Ok(())
    })?;
    text.ok_or(NotRead::NoDescription)
}

/// Writes all files of a unit below a folder.
///
/// # Errors
/// If an entry cannot be read or written, or leads out of the folder.
pub fn unpack(path: &Path, folder: &Path) -> Result<(), NotRead> {
    each(path, |name, content| {
        let target = folder.join(name);
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent)?;
        }
        let mut file = File::create(&target)?;
        std::io::copy(&mut content.take(TUNING.entry_bytes), &mut file)?;
        Ok(())
    })
}

/// Visits the files of an archive: their paths, without a way out of the archive, and their content.
fn each(path: &Path, mut visit: impl FnMut(&str, &mut dyn Read) -> std::io::Result<()>) -> Result<(), NotRead> {
    let mut buffer = vec![0; RECOMMENDED_BUFFER_SIZE];
    let archive = ZipArchive::from_file(File::open(path)?, &mut buffer)?;
    let mut entries = archive.entries(&mut buffer);
    while let Some(entry) = entries.next_entry()? {
        if entry.is_dir() {
            continue;
        }
        let name = entry.file_path().try_normalize()?.as_ref().to_owned();
        let method = entry.compression_method();
        let local = archive.get_entry(entry.wayfinder())?;
        let raw = local.reader();
        let visited = match method {
            CompressionMethod::STORE => visit(&name, &mut local.verifying_reader(raw)),
            CompressionMethod::DEFLATE => {
                visit(&name, &mut local.verifying_reader(flate2::read::DeflateDecoder::new(raw)))
            }
            other => Err(std::io::Error::other(format!("its compression ({other:?}) is not deflate"))),
        };
        visited.map_err(|error| NotRead::Entry { name, why: error.to_string() })?;
    }
    Ok(())
}
