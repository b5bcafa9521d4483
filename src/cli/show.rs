//! `mbint show`: the assembled mechanism, as a picture and as a table.

use std::path::Path;

use super::args::{Format, ShowArgs};
use super::console::{BOLD, Console, to_json};
use super::run::results_of;
use super::{Failure, Status, interrupt, load};
use crate::export::{MOST_TRIANGLES, prepare_folder, read_meshes, write_drawing};
use crate::overview::{Align, Table};
use crate::results::{Drawing, DrawnBody};
use crate::study;

pub(super) fn show(args: &ShowArgs, console: &mut Console) -> Result<Status, Failure> {
    let Some(model) = load::load(&args.model, &args.set.given()?, args.scene.as_ref(), console)? else {
        return Ok(Status::Wrong);
    };
    let mut drawing = study::drawing(&model)
        .map_err(|error| Failure::wrong(format!("{}: {error}", args.model.display())).of(&error))?;
    read_meshes(&mut drawing, args.model.parent().unwrap_or(Path::new("")), MOST_TRIANGLES);
    let folder = args.output.clone().unwrap_or_else(|| results_of(&model.name));
    prepare_folder(&folder).map_err(|error| Failure::wrong(&error).of(&error))?;
    interrupt::wait_for(&folder)?;
    let file = write_drawing(&folder, &drawing).map_err(|error| Failure::failed(&error).of(&error))?;
    console.print(&match args.format {
        Format::Text => format!("{}{}\n", table(&drawing), file.display()),
        Format::Json => to_json(&drawing)?,
    })?;
    Ok(Status::Done)
}

/// Positions of the bodies' frames and points.
fn table(drawing: &Drawing) -> String {
    if drawing.spatial { in_space(drawing) } else { in_the_plane(drawing) }
}

fn in_the_plane(drawing: &Drawing) -> String {
    let headings =
        [("body or point", Align::Left), ("x, m", Align::Right), ("y, m", Align::Right), ("angle, rad", Align::Right)];
    let mut table = Table::new(headings);
    for (name, [x, y, _], body) in rows(drawing) {
        let angle = body.and_then(|body| body.angle).map_or_else(String::new, digits);
        table.row([name, digits(x), digits(y), angle]);
    }
    format!("{BOLD}{}{BOLD:#} at its start\n{}", drawing.model, table.render(2))
}

fn in_space(drawing: &Drawing) -> String {
    let headings = [
        ("body or point", Align::Left),
        ("x, m", Align::Right),
        ("y, m", Align::Right),
        ("z, m", Align::Right),
        ("Euler parameters", Align::Left),
    ];
    let mut table = Table::new(headings);
    for (name, [x, y, z], body) in rows(drawing) {
        let parameters = body.and_then(|body| body.orientation).map(|parameters| parameters.map(digits).join(", "));
        table.row([name, digits(x), digits(y), digits(z), parameters.unwrap_or_default()]);
    }
    format!("{BOLD}{}{BOLD:#} at its start\n{}", drawing.model, table.render(2))
}

/// A row for each frame and each named point; positions are relative to the ground's frame.
fn rows(drawing: &Drawing) -> impl Iterator<Item = (String, [f64; 3], Option<&DrawnBody>)> {
    drawing.bodies.iter().enumerate().flat_map(|(index, body)| {
        let frame = (index > 0).then(|| (body.name.clone(), body.position, Some(body)));
        let named = body.points.iter().filter(|point| !point.name.is_empty());
        let points = named.map(|point| (format!("{}.{}", body.name, point.name), point.position, None));
        frame.into_iter().chain(points)
    })
}

/// Six decimals; rounding errors are zero.
fn digits(value: f64) -> String {
    let text = format!("{value:.6}");
    if text.trim_start_matches('-').parse() == Ok(0.0) { text.trim_start_matches('-').to_owned() } else { text }
}
