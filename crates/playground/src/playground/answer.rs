//! Answers to a page.

use std::collections::BTreeMap;

use serde::Serialize;

use super::question::{Question, Task};
use super::running::{Host, Run, Unrun, run};
use crate::syntax::diagnostic::Record;

/// The answer; unknown parts are absent.
#[derive(Debug, Default, Serialize)]
struct Answer {
    /// The model's name, if it has no errors.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Its scenes.
    scenes: Vec<String>,
    /// The scene that was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    scene: Option<String>,
    diagnostics: Vec<Record>,
    /// Reason why there are no results.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// Whether the run was refused because it would take long.
    waits: bool,
    /// The summary as on a terminal.
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<String>,
    /// Warnings to read before believing the results.
    warnings: Vec<String>,
    /// Files of the results by their names: tables, plots, the report.
    files: BTreeMap<String, String>,
}

/// Answers a question; both are JSON.
pub fn answer(question: &[u8], host: &dyn Host) -> Vec<u8> {
    let answer = match serde_json::from_slice(question) {
        Ok(question) => of(&question, host),
        Err(error) => Answer { error: Some(format!("the question cannot be read: {error}")), ..Answer::default() },
    };
    // It consists of text and numbers only.
    serde_json::to_vec(&answer).unwrap_or_default()
}

fn of(question: &Question, host: &dyn Host) -> Answer {
    let reading = question.read().reading;
    let scenes: Vec<String> = reading.scenes.iter().map(|scene| scene.name.clone()).collect();
    let asked = question.scene.as_ref().filter(|asked| scenes.contains(asked));
    let scene = asked.or(scenes.first()).cloned();
    let mut answer = Answer {
        name: reading.description.as_ref().map(|description| description.name.clone()),
        diagnostics: reading.diagnostics.records(),
        scenes,
        scene,
        ..Answer::default()
    };
    if question.task == Task::Check || answer.name.is_none() {
        return answer;
    }
    match run(reading, answer.scene.as_deref(), question.costly, host) {
        Ok(Run { summary, warnings, files, failure }) => {
            Answer { summary: Some(summary), warnings, files, error: failure, ..answer }
        }
        Err(Unrun { why, waits }) => {
            answer.error = Some(why);
            answer.waits = waits;
            answer
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    struct Silent;

    impl Host for Silent {
        fn progress(&self, _stage: &str, _fraction: f64) {}
    }

    fn asked(task: &str, more: &Value) -> Value {
        let mut question = json!({ "task": task, "model": "m/a.yaml" });
        question.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        serde_json::from_slice(&answer(question.to_string().as_bytes(), &Silent)).unwrap()
    }

    #[test]
    fn texts_replace_files() {
        let robot = include_str!("../../../../models/arm.urdf");
        let answer = asked("check", &json!({ "model": "arm.urdf", "files": { "arm.urdf": robot } }));
        assert_eq!((&answer["diagnostics"], &answer["name"]), (&json!([]), &json!("arm")), "{answer}");
        assert!(answer.get("summary").is_none());
    }

    #[test]
    fn errors_have_positions() {
        let answer = asked("run", &json!({ "files": { "m/a.yaml": "model: a\nbodys: {}\n" } }));
        let found = answer["diagnostics"].as_array().unwrap();
        let is_there = |record: &&Value| record["line"] == 2 && record["file"] == "m/a.yaml";
        assert!(found.iter().any(|record| is_there(&record)), "{answer}");
        assert!(answer.get("name").is_none() && answer["files"] == json!({}));
    }

    #[test]
    fn unreadable_question_is_reported() {
        let answer: Value = serde_json::from_slice(&answer(b"{}", &Silent)).unwrap();
        assert!(
            answer["error"].as_str().unwrap().starts_with("the question cannot be read: missing field"),
            "{answer}"
        );
    }

    #[test]
    fn a_run_has_its_summary_and_its_files() {
        let text = include_str!("../../../../models/pendulum.yaml");
        let answer = asked("run", &json!({ "files": { "m/a.yaml": text } }));
        assert!(answer["summary"].as_str().unwrap().starts_with("pendulum: "), "{answer}");
        let files = answer["files"].as_object().unwrap();
        assert!(["bounds.csv", "report.html", "summary.json"].iter().all(|name| files.contains_key(*name)));
    }
}
