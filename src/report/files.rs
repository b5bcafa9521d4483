//! Results on disk, each file whole or not there.

use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::bounds::Bounds;
use crate::report::{Summary, bounds_csv, contributions_csv, contributions_svg, plot_svg};

/// Why results could not be written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum ReportError {
    #[error("cannot write into the folder {}: {source}", path.display())]
    Folder { path: PathBuf, source: io::Error },
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot write the table of bounds: {0}")]
    Csv(#[from] csv::Error),
    #[error("cannot write the summary: {0}")]
    Json(#[from] serde_json::Error),
    #[error("cannot plot `{output}`: {message}")]
    Plot { output: String, message: String },
}

/// Writes `bounds.csv`, an SVG for each output, who has which part in it where that is known, and `summary.json` into `dir`, which is made if it is not there.
///
/// Every file is written under a temporary name beside its place and renamed, so that neither a failure nor a killed run
/// leaves half a file, or half a new file in place of an old one. `summary.json` comes last: where it is, the others
/// are. Returns the files written, in that order.
///
/// # Errors
/// At the first file that cannot be written; those before it are kept.
pub fn write_results(dir: &Path, bounds: &Bounds, summary: &Summary) -> Result<Vec<PathBuf>, ReportError> {
    prepare_folder(dir)?;
    let mut written = Vec::new();
    let mut write = |name: &str, contents: &[u8]| {
        let path = dir.join(name);
        match write_whole(&path, contents) {
            Ok(()) => written.push(path),
            Err(source) => return Err(ReportError::Write { path, source }),
        }
        Ok(())
    };

    write("bounds.csv", &bounds_csv(bounds)?)?;
    if !bounds.contributions.is_empty() {
        write("contributions.csv", &contributions_csv(bounds)?)?;
    }
    let names = unique_stems(bounds.outputs.iter().map(|output| output.name.as_str()));
    let contributions = bounds.contributions.iter().map(Some).chain(std::iter::repeat(None));
    for ((output, name), contributions) in bounds.outputs.iter().zip(names).zip(contributions) {
        let svg = plot_svg(&bounds.times, output)
            .map_err(|message| ReportError::Plot { output: output.name.clone(), message })?;
        write(&format!("{name}.svg"), svg.as_bytes())?;
        if let Some(contributions) = contributions {
            let svg = contributions_svg(&bounds.times, &output.name, contributions)
                .map_err(|message| ReportError::Plot { output: output.name.clone(), message })?;
            write(&format!("{name}.contributions.svg"), svg.as_bytes())?;
        }
    }
    let mut json = serde_json::to_vec_pretty(summary)?;
    json.push(b'\n');
    write("summary.json", &json)?;
    Ok(written)
}

/// Makes `dir` if it is not there, and tries whether a file can be made in it: better known before a long run than after.
///
/// # Errors
/// If it cannot.
pub fn prepare_folder(dir: &Path) -> Result<(), ReportError> {
    let folder = |source| ReportError::Folder { path: dir.to_owned(), source };
    if dir.exists() && !dir.is_dir() {
        // The system would say "File exists".
        return Err(folder(io::ErrorKind::NotADirectory.into()));
    }
    fs::create_dir_all(dir).map_err(folder)?;
    tempfile::Builder::new().prefix(".mbint-").suffix(".tmp").tempfile_in(dir).map_err(|e| folder(plain(e)))?;
    Ok(())
}

/// Writes a file under a temporary name in the same folder, then renames it into place.
pub(super) fn write_whole(path: &Path, contents: &[u8]) -> io::Result<()> {
    let dir = path.parent().filter(|dir| !dir.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".mbint-").suffix(".tmp");
    // Temporary files are private; results are to be as readable as the user's other files (less the umask).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(dir).map_err(plain)?;
    file.write_all(contents).map_err(plain)?;
    file.persist(path).map_err(|e| plain(e.error))?;
    Ok(())
}

/// tempfile adds the temporary path to its errors, which tells the user nothing: leave the system's own words.
fn plain(error: io::Error) -> io::Error {
    let system = std::error::Error::source(&error).and_then(|e| e.downcast_ref::<io::Error>());
    match error.raw_os_error().or_else(|| system.and_then(io::Error::raw_os_error)) {
        Some(code) => io::Error::from_raw_os_error(code),
        None => error,
    }
}

/// `name` as a file name without extension that every system takes: letters, digits, `_`, `-` and `.` stay, the rest
/// becomes `_`.
pub fn file_stem(name: &str) -> String {
    /// Names of devices on Windows, whatever their extension.
    const RESERVED: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];
    /// Bytes; file systems take 255, with the extension and a number.
    const LONGEST: usize = 120;

    let keep = |c: char| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    let mut stem: String = name.chars().map(keep).collect();
    while stem.len() > LONGEST {
        stem.pop();
    }
    // No hidden files, no `..`, and no trailing dot, which Windows drops.
    let trimmed = stem.trim_end_matches('.').len();
    stem.truncate(trimmed);
    let device = stem.split('.').next().unwrap_or("").trim_end_matches(|c: char| c.is_ascii_digit());
    if stem.is_empty() || stem.starts_with('.') || RESERVED.iter().any(|name| device.eq_ignore_ascii_case(name)) {
        stem.insert(0, '_');
    }
    stem
}

/// [`file_stem`]s, made unique (also where upper and lower case are one) by `-2`, `-3`, … on the later ones.
fn unique_stems<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut unique = |name: &str| {
        let stem = file_stem(name);
        let mut candidate = stem.clone();
        let mut number = 1;
        while !taken.insert(candidate.to_lowercase()) {
            number += 1;
            candidate = format!("{stem}-{number}");
        }
        candidate
    };
    names.map(&mut unique).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::OutputBounds;

    fn results() -> (Bounds, Summary) {
        let output =
            |name: &str| OutputBounds { name: name.into(), unit: "m".into(), nominal: vec![1.0, 2.0], bands: vec![] };
        let bounds = Bounds {
            times: vec![0.0, 1.0],
            outputs: vec![output("x3"), output("a/b"), output("A b")],
            ..Bounds::default()
        };
        let summary = Summary {
            model: "crank".into(),
            mbint: "0.1.0".into(),
            coordinates: 7,
            constraints: 6,
            degrees_of_freedom: 1,
            redundant_constraints: vec![],
            alpha: -0.1,
            duration: 1.0,
            parameters: vec![],
            methods: vec![],
            errors: vec![],
            contributions: vec![],
            failure: None,
        };
        (bounds, summary)
    }

    fn names(dir: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn results_are_written_over_older_ones_and_nothing_else_is_left() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("results/crank");
        let (bounds, summary) = results();
        for _ in 0..2 {
            let written = write_results(&place, &bounds, &summary).unwrap();
            let written: Vec<_> = written.iter().map(|path| path.strip_prefix(&place).unwrap()).collect();
            assert_eq!(written, ["bounds.csv", "x3.svg", "a_b.svg", "A_b-2.svg", "summary.json"].map(Path::new));
        }
        assert_eq!(names(&place), ["A_b-2.svg", "a_b.svg", "bounds.csv", "summary.json", "x3.svg"]);
        let json = fs::read_to_string(place.join("summary.json")).unwrap();
        assert!(json.ends_with("}\n") && json.contains("\"model\": \"crank\""), "{json}");
    }

    #[cfg(unix)]
    #[test]
    fn results_are_as_readable_as_other_files() {
        use std::os::unix::fs::MetadataExt;
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("plain"), "").unwrap();
        write_whole(&dir.path().join("ours"), b"").unwrap();
        let mode = |name| fs::metadata(dir.path().join(name)).unwrap().mode();
        assert_eq!(mode("ours"), mode("plain"));
    }

    #[test]
    fn a_file_in_the_way_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("taken");
        fs::write(&place, "mine").unwrap();
        let (bounds, summary) = results();
        let error = write_results(&place, &bounds, &summary).unwrap_err();
        assert!(matches!(&error, ReportError::Folder { path, .. } if *path == place), "{error}");
        assert!(
            error.to_string().starts_with(&format!("cannot write into the folder {}: ", place.display())),
            "{error}"
        );
        assert_eq!(fs::read_to_string(&place).unwrap(), "mine");
    }

    #[test]
    fn a_file_that_cannot_be_replaced_is_named_and_nothing_half_is_left() {
        let dir = tempfile::tempdir().unwrap();
        // A folder stands where a file should.
        fs::create_dir(dir.path().join("x3.svg")).unwrap();
        let (bounds, summary) = results();
        let error = write_results(dir.path(), &bounds, &summary).unwrap_err();
        let path = dir.path().join("x3.svg");
        assert!(error.to_string().starts_with(&format!("cannot write {}: ", path.display())), "{error}");
        assert!(!error.to_string().contains(".mbint-"), "{error}");
        assert_eq!(names(dir.path()), ["bounds.csv", "x3.svg"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_read_only_folder_is_named() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let (bounds, summary) = results();
        fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o555)).unwrap();
        // The superuser may write anywhere: nothing to see then.
        if fs::write(dir.path().join("probe"), "").is_err() {
            let error = write_results(dir.path(), &bounds, &summary).unwrap_err();
            let path = dir.path().display().to_string();
            assert!(error.to_string().starts_with(&format!("cannot write into the folder {path}: Perm")), "{error}");
        }
        fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[test]
    fn names_become_safe_and_unique_file_names() {
        for (name, stem) in [
            ("x3", "x3"),
            ("crank.angle", "crank.angle"),
            ("../../etc/passwd", "_.._.._etc_passwd"),
            ("..", "_"),
            ("", "_"),
            (".hidden", "_.hidden"),
            ("a b\n<c>:\"d\"|?*\\", "a_b__c___d_____"),
            ("NUL", "_NUL"),
            ("com1.x", "_com1.x"),
            ("command", "command"),
            ("θ₁", "θ₁"),
        ] {
            assert_eq!(file_stem(name), stem, "{name:?}");
        }
        assert!(file_stem(&"ä".repeat(500)).len() <= 121);
        let unique = unique_stems(["a b", "a/b", "A_B", "a_b-2", "c"].into_iter());
        assert_eq!(unique, ["a_b", "a_b-2", "A_B-3", "a_b-2-2", "c"]);
    }
}
