//! `mbint verify-certificate`: a stored proof, checked again.

use serde::Serialize;

use super::args::VerifyCertificateArgs;
use super::console::{BOLD, Console, count};
use super::question::answer;
use super::{Failure, Status, load};
use crate::certificate::{self, Certificate, Certified, Checked};
use crate::model::shown;
use crate::results::ModelFile;
use crate::study;

/// A verdict in JSON.
#[derive(Serialize)]
struct Answer {
    model: String,
    valid: bool,
    /// Reason for a refusal.
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<String>,
    /// Whether the equations were compared with those of a model.
    model_compared: bool,
    pieces: usize,
    cells: usize,
    bounds: usize,
}

pub(super) fn verify(args: &VerifyCertificateArgs, console: &mut Console) -> Result<Status, Failure> {
    let wrong = |why: String| Failure::wrong(format!("{}: {why}", shown(&args.certificate)));
    let text = std::fs::read_to_string(&args.certificate).map_err(|error| wrong(error.to_string()))?;
    let certificate = certificate::read(&text).map_err(|error| wrong(error.to_string()))?;
    let other = match &args.model {
        None => None,
        Some(_) => match compared(args, &certificate, console)? {
            Ok(other) => other,
            Err(status) => return Ok(status),
        },
    };
    let pool = study::pool(args.threads.number()).map_err(|error| Failure::failed(&error))?;
    let checked = match other {
        Some(other) => Err(other),
        None => pool.install(|| certificate::check(&certificate)).map_err(|refusal| refusal.to_string()),
    };
    let Checked { pieces, cells, bounds } = checked.as_ref().copied().unwrap_or_default();
    let found = Answer {
        model: certificate.model.clone(),
        valid: checked.is_ok(),
        refusal: checked.err(),
        model_compared: args.model.is_some(),
        pieces,
        cells,
        bounds,
    };
    answer(&found, args.format, args.quiet, console, || overview(&found))?;
    Ok(if found.valid { Status::Done } else { Status::NotMet })
}

fn overview(found: &Answer) -> String {
    let name = &found.model;
    if let Some(why) = &found.refusal {
        return format!("{BOLD}{name}{BOLD:#}: refused\n  {why}\n");
    }
    let cells = count(found.cells, "cell", "cells");
    let pieces = count(found.pieces, "piece", "pieces");
    let bounds = count(found.bounds, "bound", "bounds");
    let of = if found.model_compared {
        "its equations are those of the model"
    } else {
        "name the model too, and its equations are compared"
    };
    format!("{BOLD}{name}{BOLD:#}: proven\n  {bounds} of outputs, {cells} of time in {pieces} of the box; {of}\n")
}

/// Difference between a certificate and the named model; a status if the model cannot be read.
fn compared(
    args: &VerifyCertificateArgs,
    certificate: &Certificate,
    console: &Console,
) -> Result<Result<Option<String>, Status>, Failure> {
    let path = args.model.clone().into_iter().collect::<Vec<_>>();
    let scenes: Vec<String> = args.scene.clone().into_iter().collect();
    let Some(loaded) = load::load_all(&path, &args.set.given()?, &scenes, console)? else {
        return Ok(Err(Status::Wrong));
    };
    let Some(model) = loaded.models.into_iter().next() else { return Ok(Err(Status::Wrong)) };
    let is_there = |file: &&certificate::ModelFile| {
        model.files.iter().any(|own: &ModelFile| own.name == file.name && own.sha256 == file.sha256)
    };
    if let Some(file) = certificate.files.iter().find(|file| !is_there(file)) {
        return Ok(Ok(Some(format!("the model's file {} is not the one that was certified", file.name))));
    }
    let all = model.scenes.len();
    let Some((_, description)) = model.scenes.into_iter().find(|(_, own)| all == 1 || own.name == certificate.model)
    else {
        return Ok(Ok(Some(format!("the model has no scene {}", certificate.model))));
    };
    let own = study::equations(&description)
        .map_err(|error| Failure::wrong(format!("{}: {error}", model.name)).of(&error))?;
    Ok(Ok(difference(certificate, &own)))
}

/// Difference between a certificate's equations and a model's; `None` if there is none.
fn difference(certificate: &Certificate, model: &[Certified]) -> Option<String> {
    let systems = &certificate.systems;
    if systems.len() != model.len() {
        return Some(format!("the model has {} systems of equations, the certificate {}", model.len(), systems.len()));
    }
    for (index, (own, of_model)) in systems.iter().zip(model).enumerate() {
        let system = index + 1;
        let is_same = own.parameters == of_model.parameters && own.outputs == of_model.outputs;
        if !is_same || own.equations != of_model.equations {
            return Some(format!("system {system}: the equations are not those of the model"));
        }
        if own.lower != of_model.lower || own.upper != of_model.upper {
            return Some(format!("system {system}: the box of the parameters is not that of the model"));
        }
    }
    None
}
