//! Provenance of a result: the model's files and the questions asked.

use serde::Serialize;

/// Identifies model and request of a result, for a comparison with another result.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Every file that was read: the model, its robot, its tables. Empty for a model that is no file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub model_files: Vec<ModelFile>,
    /// Request of the command in addition to the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub request: Option<RunRequest>,
}

/// A file as it was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ModelFile {
    /// Its name, without folders; `stdin` is standard input.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// Request of a command in addition to the model.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RunRequest {
    /// Parameters that were set, e.g. `l1=0.16±2%`.
    pub set: Vec<String>,
    /// Names of the methods instead of the model's; absent for the model's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub methods: Option<Vec<String>>,
    /// File of functions of the time that excitations were.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub witness: Option<String>,
    /// Whether certified bounds were added.
    pub certify: bool,
    /// Whether these were of the scheme.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub certify_scheme: bool,
    /// Whether every sample was simulated with halved steps too.
    pub certify_time: bool,
    /// Whether infeasible parameter values were excluded.
    pub skip_infeasible: bool,
}
