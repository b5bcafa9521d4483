//! Tables: a line for each point in, a line for each row of each point out.
//!
//! In: a heading with the names of the parameters, then their values; the end of the points is the end of the input.
//! Out: a heading with `sample`, `t` and the outputs, in any order and with any further columns; `sample` counts the
//! points of the call from 0. Tables of one time need no `t`. `mbint sample` reads and writes both.

use super::answers::Answers;
use super::trouble::Trouble;
use super::{Answer, Questions};

/// The table of a call's points.
pub(super) fn table(questions: &Questions, points: &[&[f64]]) -> String {
    let mut text = questions.parameters.join(",") + "\n";
    for point in points {
        let values: Vec<String> = point.iter().map(|value| format!("{value:?}")).collect();
        text += &(values.join(",") + "\n");
    }
    text
}

/// The program's table so far.
#[derive(Debug)]
pub(super) struct Table {
    columns: Option<Columns>,
    /// Rows of each point.
    rows: Vec<Vec<f64>>,
}

/// Indices of the columns that count.
#[derive(Debug)]
struct Columns {
    sample: usize,
    time: Option<usize>,
    outputs: Vec<usize>,
}

impl Table {
    /// An empty table for `points` points.
    pub fn of(points: usize) -> Self {
        Self { columns: None, rows: vec![Vec::new(); points] }
    }

    /// Takes a line.
    ///
    /// # Errors
    /// If the heading lacks a column, or a line belongs to no point that is waiting.
    pub fn take(&mut self, questions: &Questions, line: &str, answers: &mut Answers) -> Result<(), Trouble> {
        if line.trim().is_empty() || line.starts_with('#') {
            return Ok(());
        }
        let fields: Vec<&str> = line.split(',').map(|field| field.trim().trim_matches('"')).collect();
        let Some(columns) = &self.columns else {
            self.columns = Some(Columns::of(questions, &fields)?);
            return Ok(());
        };
        let unreadable = |why: &str| Trouble::Unreadable { line: line.to_owned(), why: why.to_owned() };
        let number = |column: usize| fields.get(column).and_then(|field| field.parse::<f64>().ok());
        let point = fields.get(columns.sample).and_then(|field| field.parse::<usize>().ok());
        let point = point.ok_or_else(|| unreadable("its `sample` is no whole number"))?;
        let width = questions.outputs.len();
        let Some(rows) = self.rows.get_mut(point) else { return Err(unreadable("this sample was not asked for")) };
        let row = rows.len() / width;
        if row == questions.times.len() {
            let (found, wanted) = (row + 1, row);
            answers.set(point, Err(Trouble::Rows { name: "rows".to_owned(), found, wanted }));
            return Err(unreadable("this sample has all of its rows"));
        }
        let time = columns.time.map(|column| number(column).unwrap_or(f64::NAN));
        let values = columns.outputs.iter().enumerate();
        let values: Answer = match time.map_or(Ok(()), |time| questions.check_time(row, time)) {
            Ok(()) => values.map(|(output, &column)| questions.value(row, output, number(column))).collect(),
            Err(other) => Err(other),
        };
        match values {
            Ok(values) => rows.extend(values),
            Err(why) => {
                answers.set(point, Err(why));
                // Later rows are of no use.
                rows.resize(row * width + width, f64::NAN);
            }
        }
        if rows.len() == questions.times.len() * width {
            answers.set(point, Ok(rows.clone()));
        }
        Ok(())
    }

    /// Ends the table: points that lack rows get an error with the number of their rows.
    pub fn end(&self, questions: &Questions, answers: &mut Answers) {
        let wanted = questions.times.len();
        for (point, rows) in self.rows.iter().enumerate().filter(|(_, rows)| !rows.is_empty()) {
            let found = rows.len() / questions.outputs.len();
            answers.set(point, Err(Trouble::Rows { name: "rows".to_owned(), found, wanted }));
        }
    }
}

impl Columns {
    fn of(questions: &Questions, heading: &[&str]) -> Result<Self, Trouble> {
        let find = |name: &str| heading.iter().position(|field| *field == name);
        let found = || heading.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let needed = |name: &str| find(name).ok_or_else(|| Trouble::NoOutput { name: name.to_owned(), found: found() });
        let time = if questions.times.len() == 1 { find("t") } else { Some(needed("t")?) };
        let outputs = questions.outputs.iter().map(|(name, _)| needed(name)).collect::<Result<_, _>>()?;
        Ok(Self { sample: needed("sample")?, time, outputs })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn questions() -> Questions {
        Questions { parameters: vec!["l".to_owned()], outputs: vec![("x".to_owned(), 1.0)], times: vec![0.0, 0.5] }
    }

    #[test]
    fn tables_are_written_and_read_per_sample() {
        assert_eq!(table(&questions(), &[&[0.1], &[1e-9]]), "l\n0.1\n1e-9\n");
        let (mut table, mut answers) = (Table::of(3), Answers::of(3));
        let lines = ["sample,l,t,x", "1,9,0,1.5", "0,9,0,1", "1,9,0.5,2.5", "0,9,0.4,2", "2,9,0,3"];
        lines.iter().for_each(|line| table.take(&questions(), line, &mut answers).unwrap());
        table.end(&questions(), &mut answers);
        let mut found = answers.finish(None).into_iter().map(|found| found.unwrap());
        assert_eq!(found.next().unwrap(), Err(Trouble::Time { row: 1, found: 0.4, wanted: 0.5 }));
        assert_eq!(found.next().unwrap(), Ok(vec![1.5, 2.5]));
        assert_eq!(found.next().unwrap(), Err(Trouble::Rows { name: "rows".to_owned(), found: 1, wanted: 2 }));
    }

    #[test]
    fn headings_need_their_columns() {
        let mut answers = Answers::of(1);
        let error = Table::of(1).take(&questions(), "sample,t,y", &mut answers).unwrap_err();
        assert_eq!(error.to_string(), "the answer has no output `x`; it has `sample`, `t`, `y`");
    }
}
