//! A chain of dimensions to scale: arrows one after another, and the closing dimension from the first face to the last.

use svg::node::element::{Group, Path, Title};

use crate::export::figure::axis::Axis;
use crate::export::figure::document::{Anchor, document, finished, group, heading, line, shortened, text, text_width};
use crate::export::figure::path::{Point, line_data, px};
use crate::export::figure::style::{Color, Hue};
use crate::export::rounded::shown;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{ChainSummary, LinkSummary};

/// Width on the page, px, and heights of an arrow's line and of the rest.
const WIDTH: f64 = 760.0;
const ROW: f64 = 26.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 22.0;

/// Length and half width of an arrow's head, px.
const HEAD: (f64, f64) = (9.0, 4.0);

/// The closing dimension's colour.
const CLOSING: usize = 3;

/// The drawing; lengths are shown in `unit`.
pub(super) fn chain_svg(model: &str, chain: &ChainSummary, unit: ShownUnit) -> String {
    let ends = ends(&chain.links);
    let scale = Axis::fit(ends.iter().copied().chain([0.0, chain.nominal]), unit, 5, 0.02, 0.0);
    let name = |link: &LinkSummary| shortened(&link.name, 28);
    let names = chain.links.iter().map(name).chain([shortened(&chain.output, 28)]);
    let left = names.map(|name| text_width(&name)).fold(40.0, f64::max) + 24.0;
    let labels: Vec<String> =
        chain.links.iter().map(|link| shown(unit, link.nominal)).chain([shown(unit, chain.nominal)]).collect();
    let right = WIDTH - labels.iter().map(|label| text_width(label)).fold(40.0, f64::max) - 20.0;
    let across = |length: f64| left + scale.place(length) * (right - left);
    let row = |index: usize| TOP + ROW * (index as f64 + 0.5);
    let last = chain.links.len();
    let mut faces = group("grid");
    let mut arrows = group("data");
    for (index, link) in chain.links.iter().enumerate() {
        let (from, to) = (across(ends[index]), across(ends[index + 1]));
        let hue = Hue::Color(Color::of(usize::from(!link.is_forward)));
        let title = format!("{}: from {} to {}, {}", link.name, link.from, link.to, labels[index]);
        arrows = arrows.add(arrow(hue, &title, (from, row(index)), to));
        arrows = arrows.add(text(&name(link), (left - 14.0, row(index)), Anchor::End));
        arrows = arrows.add(text(&labels[index], (right + 14.0, row(index)), Anchor::Start));
        // From an arrow's end to the beginning of the next one, the last one's to the closing dimension.
        faces = faces.add(line((to, row(index)), (to, row(index + 1))));
    }
    let start = across(0.0);
    let end = across(chain.nominal);
    faces = faces.add(line((start, row(0)), (start, row(last))));
    let closing = Hue::Color(Color::of(CLOSING));
    let title = format!("{}: {}", chain.output, labels[last]);
    arrows = arrows.add(arrow(closing, &title, (start, row(last)), end));
    arrows = arrows.add(text(&shortened(&chain.output, 28), (left - 14.0, row(last)), Anchor::End));
    arrows = arrows.add(text(&labels[last], (right + 14.0, row(last)), Anchor::Start));
    let title = format!("{}: chain of {}, to scale", shortened(model, 50), shortened(&chain.output, 50));
    let figure = document((WIDTH, row(last) + 0.5 * ROW + BOTTOM), &title)
        .add(heading(&title, (12.0, 16.0)))
        .add(faces)
        .add(arrows);
    finished(&figure)
}

/// The starts of the links, and the end of the last one: each is added with its sign.
fn ends(links: &[LinkSummary]) -> Vec<f64> {
    let mut ends = vec![0.0];
    for link in links {
        let before = ends[ends.len() - 1];
        ends.push(if link.is_forward { before + link.nominal } else { before - link.nominal });
    }
    ends
}

/// An arrow along a row.
fn arrow(hue: Hue, title: &str, from: Point, to: f64) -> Group {
    let direction = if to < from.0 { -1.0 } else { 1.0 };
    let length = HEAD.0.min((to - from.0).abs());
    let base = to - direction * length;
    let head = [(to, from.1), (base, from.1 - HEAD.1), (base, from.1 + HEAD.1)];
    let shaft = line(from, (base, from.1)).set("class", "line").set("stroke-width", px(2.0));
    let head = Path::new().set("class", "area").set("d", line_data(&head) + "z");
    hue.paint(group("arrow").add(Title::new(title)).add(shaft).add(head), "arrow")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(name: &str, is_forward: bool, nominal: f64) -> LinkSummary {
        LinkSummary { name: name.into(), from: "f".into(), to: "t".into(), is_forward, nominal }
    }

    fn chain() -> ChainSummary {
        let links = vec![link("a", true, 30e-3), link("b", false, 20e-3), link("c", false, 9e-3)];
        ChainSummary { output: "gap".into(), nominal: 1e-3, links }
    }

    #[test]
    fn ends_of_links_are_signed_partial_sums() {
        let ends = ends(&chain().links);
        let wanted = [0.0, 30e-3, 10e-3, 1e-3];
        assert!(ends.iter().zip(wanted).all(|(end, wanted)| (end - wanted).abs() < 1e-15), "{ends:?}");
    }

    /// Lengths on the page are proportional to the dimensions.
    #[test]
    fn arrows_are_to_scale() {
        let svg = chain_svg("m", &chain(), ShownUnit { text: "mm", si: 1e-3 });
        let document = roxmltree::Document::parse(&svg).unwrap();
        let arrows: Vec<f64> = document
            .descendants()
            .filter(|node| node.attribute("class").is_some_and(|class| class.starts_with("arrow")))
            .map(|arrow| {
                let shaft = arrow.children().find(|node| node.has_tag_name("line")).unwrap();
                let head = arrow.children().find(|node| node.has_tag_name("path")).unwrap();
                let from: f64 = shaft.attribute("x1").unwrap().parse().unwrap();
                let tip = head.attribute("d").unwrap().trim_start_matches('M');
                let tip: f64 = tip.split([',', ' ']).next().unwrap().parse().unwrap();
                tip - from
            })
            .collect();
        assert_eq!(arrows.len(), 4);
        for (arrow, length) in arrows.iter().zip([30.0, -20.0, -9.0, 1.0]) {
            assert!((arrow / arrows[0] - length / 30.0).abs() < 2e-3, "{arrows:?}");
        }
        assert!(svg.contains("\n30 mm\n") && svg.contains("\n1 mm\n"), "{svg}");
    }
}
