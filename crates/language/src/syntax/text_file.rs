//! The text of a file, or why it cannot be read.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use super::codes::Code;
use super::diagnostic::Diagnostic;
use super::suggest::clip;

/// Reads the text of a file that a model names, of at most `most` bytes. Refuses pipes and devices, which may have no
/// end.
pub fn read_text(path: &Path, most: u64) -> Result<String, Box<Diagnostic>> {
    let metadata = fs::metadata(path).map_err(cannot)?;
    if !metadata.is_file() && !metadata.is_dir() {
        return Err(Box::new(Diagnostic::of_file(Code::UnreadableFile, "this is a pipe or a device, not a file")));
    }
    read_given(path, most)
}

/// The same for a file that the user names, which may be a pipe.
pub fn read_given(path: &Path, most: u64) -> Result<String, Box<Diagnostic>> {
    let metadata = fs::metadata(path).map_err(cannot)?;
    if metadata.is_dir() {
        return Err(Box::new(Diagnostic::of_file(Code::UnreadableFile, "this is a directory, not a file")));
    }
    if metadata.len() > most {
        return Err(too_large(metadata.len(), most));
    }
    text_of(fs::File::open(path).map_err(cannot)?, most)
}

/// Reads a regular file of at most `most` bytes: a pipe or a device may have no end.
pub fn regular(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no regular file"));
    }
    let mut bytes = Vec::new();
    fs::File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("it has more than {} MB", most / 1_000_000)));
    }
    Ok(bytes)
}

/// Reads the text of a source, of at most `most` bytes.
pub fn text_of(source: impl Read, most: u64) -> Result<String, Box<Diagnostic>> {
    // A file that is not regular (a pipe) has no length: never read more than allowed.
    let mut bytes = Vec::new();
    source.take(most + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > most {
        return Err(too_large(bytes.len() as u64, most));
    }
    String::from_utf8(bytes).map_err(|error| {
        let (valid, _) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
        let before = String::from_utf8_lossy(valid);
        let line = before.matches('\n').count() + 1;
        let last = before.rsplit('\n').next().unwrap_or("");
        let (column, shown) = (last.chars().count() + 1, clip(last.trim_start()));
        let behind = if shown.is_empty() { String::new() } else { format!(", behind `{shown}`") };
        let message = format!("the file is not UTF-8 text: line {line}, column {column}{behind}");
        let help = match error.as_bytes() {
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "this is UTF-16: save the file as UTF-8",
            _ => "a model file is text in UTF-8: save it as that",
        };
        Box::new(Diagnostic::of_file(Code::NotText, message).help(help.to_owned()))
    })
}

fn cannot(error: io::Error) -> Box<Diagnostic> {
    let reason = match error.kind() {
        // A web page has no files except its texts.
        io::ErrorKind::NotFound | io::ErrorKind::Unsupported => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "permission is denied".to_owned(),
        _ => error.to_string(),
    };
    Box::new(Diagnostic::of_file(Code::UnreadableFile, format!("the file cannot be read: {reason}")))
}

fn too_large(length: u64, most: u64) -> Box<Diagnostic> {
    let (megabytes, limit) = (length as f64 / 1e6, most / 1_000_000);
    Box::new(Diagnostic::of_file(
        Code::TooLarge,
        format!("the file has {megabytes:.1} MB; a model may have {limit} MB"),
    ))
}
