//! JSON lines: a point on a line in, its rows on a line out.
//!
//! In: `{"point": 7, "left": 2, "parameters": {"l": 0.15}, "times": [0, 0.01]}`, where `left` points of the same call
//! follow. Out, in any order: `{"point": 7, "outputs": {"x": [0, 0.1]}}` or `{"point": 7, "error": "…"}`. Lines that do
//! not begin with `{` are output of libraries, not answers.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Deserialize;

use super::answers::Answers;
use super::trouble::Trouble;
use super::{Answer, Questions};

/// A line of the program.
#[derive(Deserialize)]
struct Line {
    point: u64,
    #[serde(default)]
    outputs: BTreeMap<String, Column>,
    #[serde(default)]
    times: Option<Vec<Option<f64>>>,
    #[serde(default)]
    error: Option<String>,
}

/// Values of an output: of the only time, or row by row; null is no number.
#[derive(Deserialize)]
#[serde(untagged, expecting = "an output is a number, or a list of numbers and nulls")]
enum Column {
    Rows(Vec<Option<f64>>),
    One(Option<f64>),
}

impl Column {
    fn rows(&self) -> &[Option<f64>] {
        match self {
            Self::Rows(rows) => rows,
            Self::One(value) => std::slice::from_ref(value),
        }
    }
}

/// The lines of a call whose first point has the number `first`.
pub(super) fn lines(questions: &Questions, first: u64, points: &[&[f64]]) -> String {
    let times = list(&questions.times);
    let mut text = String::new();
    for (index, point) in points.iter().enumerate() {
        let (number, left) = (first + index as u64, points.len() - 1 - index);
        let parameters: Vec<String> = questions
            .parameters
            .iter()
            .zip(*point)
            .map(|(name, value)| format!("{}:{value:?}", quoted(name)))
            .collect();
        let parameters = parameters.join(",");
        // Writing to a string does not fail.
        let _ = writeln!(text, r#"{{"point":{number},"left":{left},"parameters":{{{parameters}}},"times":{times}}}"#);
    }
    text
}

fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    format!("[{}]", values.join(","))
}

fn quoted(name: &str) -> String {
    serde_json::Value::from(name).to_string()
}

/// Takes a line of a call whose first point has the number `first`.
///
/// # Errors
/// If it is of no point that waits, or cannot be read.
pub(super) fn take(questions: &Questions, first: u64, line: &str, answers: &mut Answers) -> Result<(), Trouble> {
    if !line.trim_start().starts_with('{') {
        return Ok(());
    }
    let unreadable = |why: String| Trouble::Unreadable { line: line.to_owned(), why };
    // Python writes numbers that are none as words.
    let read = serde_json::from_str(line).or_else(|error| match without_words(line) {
        Some(line) => serde_json::from_str(&line),
        None => Err(error),
    });
    let read: Line = read.map_err(|error| unreadable(error.to_string()))?;
    let place = read.point.checked_sub(first).and_then(|place| usize::try_from(place).ok());
    let Some(place) = place.filter(|&place| answers.waits(place)) else {
        return Err(unreadable(format!("point {} does not wait for an answer", read.point)));
    };
    answers.set(place, rows(questions, &read));
    Ok(())
}

/// The same line where words stand for numbers that are none.
fn without_words(line: &str) -> Option<String> {
    let has_words = ["NaN", "Infinity"].iter().any(|word| line.contains(word));
    has_words.then(|| line.replace("-Infinity", "null").replace("Infinity", "null").replace("NaN", "null"))
}

fn rows(questions: &Questions, line: &Line) -> Answer {
    if let Some(text) = &line.error {
        return Err(Trouble::Said { text: text.clone() });
    }
    let count = questions.times.len();
    if let Some(times) = &line.times {
        check_count("`times`", times.len(), count)?;
        times.iter().enumerate().try_for_each(|(row, time)| questions.check_time(row, time.unwrap_or(f64::NAN)))?;
    }
    let width = questions.outputs.len();
    let mut values = vec![0.0; count * width];
    for (output, (name, _)) in questions.outputs.iter().enumerate() {
        let Some(column) = line.outputs.get(name) else {
            let names: Vec<String> = line.outputs.keys().map(|name| format!("`{name}`")).collect();
            let found = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(Trouble::NoOutput { name: name.clone(), found });
        };
        check_count(&format!("`{name}`"), column.rows().len(), count)?;
        for (row, &value) in column.rows().iter().enumerate() {
            values[row * width + output] = questions.value(row, output, value)?;
        }
    }
    Ok(values)
}

fn check_count(name: &str, found: usize, wanted: usize) -> Result<(), Trouble> {
    if found == wanted { Ok(()) } else { Err(Trouble::Rows { name: format!("rows of {name}"), found, wanted }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn questions() -> Questions {
        let outputs = vec![("x".to_owned(), 1e-3), ("n".to_owned(), 1.0)];
        Questions { parameters: vec!["l".to_owned(), "m".to_owned()], outputs, times: vec![0.0, 0.5] }
    }

    #[test]
    fn points_and_answers_are_one_per_line() {
        let text = lines(&questions(), 7, &[&[0.1, 2.0], &[0.2, 1e-9]]);
        let expected = "{\"point\":7,\"left\":1,\"parameters\":{\"l\":0.1,\"m\":2.0},\"times\":[0.0,0.5]}\n\
                        {\"point\":8,\"left\":0,\"parameters\":{\"l\":0.2,\"m\":1e-9},\"times\":[0.0,0.5]}\n";
        assert_eq!(text, expected);
        let mut answers = Answers::of(2);
        let mut take = |line: &str| take(&questions(), 7, line, &mut answers);
        take("some library says hello").unwrap();
        take(r#"{"point": 8, "outputs": {"x": [1, 2], "n": [3, 4], "more": [0]}, "times": [0, 0.5]}"#).unwrap();
        assert!(take(r#"{"point": 8, "outputs": {}}"#).is_err(), "it has been answered");
        assert!(take(r#"{"point": 9, "outputs": {}}"#).is_err(), "it was not asked");
        take(r#"{"point": 7, "error": "diverged"}"#).unwrap();
        assert!(answers.is_complete());
        let found = answers.finish(None);
        assert_eq!(found[0], Ok(Err(Trouble::Said { text: "diverged".to_owned() })));
        assert_eq!(found[1], Ok(Ok(vec![1e-3, 3.0, 2e-3, 4.0])));
    }

    #[test]
    fn invalid_answers_give_reasons() {
        let why = |line: &str| {
            let mut answers = Answers::of(1);
            take(&questions(), 0, line, &mut answers).unwrap();
            answers.finish(None).remove(0).unwrap().unwrap_err().to_string()
        };
        for (line, expected) in [
            (r#"{"point":0,"outputs":{"x":[1,NaN],"n":[1,1]}}"#, "`x` is not a finite number at t = 0.5 s"),
            (r#"{"point":0,"outputs":{"x":[1,2],"n":[-Infinity,1]}}"#, "`n` is not a finite number at t = 0 s"),
            (r#"{"point":0,"outputs":{"x":[1,2]}}"#, "the answer has no output `n`; it has `x`"),
            (r#"{"point":0,"outputs":{"x":[1],"n":[1,1]}}"#, "the answer has 1 rows of `x` where 2 were asked for"),
            (
                r#"{"point":0,"times":[0,0.4],"outputs":{"x":[1,2],"n":[1,1]}}"#,
                "row 1 of the answer is at t = 0.4 s, but 0.5 s was asked for",
            ),
        ] {
            assert_eq!(why(line), expected);
        }
    }
}
