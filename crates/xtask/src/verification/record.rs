//! Measurements of a run of the verification: data only, one file of JSON from which all pages are written.

use serde::{Deserialize, Serialize};

/// All measurements of a run, and its circumstances.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Record {
    pub on: Circumstances,
    /// By claim.
    pub sections: Vec<Section>,
}

/// Program and machine of a run.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Circumstances {
    pub version: String,
    /// Hash of the commit, followed by `+` if files differed from it.
    pub commit: String,
    /// Day of the run, YYYY-MM-DD, UTC.
    pub date: String,
    /// `release`, or `dev` for a build with debug assertions.
    pub profile: String,
    pub compiler: String,
    pub processor: String,
    /// The command that measured.
    pub command: String,
    /// Whether the run omits all that takes long.
    pub quick: bool,
}

/// Measurements of a claim, and the commands that made them.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Section {
    /// Name of the claim.
    pub claim: String,
    /// Circumstances of its measurement, if by another run than the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub apart: Option<Circumstances>,
    pub runs: Vec<Run>,
    pub cases: Vec<Case>,
}

impl Record {
    /// Replaces its own sections by those of another run.
    pub fn with(mut self, other: Self) -> Self {
        for section in other.sections {
            let section = Section { apart: Some(other.on.clone()), ..section };
            match self.sections.iter_mut().find(|own| own.claim == section.claim) {
                Some(own) => *own = section,
                None => self.sections.push(section),
            }
        }
        self
    }
}

/// A command of a section.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Run {
    pub command: String,
    /// Tests that passed and failed, for a run of tests.
    pub passed: usize,
    pub failed: usize,
    /// Reason why it did not run, or did not end well.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Reason why it was omitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_out: Option<String>,
}

/// A case of a claim with its figures: a line that a test writes (`tests/common/measured.rs`).
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Case {
    pub claim: String,
    pub case: String,
    /// Source of expected values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    #[serde(default)]
    pub figures: Vec<Figure>,
    /// Reason why the claim does not cover the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exception: Option<String>,
}

/// A number, words, or a share, with its limits.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Figure {
    pub name: String,
    /// `None` for a number that is not finite.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
    /// For a share: `count` of `of` independent trials.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<u64>,
}

impl Figure {
    /// A number within limits.
    pub fn number(name: &str, value: f64, low: Option<f64>, high: Option<f64>) -> Self {
        let value = value.is_finite().then_some(value);
        Self { name: name.to_owned(), value, low, high, ..Self::default() }
    }

    /// Words.
    pub fn words(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: Some(text.to_owned()), ..Self::default() }
    }
}

/// Cases from lines of JSON; the error names an invalid line.
pub fn cases(text: &str) -> Result<Vec<Case>, String> {
    let numbered = text.lines().enumerate().filter(|(_, line)| !line.is_empty());
    let read = |(number, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|error| format!("line {} of the measurements: {error}", number + 1))
    };
    numbered.map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newer_sections_replace_older_ones() {
        let of = |commit: &str, claims: &[&str]| Record {
            on: Circumstances { commit: commit.to_owned(), ..Circumstances::default() },
            sections: claims.iter().map(|&claim| Section { claim: claim.to_owned(), ..Section::default() }).collect(),
        };
        let record = of("old", &["a", "b"]).with(of("new", &["b", "c"]));
        let commits =
            record.sections.iter().map(|own| (own.claim.as_str(), own.apart.as_ref().map(|on| on.commit.as_str())));
        assert_eq!(commits.collect::<Vec<_>>(), [("a", None), ("b", Some("new")), ("c", Some("new"))]);
        assert_eq!(record.on.commit, "old");
    }

    #[test]
    fn lines_of_tests_are_read_and_malformed_ones_named() {
        let line = r#"{"case":"a","claim":"c","figures":[{"name":"error","value":null,"high":1},{"name":"n","count":1,"of":29,"high":null}]}"#;
        let read = cases(&format!("{line}\n\n{line}\n")).unwrap();
        assert_eq!((read.len(), read[0].figures[0].value, read[0].figures[1].of), (2, None, Some(29)));
        let error = cases(&format!("{line}\n{{\"case\": \"b\"")).unwrap_err();
        assert!(error.starts_with("line 2 of the measurements: EOF"), "{error}");
        let error = cases("{\"case\":\"b\"}").unwrap_err();
        assert!(error.contains("missing field `claim`"), "{error}");
    }
}
