//! Common parts of all figures: a document with a title, a style for light and dark readers, text, and the data as
//! JSON.

use serde::Serialize;
use svg::Document;
use svg::node::Text as Characters;
use svg::node::element::{Element, Group, Line, Rectangle, Style, Text, Title};

use super::path::{Point, px};
use super::style::STYLE;

/// Size of text, px.
pub const TEXT: f64 = 13.0;

/// Position of a text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text begins there.
    Start,
    /// The middle of the text is there.
    Middle,
    /// The text ends there.
    End,
}

/// A figure without contents: its size in px, and its title.
pub fn document(size: (f64, f64), title: &str) -> Document {
    Document::new()
        .set("class", "mbint-figure")
        .set("viewBox", (0, 0, px(size.0), px(size.1)))
        .set("width", px(size.0))
        .set("height", px(size.1))
        .set("role", "img")
        .add(Title::new(title))
        .add(Style::new(STYLE))
        .add(Rectangle::new().set("class", "paper").set("width", px(size.0)).set("height", px(size.1)))
}

/// The data of a figure, for the scripts that show it.
pub fn metadata(data: &impl Serialize) -> Result<Element, serde_json::Error> {
    let mut element = Element::new("metadata");
    svg::Node::append(&mut element, Characters::new(serde_json::to_string(data)?));
    Ok(element)
}

/// The text of the figure's file.
pub fn finished(document: &Document) -> String {
    document.to_string() + "\n"
}

/// A line of text, in the middle of its height at a point.
pub fn text(content: &str, (x, y): Point, anchor: Anchor) -> Text {
    let text = Text::new(content).set("x", px(x)).set("y", px(y + 0.35 * TEXT));
    match anchor {
        Anchor::Start => text,
        Anchor::Middle => text.set("text-anchor", "middle"),
        Anchor::End => text.set("text-anchor", "end"),
    }
}

/// A line of text that is read upwards.
pub fn upright(content: &str, (x, y): Point) -> Text {
    let turn = format!("rotate(-90 {} {})", px(x), px(y));
    text(content, (x, y), Anchor::Middle).set("transform", turn)
}

/// Heading of a figure.
pub fn heading(content: &str, at: Point) -> Text {
    text(content, at, Anchor::Start).set("class", "heading")
}

/// A straight line.
pub fn line(from: Point, to: Point) -> Line {
    Line::new().set("x1", px(from.0)).set("y1", px(from.1)).set("x2", px(to.0)).set("y2", px(to.1))
}

/// A group of a class.
pub fn group(class: &str) -> Group {
    Group::new().set("class", class)
}

/// About the width of a text, px; a digit is 0.56 to 0.64 of the text's size in sans-serif fonts.
pub fn text_width(text: &str) -> f64 {
    0.58 * TEXT * text.chars().count() as f64
}

/// A text cut to at most `most` characters.
pub fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        text.to_owned()
    } else {
        text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
    }
}
