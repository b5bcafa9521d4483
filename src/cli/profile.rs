//! `mbint run --profile FILE`: the duration of each stage, by model and subsystem, as a table and as a trace (decision
//! 0158).

use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::json;

use super::Failure;
use crate::overview::{Align, Table};

/// A stage of a model's run, or of the command.
struct Span {
    /// Name of the model and its scene; empty for the command itself.
    model: String,
    /// Index of the subsystem; `None` for the whole model.
    subsystem: Option<usize>,
    stage: String,
    /// Start, relative to that of the profile.
    begun: Duration,
    ended: Option<Duration>,
}

/// Consecutive spans: each begins where the one before ends. The stages of a run follow one another; the work within a
/// stage is spread over threads.
pub(super) struct Profile {
    file: PathBuf,
    begun: Instant,
    spans: Mutex<Vec<Span>>,
}

impl Profile {
    /// Begins with the reading of models; the trace goes to `file`, which is created at once.
    ///
    /// # Errors
    /// If the file cannot be created: better now than after hours.
    pub fn new(file: PathBuf) -> Result<Self, Failure> {
        fs::File::create(&file).map_err(|error| Failure::wrong(format!("{}: {error}", file.display())))?;
        let profile = Self { file, begun: Instant::now(), spans: Mutex::default() };
        profile.begin(String::new(), None, "reading and checking models");
        Ok(profile)
    }

    /// Begins a model's run.
    pub fn model(&self, name: &str) {
        self.begin(name.to_owned(), None, "beginning");
    }

    /// Begins a subsystem, or a part common to all of them.
    pub fn subsystem(&self, subsystem: Option<usize>) {
        let (model, _) = self.current();
        self.begin(model, subsystem, "preparing");
    }

    /// Begins a stage.
    pub fn stage(&self, stage: &str) {
        let (model, subsystem) = self.current();
        self.begin(model, subsystem, stage);
    }

    /// Ends the model's run.
    pub fn end(&self) {
        self.begin(String::new(), None, "between runs");
    }

    /// Writes the trace, in the format of Chrome's trace viewer and Perfetto; returns the table.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(&self) -> Result<String, Failure> {
        self.end();
        let spans = self.spans.lock().unwrap_or_else(PoisonError::into_inner);
        let shown = |error: &dyn std::fmt::Display| Failure::failed(format!("{}: {error}", self.file.display()));
        let text = serde_json::to_string(&trace(&spans)).map_err(|error| shown(&error))?;
        fs::write(&self.file, text + "\n").map_err(|error| shown(&error))?;
        Ok(table(&spans))
    }

    fn current(&self) -> (String, Option<usize>) {
        let spans = self.spans.lock().unwrap_or_else(PoisonError::into_inner);
        spans.last().map_or_else(Default::default, |span| (span.model.clone(), span.subsystem))
    }

    fn begin(&self, model: String, subsystem: Option<usize>, stage: &str) {
        let now = self.begun.elapsed();
        let mut spans = self.spans.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(last) = spans.last_mut() {
            last.ended = Some(now);
        }
        spans.push(Span { model, subsystem, stage: stage.to_owned(), begun: now, ended: None });
    }
}

/// Ended spans with their durations, except those that took no time.
fn ended(spans: &[Span]) -> impl Iterator<Item = (&Span, Duration)> {
    let lasted = |span: &Span| span.ended.map(|ended| ended - span.begun);
    spans.iter().filter_map(move |span| Some((span, lasted(span)?))).filter(|(_, lasted)| lasted.as_micros() > 0)
}

/// Events of a trace: microseconds since the profile began, a process per model, a thread per subsystem.
fn trace(spans: &[Span]) -> serde_json::Value {
    let mut models: Vec<&str> = Vec::new();
    let mut events = Vec::new();
    for (span, lasted) in ended(spans) {
        let process = models.iter().position(|model| *model == span.model).unwrap_or_else(|| {
            models.push(&span.model);
            let name = if span.model.is_empty() { "mbint" } else { &span.model };
            let arguments = json!({ "name": name });
            events.push(json!({ "name": "process_name", "ph": "M", "pid": models.len() - 1, "args": arguments }));
            models.len() - 1
        });
        events.push(json!({
            "name": span.stage, "cat": "stage", "ph": "X", "pid": process,
            "tid": span.subsystem.map_or(0, |subsystem| subsystem + 1),
            "ts": span.begun.as_micros() as u64, "dur": lasted.as_micros() as u64,
        }));
    }
    json!({ "traceEvents": events, "displayTimeUnit": "ms" })
}

/// Seconds of each stage of each subsystem, in the order in which they began.
fn table(spans: &[Span]) -> String {
    let mut rows: Vec<(&Span, Duration)> = Vec::new();
    for (span, lasted) in ended(spans) {
        let key = |other: &Span| (other.model.clone(), other.subsystem, other.stage.clone());
        match rows.iter_mut().find(|(known, _)| key(known) == key(span)) {
            Some((_, sum)) => *sum += lasted,
            None => rows.push((span, lasted)),
        }
    }
    let whole: f64 = rows.iter().map(|(_, lasted)| lasted.as_secs_f64()).sum();
    let mut table = Table::new([
        ("model", Align::Left),
        ("subsystem", Align::Right),
        ("stage", Align::Left),
        ("seconds", Align::Right),
        ("share", Align::Right),
    ]);
    for (Span { model, subsystem, stage, .. }, lasted) in rows {
        let seconds = lasted.as_secs_f64();
        let subsystem = subsystem.map_or_else(String::new, |subsystem| (subsystem + 1).to_string());
        let share = format!("{:.1} %", 100.0 * seconds / whole);
        table.row([model.clone(), subsystem, stage.clone(), format!("{seconds:.4}"), share]);
    }
    table.row([String::new(), String::new(), "in all".to_owned(), format!("{whole:.4}"), "100.0 %".to_owned()]);
    table.render(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overview::plain;

    fn span(model: &str, subsystem: Option<usize>, stage: &str, milliseconds: [u64; 2]) -> Span {
        let [begun, ended] = milliseconds.map(Duration::from_millis);
        Span { model: model.to_owned(), subsystem, stage: stage.to_owned(), begun, ended: Some(ended) }
    }

    #[test]
    fn stages_of_a_subsystem_add_up_on_a_separate_thread() {
        let spans = [
            span("", None, "reading", [0, 10]),
            span("crank", Some(0), "scan", [10, 40]),
            span("crank", Some(1), "scan", [40, 90]),
            span("crank", Some(0), "scan", [90, 100]),
            span("crank", Some(0), "nothing", [100, 100]),
        ];
        let text = plain(&table(&spans));
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(lines.len(), 4, "{text}");
        let ends = |line: usize, end: [&str; 3]| lines[line].split_whitespace().rev().zip(end).all(|(a, b)| a == b);
        assert!(ends(1, ["%", "40.0", "0.0400"]) && ends(2, ["%", "50.0", "0.0500"]), "{text}");
        assert!(ends(3, ["%", "100.0", "0.1000"]), "{text}");
        let trace = trace(&spans);
        let events = trace["traceEvents"].as_array().unwrap();
        let complete: Vec<_> = events.iter().filter(|event| event["ph"] == "X").collect();
        assert_eq!(complete.len(), 4);
        assert_eq!([&complete[2]["pid"], &complete[2]["tid"], &complete[2]["ts"]], [1, 2, 40_000]);
        assert_eq!(events.iter().filter(|event| event["ph"] == "M").count(), 2);
    }

    #[test]
    fn a_stage_ends_where_the_next_begins() {
        let folder = tempfile::tempdir().unwrap();
        let profile = Profile::new(folder.path().join("trace.json")).unwrap();
        profile.model("crank");
        profile.subsystem(Some(0));
        profile.stage("scan");
        profile.end();
        let spans = profile.spans.lock().unwrap();
        let ends: Vec<_> = spans[..spans.len() - 1].iter().map(|span| span.ended.unwrap()).collect();
        let begins: Vec<_> = spans[1..].iter().map(|span| span.begun).collect();
        assert_eq!(ends, begins);
        let known: Vec<_> = spans.iter().map(|span| (span.model.as_str(), span.subsystem)).collect();
        assert_eq!(known, [("", None), ("crank", None), ("crank", Some(0)), ("crank", Some(0)), ("", None)]);
    }
}
