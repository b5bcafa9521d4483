//! Tornado plots: a bar for each parameter, by its influence on an output.

use svg::node::element::{Rectangle, Title};

use super::figure::axis::Axis;
use super::figure::document::{Anchor, document, finished, group, heading, line, shortened, text, text_width};
use super::figure::panel::Panel;
use super::figure::path::px;
use super::figure::style::{Color, Hue};
use super::rounded::{rounded, significant};
use super::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;

/// Width on the page, px, heights of a bar, and of the space above and below all.
const WIDTH: f64 = 760.0;
const BAR: f64 = 22.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 50.0;

/// A parameter's bar.
pub(super) struct Bar {
    /// The parameter.
    name: String,
    /// Its derivative with unit.
    label: String,
    /// Length and direction of the bar, SI.
    influence: f64,
}

impl Bar {
    /// The bar of a parameter, with its derivative in shown units and its influence in SI.
    pub fn new(name: &str, derivative: (f64, &str), influence: f64) -> Self {
        let label = format!("{} {}", rounded(significant(derivative.0, 4)), derivative.1).trim_end().to_owned();
        Self { name: name.to_owned(), label, influence }
    }
}

/// A derivative (SI) and its unit, a quotient of shown units.
pub fn derivative_in(above: ShownUnit, below: ShownUnit, by: f64) -> (f64, String) {
    let unit = match (above.text, below.text) {
        ("", "") => String::new(),
        (above, "") => above.to_owned(),
        ("", below) => format!("1/{}", bracketed(below)),
        (above, below) => format!("{above}/{}", bracketed(below)),
    };
    (by / above.si * below.si, unit)
}

/// A unit as a denominator, in parentheses if it is composed.
fn bracketed(unit: &str) -> String {
    if unit.contains(['*', '/', ' ']) { format!("({unit})") } else { unit.to_owned() }
}

/// The bars, the largest first, as an SVG document; `across` names their quantity and its unit.
pub(super) fn tornado(prefix: &str, title: &str, across: (&str, ShownUnit), bars: &[Bar]) -> String {
    let bars = &bars[..bars.len().min(TUNING.most_bars)];
    let most = bars.iter().fold(0.0_f64, |most, bar| most.max(bar.influence.abs()));
    let x = Axis::fit([-most, most].into_iter(), across.1, 7, 0.04, 0.0);
    let y = Axis::fit([0.0, 1.0].into_iter(), "", 2, 0.0, 0.0);
    let name = |bar: &Bar| shortened(&bar.name, 30);
    let left = bars.iter().map(|bar| text_width(&name(bar))).fold(40.0, f64::max) + 20.0;
    let right = bars.iter().map(|bar| text_width(&bar.label)).fold(40.0, f64::max) + 20.0;
    let bottom = TOP + BAR * bars.len().max(1) as f64;
    let id = format!("{prefix}-tornado");
    let panel = Panel { id, left, right: WIDTH - right, top: TOP, bottom, x: &x, y: &y };
    let at = |influence: f64| panel.place(influence, 0.0).0;
    let mut drawn = group("data");
    for (index, bar) in bars.iter().enumerate() {
        let middle = TOP + BAR * (index as f64 + 0.5);
        let (from, to) = (at(0.0).min(at(bar.influence)), at(0.0).max(at(bar.influence)));
        let area = Rectangle::new()
            .set("class", "area")
            .set("x", px(from))
            .set("y", px(middle - 0.36 * BAR))
            .set("width", px(to - from))
            .set("height", px(0.72 * BAR));
        let hue = Hue::Color(Color::of(usize::from(bar.influence < 0.0)));
        let title = format!("{}: {}", bar.name, bar.label);
        drawn = drawn.add(hue.paint(group("bar").add(Title::new(title)).add(area), "bar"));
        drawn = drawn.add(text(&name(bar), (left - 8.0, middle), Anchor::End));
        drawn = drawn.add(text(&bar.label, (WIDTH - right + 8.0, middle), Anchor::Start));
    }
    let figure = document((WIDTH, bottom + BOTTOM), title)
        .add(heading(title, (12.0, 16.0)))
        .add(drawn)
        .add(line((at(0.0), TOP), (at(0.0), bottom)).set("class", "frame"))
        .add(group("across").add(panel.time_axis(across.0)));
    finished(&figure)
}
