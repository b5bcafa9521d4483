//! The page's requests, with their answers.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::answer::Answer;
use super::desk::Desk;
use super::language::{Language, METHODS};
use super::questions::{Drag, Move, Values, replaced};
use super::texts::TextError;
use super::{page, report};
use crate::numerics::Sample;
use crate::study::{self, Grip};

/// State that requests need.
pub struct Routes {
    /// The shared state.
    pub desk: Arc<Desk>,
    /// The language server.
    pub language: Arc<Language>,
}

/// A file of the model.
#[derive(Deserialize)]
struct Named {
    path: PathBuf,
}

/// A text of a file.
#[derive(Deserialize)]
struct Written {
    path: PathBuf,
    text: String,
}

/// A message to the language server.
#[derive(Deserialize)]
struct Message {
    method: String,
    params: Value,
}

/// Values of the uncertain parameters of a model.
#[derive(Deserialize)]
struct Wanted {
    number: u64,
    values: Vec<f64>,
}

/// A point that is dragged.
#[derive(Deserialize)]
struct Dragged {
    #[serde(flatten)]
    wanted: Wanted,
    body: usize,
    point: usize,
    place: [f64; 3],
    from: Option<Vec<f64>>,
}

/// A scene.
#[derive(Deserialize)]
struct Scene {
    scene: String,
}

impl From<TextError> for Answer {
    fn from(error: TextError) -> Self {
        let status = match error {
            TextError::Foreign(_) => 403,
            TextError::Changed(_) => 409,
            TextError::Unreadable(..) | TextError::Unwritten(..) => 500,
        };
        Self::error(status, &error.to_string())
    }
}

impl Routes {
    /// The answer to a request, given by its path behind the token, its query, and its body.
    pub fn answer(&self, method: &str, path: &str, query: &str, body: &str) -> Answer {
        let answer = match (method, path) {
            ("GET", "events") => Ok(Answer::json(&self.desk.board.after(number(query)))),
            ("GET", "report") => Ok(report::answer(&self.desk)),
            ("GET", path) => page::file(path).ok_or_else(|| Answer::error(404, "there is no such part")),
            ("POST", "open") => read(body).and_then(|own| self.open(own)),
            ("POST", "text") => read(body).and_then(|own| self.text(own)),
            ("POST", "load") => read(body).and_then(|own| self.load(own)),
            ("POST", "save") => read(body).and_then(|own| self.save(own)),
            ("POST", "language") => read(body).and_then(|own| self.message(own)),
            ("POST", "sample") => read(body).and_then(|own| self.sample(&own)),
            ("POST", "motion") => read(body).and_then(|own| self.motion(&own)),
            ("POST", "drag") => read(body).and_then(|own| self.drag(own)),
            ("POST", "scene") => read(body).map(|own: Scene| {
                self.desk.choose(own.scene);
                Answer::json(&json!({}))
            }),
            ("POST", "allow") => {
                self.desk.allow();
                Ok(Answer::json(&json!({})))
            }
            ("POST", _) => Err(Answer::error(404, "there is no such request")),
            _ => Err(Answer::error(405, "GET and POST are known here")),
        };
        answer.unwrap_or_else(|error| error)
    }

    fn open(&self, Named { path }: Named) -> Result<Answer, Answer> {
        let (text, is_unsaved) = self.desk.texts(|texts| {
            let text = texts.open(&path)?.to_owned();
            Ok::<_, TextError>((text, texts.is_unsaved(&path)))
        })?;
        self.language.open(&path, &text);
        Ok(Answer::json(&json!({ "text": text, "unsaved": is_unsaved })))
    }

    fn text(&self, Written { path, text }: Written) -> Result<Answer, Answer> {
        self.desk.write(&path, text.clone())?;
        // Opening a document again with another text is the same as a change of it.
        self.language.open(&path, &text);
        Ok(Answer::json(&json!({ "unsaved": self.desk.texts(|texts| texts.is_unsaved(&path)) })))
    }

    fn load(&self, Named { path }: Named) -> Result<Answer, Answer> {
        self.desk.load(&path)?;
        self.open(Named { path })
    }

    fn save(&self, Named { path }: Named) -> Result<Answer, Answer> {
        self.desk.texts(|texts| texts.save(&path))?;
        self.language.saved(&path);
        Ok(Answer::json(&json!({ "unsaved": false })))
    }

    fn message(&self, Message { method, params }: Message) -> Result<Answer, Answer> {
        if !METHODS.contains(&method.as_str()) {
            return Err(Answer::error(403, &format!("`{method}` is not passed on")));
        }
        let uri = params["textDocument"]["uri"].as_str().and_then(|uri| FromStr::from_str(uri).ok());
        let path = uri.as_ref().and_then(mbint_lsp::path_of);
        if !path.is_some_and(|path: PathBuf| self.desk.texts(|texts| texts.has(&path))) {
            return Err(Answer::error(403, "the document is no file of this model"));
        }
        let result = self.language.ask(&method, params).map_err(|error| Answer::error(400, &error))?;
        Ok(Answer::json(&result))
    }

    /// The sample of a request, if its values fit the parameters of the current model.
    fn wanted(&self, wanted: &Wanted) -> Result<Sample, Answer> {
        let current = self.desk.current().filter(|current| current.number == wanted.number);
        let current = current.ok_or_else(|| Answer::error(409, &replaced()))?;
        let (parameters, _) = study::uncertain(&current.description);
        if parameters.len() != wanted.values.len() {
            return Err(Answer::error(400, "each uncertain parameter has one value"));
        }
        for (parameter, value) in parameters.iter().zip(&wanted.values) {
            if !(parameter.lower..=parameter.upper).contains(value) {
                let why = format!(
                    "`{}` is from {} to {} {}, and not {value}",
                    parameter.name, parameter.lower, parameter.upper, parameter.unit
                );
                return Err(Answer::error(400, &why));
            }
        }
        Ok(Sample::from(wanted.values.clone()))
    }

    fn sample(&self, wanted: &Wanted) -> Result<Answer, Answer> {
        let sample = self.wanted(wanted)?;
        answered(self.desk.samples.ask(Values { number: wanted.number, sample }))
    }

    fn motion(&self, wanted: &Wanted) -> Result<Answer, Answer> {
        let sample = self.wanted(wanted)?;
        answered(self.desk.moves.ask(Move::Motion(wanted.number, sample)))
    }

    fn drag(&self, Dragged { wanted, body, point, place, from }: Dragged) -> Result<Answer, Answer> {
        let sample = self.wanted(&wanted)?;
        if !place.iter().all(|x| x.is_finite()) {
            return Err(Answer::error(400, "a place has three numbers"));
        }
        let drag = Drag { number: wanted.number, sample, grip: Grip { body, point }, place, from };
        answered(self.desk.moves.ask(Move::Drag(drag)))
    }
}

/// A worker's answer.
fn answered(answer: Result<Value, String>) -> Result<Answer, Answer> {
    answer.map(|value| Answer::json(&value)).map_err(|why| Answer::error(409, &why))
}

/// The body of a request.
fn read<T: DeserializeOwned>(body: &str) -> Result<T, Answer> {
    serde_json::from_str(body).map_err(|error| Answer::error(400, &error.to_string()))
}

/// The number of `after=12`; 0 if absent.
fn number(query: &str) -> u64 {
    query.strip_prefix("after=").and_then(|number| number.parse().ok()).unwrap_or(0)
}
