//! `mbint new`: a model as a starting point.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;

use super::args::NewArgs;
use super::console::Console;
use super::{Failure, Status};

/// A model that runs, with its name to be replaced.
const TEMPLATE: &str = include_str!("../../models/template.yaml");
/// Location of the schema for the project's own models; a new model has it in its own folder.
const SCHEMA: &str = "../schemas/mbint.schema.json";
/// Its name line.
const NAME_LINE: &str = "model: template\n";

pub(super) fn new(args: &NewArgs, console: &mut Console) -> Result<Status, Failure> {
    let wrong = |message: String| Err(Failure::wrong(message));
    let given = args.name.to_string_lossy();
    let stem = given.strip_suffix(".yaml").or_else(|| given.strip_suffix(".yml")).unwrap_or(&given);
    let name = stem.rsplit(std::path::is_separator).next().unwrap_or(stem);
    if !is_name(name) {
        let rule = "expected a letter, then letters, digits, `_` or `-`, such as `slider_crank`";
        return wrong(format!("`{name}` cannot name a model: {rule}"));
    }
    let path = format!("{stem}.yaml");
    let text = TEMPLATE.replacen(NAME_LINE, &format!("model: {name}\n"), 1).replacen(SCHEMA, "mbint.schema.json", 1);
    if let Some(folder) = Path::new(&path).parent()
        && let Err(error) = std::fs::create_dir_all(folder)
    {
        return wrong(format!("cannot make the folder {}: {error}", folder.display()));
    }
    let created = OpenOptions::new().write(true).create_new(true).open(&path);
    match created.and_then(|mut file| file.write_all(text.as_bytes())) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            return wrong(format!("{path} exists; it was left as it is"));
        }
        Err(error) => {
            // A partial file would prevent the next attempt.
            let _ = std::fs::remove_file(&path);
            return wrong(format!("cannot write {path}: {error}"));
        }
    }
    let editor = "for completion in an editor, next to the model: mbint schema > mbint.schema.json";
    console.print(&format!("{path}\nnext: mbint run {path}\n{editor}\n"))?;
    Ok(Status::Done)
}

/// Whether a model can have this name.
fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_has_its_name_once() {
        assert_eq!(TEMPLATE.matches(NAME_LINE).count(), 1);
        assert_eq!(TEMPLATE.matches(SCHEMA).count(), 1);
    }

    #[test]
    fn names() {
        assert!(["a", "slider_crank", "arm-2", "A1"].into_iter().all(is_name));
        assert!(["", "2d", "a b", "ä", "-a", "a.b"].into_iter().all(|name| !is_name(name)));
    }
}
