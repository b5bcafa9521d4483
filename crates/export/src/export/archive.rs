//! A unit of FMI: an archive of its files.

use std::io::{self, Write};
use std::path::Path;

use rawzip::ZipArchiveWriter;
use tempfile::NamedTempFile;

use super::error::ExportError;

/// Writes files, given with their paths in the archive, into an archive that appears when it is complete.
///
/// # Errors
/// If it cannot be written.
pub fn write_archive(path: &Path, files: &[(String, Vec<u8>)]) -> Result<(), ExportError> {
    let failed = |source| ExportError::Write { path: path.to_owned(), source };
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let file = NamedTempFile::new_in(folder).map_err(failed)?;
    let of_archive = |error| failed(io::Error::other(error));
    let mut archive = ZipArchiveWriter::new(file);
    for (name, bytes) in files {
        let (mut entry, config) = archive.new_file(name.as_str()).start().map_err(of_archive)?;
        let mut writer = config.wrap(&mut entry);
        writer.write_all(bytes).map_err(failed)?;
        let (_, written) = writer.finish().map_err(of_archive)?;
        entry.finish(written).map_err(of_archive)?;
    }
    let file = archive.finish().map_err(of_archive)?;
    super::samples::persist(file, path).map_err(failed)
}
