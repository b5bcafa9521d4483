//! Sections of a report that are text and tables, from `summary.json` and `motion.json`: they are there without
//! scripts, and in print.

use serde_json::Value;

use super::html::{escaped, number};

/// A text of an object; empty if it has none.
pub(super) fn text<'v>(object: &'v Value, key: &str) -> &'v str {
    object[key].as_str().unwrap_or("")
}

/// The objects of a list; empty if there is no list.
pub(super) fn list<'v>(object: &'v Value, key: &str) -> &'v [Value] {
    object[key].as_array().map_or(&[], Vec::as_slice)
}

/// A table; the first cell of a row is its heading.
pub(super) fn table(headings: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let head: String = headings.iter().map(|heading| format!("<th scope=\"col\">{heading}</th>")).collect();
    let body: String = rows
        .map(|cells| {
            let cells = cells.into_iter().enumerate().map(|(index, cell)| match index {
                0 => format!("<th scope=\"row\">{cell}</th>"),
                _ => format!("<td>{cell}</td>"),
            });
            format!("<tr>{}</tr>", cells.collect::<String>())
        })
        .collect();
    format!("<div class=\"wide\"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>")
}

/// A section with its heading.
pub(super) fn section(class: &str, heading: &str, content: &str) -> String {
    format!("<section class=\"{class}\"><h3>{heading}</h3>{content}</section>\n")
}

/// A number of `object`, or within it, in the unit in which `object` is shown: the declared one, or SI.
pub(super) fn shown(object: &Value, value: &Value) -> String {
    let display = &object["display"];
    match (display["unit"].as_str(), display["si"].as_f64(), value.as_f64()) {
        (Some(unit), Some(si), Some(value)) => with_unit(&Value::from(value / si), unit),
        _ => with_unit(value, text(object, "unit")),
    }
}

/// A number with its unit, if it has one.
fn with_unit(value: &Value, unit: &str) -> String {
    let number = number(value);
    if unit.is_empty() { number } else { format!("{number}&#8239;{}", escaped(&unit.replace('*', "·"))) }
}

/// Requirements with their verdicts; empty if the model has none.
pub(super) fn requirements(summary: &Value) -> String {
    let rows = list(summary, "requirements").iter().map(|requirement| {
        let verdict = text(requirement, "verdict");
        // A sign too: not everybody distinguishes the colours.
        let sign = match verdict {
            "holds" => "✓",
            "violated" => "✗",
            _ => "?",
        };
        let certified = if requirement["certified"] == Value::Bool(true) { ", proven" } else { "" };
        vec![
            format!("{}<br><code>{}</code>", escaped(text(requirement, "name")), escaped(text(requirement, "text"))),
            format!("<span class=\"verdict {}\">{sign} {}{certified}</span>", escaped(verdict), escaped(verdict)),
            shown(requirement, &requirement["margin"]),
            shown(requirement, &requirement["error"]),
            escaped(text(requirement, "decides")),
        ]
    });
    match list(summary, "requirements") {
        [] => String::new(),
        _ => section(
            "requirements",
            "Requirements",
            &table(&["requirement", "verdict", "margin", "± error", "what would decide"], rows),
        ),
    }
}

/// Numbers of whole motions; empty if the model asks for none.
pub(super) fn reduced(summary: &Value) -> String {
    let rows = list(summary, "reduced").iter().map(|reduced| {
        let bands = list(reduced, "bands").iter().map(|band| {
            let [lower, upper] = ["lower", "upper"].map(|side| shown(reduced, &band[side]));
            let unresolved = if band["unresolved"] == Value::Bool(true) { ", unreliable" } else { "" };
            format!("{lower} to {upper} ({}{unresolved})", escaped(text(band, "method")))
        });
        let bands = bands.chain(occurrence(reduced));
        vec![
            format!("{}<br><code>{}</code>", escaped(text(reduced, "name")), escaped(text(reduced, "of"))),
            shown(reduced, &reduced["nominal"]),
            bands.collect::<Vec<_>>().join("<br>"),
        ]
    });
    match list(summary, "reduced") {
        [] => String::new(),
        _ => section("reduced", "Numbers of the motion", &table(&["of", "nominal", "bounds"], rows)),
    }
}

/// The number of samples in which an instant occurs, and its share of the box; `None` if it occurs in all.
fn occurrence(reduced: &Value) -> Option<String> {
    let occurs = reduced.get("occurs")?;
    let samples = format!("occurs in {} of {} samples", number(&occurs["samples"]), number(&occurs["of"]));
    let percent: Vec<String> =
        list(occurs, "share").iter().filter_map(Value::as_f64).map(|share| format!("{:.1}", 100.0 * share)).collect();
    Some(match &percent[..] {
        [least, most] if least == most => format!("{samples}, {least}&#8239;% of the box"),
        [least, most] => format!("{samples}, {least} to {most}&#8239;% of the box"),
        _ => samples,
    })
}

/// Events that some of the samples meet; empty if there are none.
pub(super) fn events(summary: &Value) -> String {
    let grazed = |pair: &Value| {
        let own = list(summary, "parameters").iter().find(|parameter| parameter["name"] == pair[0])?;
        Some(format!("{} = {}", escaped(text(own, "name")), shown(own, &pair[1])))
    };
    let rows = list(summary, "events").iter().map(|event| {
        let grazed: Vec<String> = list(event, "grazed_at").iter().filter_map(grazed).collect();
        vec![
            escaped(text(event, "event")),
            format!("{} of {} samples", number(&event["met"]), number(&event["samples"])),
            grazed.join(", or<br>"),
        ]
    });
    match list(summary, "events") {
        [] => String::new(),
        _ => section("events", "Events in a part of the box", &table(&["event", "switches in", "is grazed at"], rows)),
    }
}

/// The uncertain parameters, and their contributions to each output.
pub(super) fn parameters(summary: &Value) -> String {
    let parameters = list(summary, "parameters");
    if parameters.is_empty() {
        return section("parameters", "Parameters", "<p>No parameter is uncertain.</p>");
    }
    let rows = parameters.iter().map(|parameter| {
        let cells = ["nominal", "lower", "upper"].map(|key| shown(parameter, &parameter[key]));
        std::iter::once(escaped(text(parameter, "name"))).chain(cells).collect()
    });
    section("parameters", "Parameters", &table(&["parameter", "nominal", "least", "greatest"], rows))
}

/// The largest width and error of each band, and its extremes over the run.
pub(super) fn bounds(summary: &Value) -> String {
    let peak = |error: &Value, side: &str| {
        let same = |peak: &&Value| ["output", "method"].iter().all(|key| peak[key] == error[key]);
        let peak = list(summary, "peaks").iter().find(same);
        peak.map_or_else(String::new, |peak| shown(error, &peak[side]["value"]))
    };
    let rows = list(summary, "errors").iter().map(|error| {
        let from = error.get("unresolved_from").map(|time| format!("from {} s", number(time)));
        vec![
            escaped(text(error, "output")),
            escaped(text(error, "method")),
            peak(error, "least"),
            peak(error, "greatest"),
            shown(error, &error["width"]),
            shown(error, &error["error"]),
            from.unwrap_or_default(),
        ]
    });
    let headings = ["output", "method", "least", "greatest", "largest width", "largest error", "unreliable"];
    match list(summary, "errors") {
        [] => String::new(),
        _ => section("bounds", "Bounds over the run", &table(&headings, rows)),
    }
}

/// Warnings that a reader has to know before believing the rest.
pub(super) fn warnings(summary: &Value, motion: &Value) -> Vec<String> {
    let mut warnings = Vec::new();
    if summary["interrupted"] == Value::Bool(true) {
        warnings.push("The run was interrupted before it was done.".to_owned());
    }
    if !text(summary, "failure").is_empty() {
        warnings.push(format!("The run did not come to its end: {}", text(summary, "failure")));
    }
    for error in list(summary, "errors").iter().filter(|error| error.get("unresolved_from").is_some()) {
        let (output, method) = (text(error, "output"), text(error, "method"));
        let from = error["unresolved_from"].as_f64().unwrap_or(0.0);
        warnings.push(format!("Bounds of {output} by {method} are unreliable from {from} s."));
    }
    if let Some(followed) = summary.get("events_followed") {
        let until = followed["until"].as_f64().unwrap_or(0.0);
        warnings.push(format!("Events are followed to {until} s: {}.", text(followed, "why")));
    }
    for (key, what) in [
        ("redundant_constraints", "Redundant constraints (omitted)"),
        ("undetermined_outputs", "Outputs that equilibrium does not determine"),
        ("shared_start", "Coordinates that the model leaves open at the start"),
        ("not_simulated", "Not simulated, since no output depends on it"),
    ] {
        let names: Vec<&str> = list(summary, key).iter().filter_map(Value::as_str).collect();
        if !names.is_empty() {
            warnings.push(format!("{what}: {}.", names.join(", ")));
        }
    }
    for (key, what) in [
        ("singular_at_start", "singular configurations at the start"),
        ("singular_configurations", "singular configurations on the way"),
        ("damped_mode", "a fast mode that the time steps damp"),
        ("pieces", "omitted parts of the parameters' box"),
    ] {
        if summary.get(key).is_some_and(|found| found.as_array().is_none_or(|list| !list.is_empty())) {
            warnings
                .push(format!("There are {what}: see {key} in summary.json.").replace("There are a ", "There is a "));
        }
    }
    if !text(motion, "absent").is_empty() {
        warnings.push(format!("The motion is not shown: {}", text(motion, "absent")));
    }
    let stopped = motion["motion"]["stopped"].as_u64().unwrap_or(0);
    if stopped > 0 {
        warnings.push(format!("{stopped} of the samples that were to be shown moving stop before the end."));
    }
    warnings
}

/// Warnings as a section; empty if there are none.
pub(super) fn warning_list(warnings: &[String]) -> String {
    let items: String = warnings.iter().map(|warning| format!("<li>{}</li>", escaped(warning))).collect();
    if items.is_empty() { String::new() } else { section("warnings", "Warnings", &format!("<ul>{items}</ul>")) }
}

/// The simulation, its settings, and the version.
pub(super) fn settings(summary: &Value) -> String {
    let number_of = |key: &str| number(&summary[key]);
    let scheme = match text(summary, "integration") {
        "" => format!("HHT-I3, α = {}", number_of("alpha")),
        integration => escaped(integration),
    };
    let mut rows = vec![
        ("mbint", escaped(text(summary, "mbint"))),
        ("simulated time", format!("{} s", number_of("duration"))),
        ("coordinates", format!("{} ({})", number_of("coordinates"), escaped(text(summary, "formulation")))),
        ("constraints", number_of("constraints")),
        ("degrees of freedom", number_of("degrees_of_freedom")),
        ("scheme", scheme),
    ];
    let request = &summary["request"];
    let set: Vec<&str> = list(request, "set").iter().filter_map(Value::as_str).collect();
    if !set.is_empty() {
        rows.push(("set by the command", escaped(&set.join(", "))));
    }
    let files: Vec<String> = list(summary, "model_files")
        .iter()
        .map(|file| format!("{} <small>SHA-256 {}</small>", escaped(text(file, "name")), escaped(text(file, "sha256"))))
        .collect();
    if !files.is_empty() {
        rows.push(("model", files.join("<br>")));
    }
    let settings = table(&["", ""], rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]));
    let methods = list(summary, "methods").iter().map(|method| {
        let numbers = ["simulations", "steps", "newton_iterations"].map(|key| number(&method[key]));
        std::iter::once(escaped(text(method, "method"))).chain(numbers).collect()
    });
    let methods = table(&["method", "simulations", "steps each", "Newton iterations"], methods);
    section(
        "settings",
        "Run",
        &(settings.replace("<thead><tr><th scope=\"col\"></th><th scope=\"col\"></th></tr></thead>", "") + &methods),
    )
}

/// The model's files.
pub(super) fn model_text(motion: &Value) -> String {
    let files = list(motion, "model").iter().map(|file| {
        let (name, text) = (escaped(text(file, "name")), escaped(text(file, "text")));
        format!("<details><summary>{name}</summary><pre><code>{text}</code></pre></details>")
    });
    let files: String = files.collect();
    if files.is_empty() { String::new() } else { section("model", "Model", &files) }
}
