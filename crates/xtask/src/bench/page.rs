//! The page of the performance record and its drawing, from the table alone.

use std::fmt::Write;

use super::history::{History, INSTRUCTIONS, Row, TIME, mean_ratio, numbers, peers};

const HEAD: &str = "# Performance record

`cargo xtask bench` adds a row a release to [record.csv](record.csv) and writes this page. *Instructions* are those of a step of HHT-I3 with one factorisation of each shipped model
([stages](../reference/instructions.md)); they do not depend on the machine. *Times* are those of a step of one sample on one thread, in turns of a reference loop (a product and a sum, each of which
waits for the one before) that the same run measures, so that machines of one kind can be compared. Rows of commits before a release have instructions only, from
the page that their gate held. The gate fails where a model's step has over 2 % more instructions than in the last row.

![Instructions and times of all models, geometric means](history.svg)

";

/// Text and drawing.
pub fn all(history: &History) -> [(&'static str, String); 2] {
    [("index.md", text(history)), ("history.svg", drawing(history))]
}

fn cell<'r>(row: &'r Row, column: &str) -> &'r str {
    row.get(column).map_or("", String::as_str)
}

/// Ratios of every row to the first one with such numbers, as geometric means over models.
fn ratios(history: &History, beginning: &'static str) -> Vec<Option<f64>> {
    let first = history.rows.iter().find(|row| !numbers(row, beginning).is_empty());
    history.rows.iter().map(|row| mean_ratio(row, first?, beginning)).collect()
}

fn text(history: &History) -> String {
    let mut page = HEAD.to_owned();
    page += "| version | day | commit | processor | instructions | times |\n|---|---|---|---|--:|--:|\n";
    let all = ratios(history, INSTRUCTIONS).into_iter().zip(ratios(history, TIME));
    for (row, (instructions, times)) in history.rows.iter().zip(all) {
        let percent = |ratio: Option<f64>| ratio.map_or(String::new(), |ratio| format!("{:.1} %", 100.0 * ratio));
        let of_row = ["version", "date", "commit", "processor"].map(|column| cell(row, column));
        let [version, date, commit, processor] = of_row;
        _ = writeln!(
            page,
            "| {version} | {date} | `{commit}` | {processor} | {} | {} |",
            percent(instructions),
            percent(times)
        );
    }
    for (row, (name, time)) in history.rows.iter().flat_map(|row| peers(row).into_iter().map(move |peer| (row, peer))) {
        let model = name.split_once(": ").map_or(name, |(_, model)| model);
        let own = numbers(row, TIME).get(model).copied().unwrap_or(f64::NAN);
        _ = writeln!(
            page,
            "\n{}: {name} takes {time} turns of the reference loop a step, {:.0} times those of mbint.",
            cell(row, "version"),
            time / own
        );
    }
    let Some((last, before)) = history.rows.split_last() else { return page };
    let before = before.last();
    _ = writeln!(
        page,
        "\n## {}\n\nOf the last row: instructions, the change since the row before, and turns of the reference loop.\n",
        cell(last, "version")
    );
    page += "| model | instructions | change | time |\n|---|--:|--:|--:|\n";
    let (counts, times) = (numbers(last, INSTRUCTIONS), numbers(last, TIME));
    let old = before.map(|row| numbers(row, INSTRUCTIONS)).unwrap_or_default();
    let mut names: Vec<&str> = counts.keys().chain(times.keys()).copied().collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let change =
            counts.get(name).zip(old.get(name)).map(|(new, old)| format!("{:+.1} %", 100.0 * (new / old - 1.0)));
        let [count, time] = [&counts, &times].map(|own| own.get(name).map_or(String::new(), f64::to_string));
        _ = writeln!(page, "| {name} | {count} | {} | {time} |", change.unwrap_or_default());
    }
    page
}

/// Size of the drawing, and the space around the curves.
const SIZE: [f64; 2] = [760.0, 300.0];
const MARGIN: [f64; 2] = [70.0, 45.0];

/// Curves: their numbers, names and colours, which the colour-blind distinguish.
const CURVES: [(&str, &str, &str); 2] = [(INSTRUCTIONS, "instructions", "#0072b2"), (TIME, "times", "#d55e00")];

fn drawing(history: &History) -> String {
    let curves = CURVES.map(|(beginning, ..)| ratios(history, beginning));
    let values = || curves.iter().flatten().flatten().copied();
    // Room for a tenth below the least and above the greatest.
    let [low, high] = [values().fold(1.0, f64::min) - 0.1, values().fold(1.0, f64::max) + 0.1];
    let [width, height] = [SIZE[0] - 2.0 * MARGIN[0], SIZE[1] - 2.0 * MARGIN[1]];
    let intervals = (history.rows.len().max(2) - 1) as f64;
    let x = |index: usize| MARGIN[0] + width * index as f64 / intervals;
    let y = |ratio: f64| MARGIN[1] + height * (high - ratio) / (high - low);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        SIZE[0], SIZE[1]
    );
    for ratio in [low, 1.0, high] {
        _ = writeln!(
            svg,
            "<path d=\"M{:.1} {at:.1}H{:.1}\" stroke=\"#cccccc\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{:.0} %</text>",
            MARGIN[0],
            SIZE[0] - MARGIN[0],
            MARGIN[0] - 8.0,
            y(ratio) + 4.0,
            100.0 * ratio,
            at = y(ratio)
        );
    }
    for (index, row) in history.rows.iter().enumerate() {
        let version = cell(row, "version");
        _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{version}</text>",
            x(index),
            SIZE[1] - 20.0
        );
    }
    for (place, ((_, name, colour), curve)) in CURVES.iter().zip(&curves).enumerate() {
        let points: Vec<[f64; 2]> =
            curve.iter().enumerate().filter_map(|(index, ratio)| Some([x(index), y((*ratio)?)])).collect();
        let path: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            path.join(" ")
        );
        for [x, y] in points {
            _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"/>");
        }
        let at = MARGIN[0] + 230.0 * place as f64;
        _ = writeln!(svg, "<text x=\"{at:.1}\" y=\"22\" fill=\"{colour}\">{name}, of the first row's</text>");
    }
    svg + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_and_curves_match_the_table() {
        let text = "version,date,commit,processor,compiler,instructions a.yaml,time a.yaml,time Exudyn 1.13.6: a.yaml\n\
                    0.1.0,2026-12-01,abc,CPU,rustc,200,,\n0.2.0,2027-01-02,def,CPU,rustc,220,31.5,630\n";
        let history = History::read(text).unwrap();
        let [(_, page), (_, svg)] = all(&history);
        assert!(page.contains("| 0.2.0 | 2027-01-02 | `def` | CPU | 110.0 % | 100.0 % |"), "{page}");
        assert!(page.contains("| a.yaml | 220 | +10.0 % | 31.5 |"), "{page}");
        let peer =
            "0.2.0: Exudyn 1.13.6: a.yaml takes 630 turns of the reference loop a step, 20 times those of mbint.";
        assert!(page.contains(peer), "{page}");
        // From 90 to 120 %: 100 % is two thirds down, 110 % one third, of 210 units from 45 on.
        assert!(svg.contains("<polyline points=\"70.0,185.0 690.0,115.0\" fill=\"none\" stroke=\"#0072b2\""), "{svg}");
        assert!(svg.contains("<polyline points=\"690.0,185.0\" fill=\"none\" stroke=\"#d55e00\""), "{svg}");
    }
}
