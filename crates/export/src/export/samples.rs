//! Samples → one file: an archive of NumPy's arrays (`.npz`), or a table. They are written as they come.

use std::io::{self, BufWriter, Seek, Write};
use std::path::Path;

use rawzip::ZipArchiveWriter;
use tempfile::NamedTempFile;

use super::csv::number;
use super::error::ExportError;
use super::tuning::TUNING;
use crate::results::{SampleFormat, SampleTable};

/// Takes values (sample, row, output) of consecutive samples.
pub type Keep<'k> = dyn FnMut(&[f64]) -> Result<(), ExportError> + 'k;

/// Writes all samples; the file appears when it is complete, and `-` is standard output. `fill` passes the values, and
/// returns whether these were all.
///
/// # Errors
/// If the file cannot be written, and those of `fill`.
pub fn write_samples<E: From<ExportError>>(
    path: &Path,
    format: SampleFormat,
    table: &SampleTable,
    fill: impl FnOnce(&mut Keep) -> Result<bool, E>,
) -> Result<bool, E> {
    let failed = |source| ExportError::Write { path: path.to_owned(), source };
    let is_standard_output = path == Path::new("-");
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    let builder = builder.prefix(".samples-");
    let file = if is_standard_output { builder.tempfile() } else { builder.tempfile_in(folder) };
    let file = file.map_err(failed)?;
    let file = BufWriter::with_capacity(1 << 18, file);
    let done = match format {
        SampleFormat::Npz => npz(file, table, fill, failed)?,
        SampleFormat::Csv => csv(file, table, fill, failed)?,
    };
    let Some(file) = done else { return Ok(false) };
    let file = file.into_inner().map_err(|error| failed(error.into_error()))?;
    let written = if is_standard_output { copy_out(file) } else { persist(file, path) };
    written.map_err(failed)?;
    Ok(true)
}

/// Writes the file to standard output.
fn copy_out(mut file: NamedTempFile) -> io::Result<()> {
    file.as_file_mut().rewind()?;
    let mut out = io::stdout().lock();
    io::copy(file.as_file_mut(), &mut out)?;
    out.flush()
}

/// Gives the file its name, and lets others read it.
pub(super) fn persist(file: NamedTempFile, path: &Path) -> io::Result<()> {
    file.as_file().sync_all()?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    file.persist(path).map(drop).map_err(|error| error.error)
}

/// Arrays `times` (row), `values` (sample, row, output), `parameters` (sample, parameter), names and units.
fn npz<E: From<ExportError>>(
    file: BufWriter<NamedTempFile>,
    table: &SampleTable,
    fill: impl FnOnce(&mut Keep) -> Result<bool, E>,
    failed: impl Fn(io::Error) -> ExportError + Copy,
) -> Result<Option<BufWriter<NamedTempFile>>, E> {
    let mut archive = ZipArchiveWriter::new(file);
    let (rows, outputs, parameters) = (table.times.len(), table.outputs.len(), table.parameters.len());
    let whole = array(&mut archive, "values", "<f8", &[table.count, rows, outputs], failed, |into| {
        fill(&mut |values: &[f64]| floats(into, values.iter().copied()).map_err(failed))
    })?;
    if !whole {
        return Ok(None);
    }
    array(&mut archive, "parameters", "<f8", &[table.count, parameters], failed, |into| {
        for first in (0..table.count).step_by(TUNING.samples_at_once) {
            let points = (table.points)(first..(first + TUNING.samples_at_once).min(table.count));
            floats(into, points.iter().flatten().copied()).map_err(failed)?;
        }
        Ok::<(), E>(())
    })?;
    array(&mut archive, "times", "<f8", &[rows], failed, |into| {
        floats(into, table.times.iter().copied()).map_err(failed).map_err(E::from)
    })?;
    for (what, named) in [("output", &table.outputs), ("parameter", &table.parameters)] {
        for (kind, texts) in [
            ("names", named.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>()),
            ("units", named.iter().map(|(_, unit)| unit.as_str()).collect()),
        ] {
            let longest = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
            let kind = format!("{what}_{kind}");
            array(&mut archive, &kind, &format!("<U{longest}"), &[texts.len()], failed, |into| {
                for text in texts {
                    let letters = text.chars().map(u32::from).chain(std::iter::repeat(0)).take(longest);
                    let bytes: Vec<u8> = letters.flat_map(u32::to_le_bytes).collect();
                    into.write_all(&bytes).map_err(failed)?;
                }
                Ok::<(), E>(())
            })?;
        }
    }
    Ok(Some(archive.finish().map_err(|error| failed(io::Error::other(error)))?))
}

/// Writes an array of the archive: a header of NumPy's format 1.0, then the output of `fill`.
fn array<T, E: From<ExportError>>(
    archive: &mut ZipArchiveWriter<BufWriter<NamedTempFile>>,
    name: &str,
    kind: &str,
    shape: &[usize],
    failed: impl Fn(io::Error) -> ExportError,
    fill: impl FnOnce(&mut dyn Write) -> Result<T, E>,
) -> Result<T, E> {
    let of_archive = |error| failed(io::Error::other(error));
    let (mut entry, config) = archive.new_file(format!("{name}.npy").as_str()).start().map_err(of_archive)?;
    let mut writer = config.wrap(&mut entry);
    writer.write_all(&header(kind, shape)).map_err(&failed)?;
    let filled = fill(&mut writer)?;
    let (_, written) = writer.finish().map_err(of_archive)?;
    entry.finish(written).map_err(of_archive)?;
    Ok(filled)
}

/// Header of an array, a multiple of 64 bytes.
fn header(kind: &str, shape: &[usize]) -> Vec<u8> {
    let shape: String = shape.iter().map(|length| format!("{length}, ")).collect();
    let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}", shape.trim_end());
    let length = (10 + text.len() + 1).next_multiple_of(64) - 10;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(format!("{text:<width$}\n", width = length - 1).into_bytes());
    bytes
}

fn floats(into: &mut dyn Write, values: impl Iterator<Item = f64>) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(1 << 16);
    for value in values {
        bytes.extend(value.to_le_bytes());
        if bytes.len() >= 1 << 16 {
            into.write_all(&bytes)?;
            bytes.clear();
        }
    }
    into.write_all(&bytes)
}

/// Columns: index of the sample, its parameters, time, outputs; a row for each time of each sample.
fn csv<E: From<ExportError>>(
    file: BufWriter<NamedTempFile>,
    table: &SampleTable,
    fill: impl FnOnce(&mut Keep) -> Result<bool, E>,
    failed: impl Fn(io::Error) -> ExportError + Copy,
) -> Result<Option<BufWriter<NamedTempFile>>, E> {
    let mut writer = csv::WriterBuilder::new().from_writer(file);
    let names = |named: &[(String, String)]| named.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let headings = [vec!["sample".to_owned()], names(&table.parameters), vec!["t".to_owned()], names(&table.outputs)];
    writer.write_record(headings.concat()).map_err(ExportError::from)?;
    let mut sample = 0;
    let of_sample = (table.times.len() * table.outputs.len()).max(1);
    let whole = fill(&mut |values: &[f64]| {
        let count = values.len() / of_sample;
        let points = (table.points)(sample..sample + count);
        for (point, values) in points.iter().zip(values.chunks_exact(of_sample)) {
            let parameters: Vec<String> = point.iter().copied().map(number).collect();
            for (&time, values) in table.times.iter().zip(values.chunks_exact(table.outputs.len())) {
                let head = std::iter::once(sample.to_string()).chain(parameters.iter().cloned());
                let values = std::iter::once(time).chain(values.iter().copied()).map(number);
                writer.write_record(head.chain(values))?;
            }
            sample += 1;
        }
        Ok(())
    })?;
    if !whole {
        return Ok(None);
    }
    let file = writer.into_inner().map_err(|error| failed(error.into_error()))?;
    Ok(Some(file))
}

#[cfg(test)]
mod tests {
    use super::header;

    #[test]
    fn headers_match_numpy() {
        // numpy.lib.format.write_array_header_1_0 of (3,) and of (2, 5, 4).
        let text = |shape: &[usize]| String::from_utf8_lossy(&header("<f8", shape)[10..]).trim_end().to_owned();
        assert_eq!(text(&[3]), "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }");
        assert_eq!(text(&[2, 5, 4]), "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 5, 4,), }");
        assert_eq!(header("<U3", &[1_000_000_000_000, 1_000_000, 1000]).len() % 64, 0);
    }
}
