//! A histogram of a stack's samples, with the worst case and the limits of requirements.

use svg::node::element::{Group, Rectangle, Title};

use crate::export::figure::axis::Axis;
use crate::export::figure::document::{Anchor, document, finished, group, heading, line, shortened, text};
use crate::export::figure::panel::Panel;
use crate::export::figure::path::px;
use crate::export::figure::style::{Color, Hue};
use crate::export::rounded::shown;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Histogram, LimitLine, OutputStatisticsSummary, Summary};

/// Size on the page, px, and free space on each side.
const SIZE: (f64, f64) = (760.0, 340.0);
const LEFT: f64 = 74.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 60.0;
const BOTTOM: f64 = 50.0;

/// The drawing.
pub(super) fn histogram_svg(summary: &Summary, output: &OutputStatisticsSummary, found: &Histogram) -> String {
    let unit = ShownUnit::of(&output.display, &output.unit);
    let limits: Vec<&LimitLine> = summary
        .requirements
        .iter()
        .flat_map(|own| &own.limits)
        .filter(|line| line.output == output.output && line.value.is_finite())
        .collect();
    let ends = [found.lower, found.upper].into_iter().chain(output.worst_case);
    let x = Axis::fit(ends.chain(limits.iter().map(|line| line.value)), unit, 8, 0.03, 0.0);
    let most = found.shares.iter().copied().fold(0.0, f64::max);
    let y = Axis::fit([0.0, most].into_iter(), ShownUnit { text: "%", si: 0.01 }, 5, 0.0, 0.0);
    let id = "stack-histogram".to_owned();
    let panel = Panel { id, left: LEFT, right: SIZE.0 - RIGHT, top: TOP, bottom: SIZE.1 - BOTTOM, x: &x, y: &y };
    let width = (found.upper - found.lower) / found.shares.len() as f64;
    let bar = |bars: Group, (index, share): (usize, &f64)| {
        let begin = found.lower + width * index as f64;
        let [from, to] = [panel.place(begin, *share), panel.place(begin + width, 0.0)];
        let area = Rectangle::new().set("class", "layer").set("x", px(from.0)).set("y", px(from.1));
        bars.add(area.set("width", px(to.0 - from.0)).set("height", px(to.1 - from.1)))
    };
    let bars = found.shares.iter().enumerate().fold(group("bars"), bar);
    let upright = |value: f64, class: &str, title: String| {
        let across = panel.place(value, 0.0).0;
        group("mark").add(Title::new(title)).add(line((across, TOP), (across, panel.bottom)).set("class", class))
    };
    let worst = output.worst_case.map(|end| upright(end, "frame", format!("worst case: {}", shown(unit, end))));
    let limits = limits.iter().map(|line| upright(line.value, "limit", format!("limit: {}", shown(unit, line.value))));
    let series = [Hue::Color(Color::of(0)).paint(bars, "bars")].into_iter().chain(worst).chain(limits);
    let name = shortened(&output.output, 50);
    let title = format!("{}: {name}, worst case and limits", shortened(&summary.model, 50));
    let figure = document(SIZE, &title)
        .add(heading(&title, (12.0, 16.0)))
        .add(text(&in_words(summary, output), (12.0, 38.0), Anchor::Start))
        .add(panel.framed(&name, &y.title("share of the samples"), series))
        .add(panel.time_axis(&name));
    finished(&figure)
}

/// Worst case, and the capability of the requirement that limits the output, if there is one.
fn in_words(summary: &Summary, output: &OutputStatisticsSummary) -> String {
    let unit = ShownUnit::of(&output.display, &output.unit);
    let [lower, upper] = output.worst_case.map(|end| shown(unit, end));
    let limits = |name: &str| {
        let own = summary.requirements.iter().find(|own| own.name == name);
        own.is_some_and(|own| own.limits.iter().any(|line| line.output == output.output))
    };
    let yields = summary.statistics.iter().flat_map(|found| &found.summary.requirements);
    let of_limits: String = yields
        .filter(|own| limits(&own.requirement))
        .map(|own| {
            let number =
                |name: &str, value: Option<f64>| value.map_or_else(String::new, |value| format!(", {name} {value:.2}"));
            format!("; {}: {:.3} ppm fail{}{}", own.requirement, own.ppm, number("Cp", own.cp), number("Cpk", own.cpk))
        })
        .collect();
    shortened(&format!("worst case {lower} to {upper}{of_limits}"), 110)
}
