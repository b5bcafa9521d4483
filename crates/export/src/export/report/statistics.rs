//! Sections of a report on statistics: worst case, root sum square and distribution side by side, and the share that
//! fulfils each requirement.

use serde_json::Value;

use super::html::{escaped, number};
use super::tables::{list, section, shown, table, text};

/// The tolerance stack of each output at the time at which it varies most, and yields; empty if the model asks for
/// none.
pub(super) fn statistics(summary: &Value) -> String {
    let found = &summary["statistics"];
    let has_time = text(&summary["analysis"], "kind") != "dimensions";
    stack(found, has_time) + &yields(found)
}

fn stack(found: &Value, has_time: bool) -> String {
    let outputs = list(found, "outputs");
    if outputs.is_empty() {
        return String::new();
    }
    let rows = outputs.iter().map(|output| {
        let value = |of: &Value| shown(output, of);
        let spread = |key: &str| format!("± {}", value(&output[key]));
        let [lower, upper] = [0, 1].map(|side| value(&output["worst_case"][side]));
        let quantiles = list(output, "quantiles");
        let ends = match (quantiles.first(), quantiles.last()) {
            (Some(low), Some(high)) => format!("{} to {}", value(&low["value"]), value(&high["value"])),
            _ => String::new(),
        };
        vec![
            escaped(text(output, "output")),
            if has_time { format!("{} s", number(&output["time"])) } else { "–".to_owned() },
            format!("{lower} to {upper}"),
            spread("linear"),
            spread("rss"),
            value(&output["mean"]["value"]),
            value(&output["deviation"]["value"]),
            ends,
        ]
    });
    let headings = ["output", "at", "worst case", "linear", "RSS", "mean", "deviation", "statistical"];
    let shares: Vec<String> = match list(found, "quantiles") {
        [first, .., last] => vec![number(first), number(last)],
        _ => Vec::new(),
    };
    let shares = match &shares[..] {
        [first, last] => format!(" Statistical: from the {first}-quantile to the {last}-quantile of the laws."),
        _ => String::new(),
    };
    let note =
        format!("<p>Worst case: every case of the box, at the time at which the output varies most.{shares}</p>");
    section("statistics", "Worst case, root sum square and distribution", &(table(&headings, rows) + &note))
}

fn yields(found: &Value) -> String {
    let all: Vec<&Value> =
        list(found, "requirements").iter().chain(found.get("together").filter(|own| !own.is_null())).collect();
    if all.is_empty() {
        return String::new();
    }
    let rows = all.into_iter().map(|own| {
        let known = |key: &str| own.get(key).filter(|value| !value.is_null()).map_or_else(String::new, number);
        let interval = &own["ppm_interval"];
        vec![
            escaped(text(own, "requirement")),
            known("ppm"),
            format!("{} to {}", number(&interval[0]), number(&interval[1])),
            known("cp"),
            known("cpk"),
        ]
    });
    section("yields", "Parts that fail", &table(&["requirement", "ppm", "95 %", "Cp", "Cpk"], rows))
}
