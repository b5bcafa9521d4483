//! Reads the output of [`snapshot_table`](super::snapshot_table).

/// A recorded snapshot: numbers with the digits in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    pub(super) outputs: Vec<Output>,
}

/// An output's table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Output {
    pub name: String,
    /// SI unit; empty if dimensionless.
    pub unit: String,
    pub curves: Vec<Curve>,
    /// Times with the digits in the file, s.
    pub times: Vec<String>,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// Empty for the nominal course.
    pub method: String,
    pub kind: ColumnKind,
    /// Value at each time.
    pub cells: Vec<String>,
}

/// Kind of a column of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColumnKind {
    Nominal,
    Lower,
    Upper,
    Error,
}

impl ColumnKind {
    /// The kind named by the end of a heading.
    pub fn of(name: &str) -> Option<Self> {
        [Self::Lower, Self::Upper, Self::Error].into_iter().find(|kind| kind.name() == name)
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Lower => "lower",
            Self::Upper => "upper",
            Self::Error => "error",
        }
    }
}

/// A file that is not a snapshot: the line, from 1, and its error.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct SnapshotError {
    line: usize,
    message: String,
}

impl Snapshot {
    /// Parses a text with or without the lines between hyphens at its head.
    ///
    /// # Errors
    /// At the first line that is not part of a table.
    pub fn read(text: &str) -> Result<Self, SnapshotError> {
        let mut lines = text.lines().enumerate().peekable();
        if lines.next_if(|(_, line)| *line == "---").is_some() {
            let end = lines.by_ref().find(|(_, line)| *line == "---");
            end.ok_or_else(|| error(0, "the head does not end with `---`"))?;
        }
        let mut outputs: Vec<Output> = Vec::new();
        while let Some((number, title)) = lines.next() {
            if title.trim().is_empty() {
                continue;
            }
            let (name, unit) = match title.strip_suffix(']').and_then(|title| title.rsplit_once(" [")) {
                Some((name, unit)) => (name, unit),
                None => (title, ""),
            };
            let headings = lines.next().map(|(_, line)| line).unwrap_or_default();
            let mut output = Output {
                name: name.to_owned(),
                unit: unit.to_owned(),
                curves: curves(headings).ok_or_else(|| error(number + 1, "no headings: `t nominal …`"))?,
                times: Vec::new(),
            };
            while let Some((number, line)) = lines.next_if(|(_, line)| !line.trim().is_empty()) {
                output.row(line).map_err(|message| error(number, &message))?;
            }
            outputs.push(output);
        }
        Ok(Self { outputs })
    }

    /// The number of curves: the nominal course and two bounds of each method of each output.
    pub fn curves(&self) -> usize {
        let curves = self.outputs.iter().flat_map(|output| &output.curves);
        curves.filter(|curve| curve.kind != ColumnKind::Error).count()
    }
}

impl Output {
    /// Adds a line of the table.
    fn row(&mut self, line: &str) -> Result<(), String> {
        let mut cells = line.split_whitespace();
        let time = cells.next().unwrap_or_default();
        let cells: Vec<&str> = cells.collect();
        if cells.len() != self.curves.len() {
            return Err(format!("{} numbers, but {} columns", cells.len() + 1, self.curves.len() + 1));
        }
        if let Some(wrong) = cells.iter().chain([&time]).find(|cell| cell.parse::<f64>().is_err()) {
            return Err(format!("`{wrong}` is no number"));
        }
        self.times.push(time.to_owned());
        self.curves.iter_mut().zip(cells).for_each(|(curve, cell)| curve.cells.push(cell.to_owned()));
        Ok(())
    }
}

/// The columns of a line of headings; `None` for any other line.
fn curves(headings: &str) -> Option<Vec<Curve>> {
    let mut headings = headings.split_whitespace();
    if (headings.next(), headings.next()) != (Some("t"), Some("nominal")) {
        return None;
    }
    let curve = |method: &str, kind| Curve { method: method.to_owned(), kind, cells: Vec::new() };
    let mut curves = vec![curve("", ColumnKind::Nominal)];
    for heading in headings {
        let (method, kind) = heading.rsplit_once('.')?;
        curves.push(curve(method, ColumnKind::of(kind)?));
    }
    Some(curves)
}

/// The error at a line that is counted from 0.
fn error(line: usize, message: &str) -> SnapshotError {
    SnapshotError { line: line + 1, message: message.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::super::table::tests::bounds;
    use super::super::{snapshot_file, snapshot_table};
    use super::*;

    #[test]
    fn written_snapshot_is_read_back() {
        let table = snapshot_table(&bounds(&[1.0, 2.0, f64::NAN], 0.5, 1e-3));
        let read = Snapshot::read(&table).unwrap();
        assert_eq!(read, Snapshot::read(&snapshot_file("models/x.yaml", &table)).unwrap());
        assert_eq!(read, Snapshot::read(&table.replace('\n', "\r\n")).unwrap(), "as some editors end lines");
        let output = &read.outputs[0];
        assert_eq!((output.name.as_str(), output.unit.as_str(), read.curves()), ("x", "m", 3));
        assert_eq!(output.times, ["0.0000", "0.1000", "0.2000"]);
        assert_eq!(output.curves[2].cells, ["1.2500", "2.2500", "NaN"]);
    }

    #[test]
    fn malformed_snapshot_is_reported_with_its_line() {
        let wrong = |text: &str| Snapshot::read(text).unwrap_err().to_string();
        assert_eq!(wrong("model: x\nbodies:\n"), "line 2: no headings: `t nominal …`");
        assert_eq!(wrong("---\nx\n"), "line 1: the head does not end with `---`");
        assert_eq!(wrong("x\n t nominal\n 0 1\n 1\n"), "line 4: 1 numbers, but 2 columns");
        assert_eq!(wrong("x\n t nominal\n<<<<<<< HEAD\n"), "line 3: `HEAD` is no number");
        assert_eq!(Snapshot::read("").unwrap(), Snapshot::default());
    }
}
