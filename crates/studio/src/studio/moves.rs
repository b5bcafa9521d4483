//! The mechanism's motions: nominal, at requested samples, and by hand.

use std::path::Path;

use serde_json::{Value, json};

use super::desk::{Current, Desk};
use super::questions::{Drag, Move, replaced};
use super::tuning::TUNING;
use crate::export::{MOST_TRIANGLES, ReportParts, motion_json, read_meshes};
use crate::numerics::Sample;
use crate::results::Motion;
use crate::simulate::Interruption;
use crate::study::{self, Hand, Movable};

/// Serves one model after the other, until the end.
pub fn work(desk: &Desk) {
    let mut seen = 0;
    while let Some(current) = desk.next_model(seen) {
        seen = current.number;
        let served = study::caught("the motion", || serve(desk, &current));
        let why = match served {
            Ok(Ok(())) => continue,
            Ok(Err(error)) => error,
            Err(error) => error.to_string(),
        };
        if !desk.is_replaced(seen) {
            desk.board.put("mechanism", json!({ "number": seen, "absent": why }));
        }
        while let Some(asked) = desk.moves.next(&|| desk.is_replaced(seen)) {
            asked.answer(Err(why.clone()));
        }
    }
}

/// Serves a model until another replaces it; the error is the reason why nothing can be shown.
fn serve(desk: &Desk, current: &Current) -> Result<(), String> {
    let is_replaced = || desk.is_replaced(current.number);
    let beside = desk.texts(|texts| texts.model().parent().map(Path::to_owned)).unwrap_or_default();
    let movable = Movable::new(&current.description, Interruption::new(&is_replaced));
    let movable = movable.map_err(|error| error.to_string())?;
    let mut hand = movable.hand();
    let nominal = motion(&movable, &movable.nominal(), &beside);
    if is_replaced() {
        return Ok(());
    }
    desk.board.put("mechanism", json!({ "number": current.number, "motion": nominal? }));
    while let Some(asked) = desk.moves.next(&is_replaced) {
        let answer = match &asked.question {
            Move::Motion(number, _) | Move::Drag(Drag { number, .. }) if *number != current.number => Err(replaced()),
            Move::Motion(_, sample) => motion(&movable, sample, &beside),
            Move::Drag(drag) => dragged(&mut hand, drag),
        };
        asked.answer(answer);
    }
    Ok(())
}

/// A motion in the form of the report's scripts.
fn motion(movable: &Movable, sample: &Sample, beside: &Path) -> Result<Value, String> {
    let mut found: Motion = movable.motion(sample, TUNING.numbers_of_motion).map_err(|error| error.to_string())?;
    read_meshes(&mut found.drawing, beside, MOST_TRIANGLES);
    let parts = ReportParts { description: None, texts: Vec::new(), motion: Ok(found), page: false };
    let json = motion_json(&parts, None).map_err(|error| error.to_string())?;
    let mut json: Value = serde_json::from_slice(&json).map_err(|error| error.to_string())?;
    // The scripts draw it themselves.
    json["motion"].as_object_mut().map(|motion| motion.remove("picture"));
    Ok(json["motion"].take())
}

fn dragged(hand: &mut Hand, drag: &Drag) -> Result<Value, String> {
    if let Some(pose) = &drag.from {
        hand.release();
        hand.follow(&drag.sample, pose);
    }
    let held = hand.drag(drag.grip, &drag.sample, drag.place).ok_or("there is no such point, or it does not move")?;
    Ok(json!({
        "pose": held.pose,
        "points": held.points,
        "at": held.at,
        "residual": held.residual,
        "freedom": held.freedom,
    }))
}
