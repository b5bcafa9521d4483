//! Parts of figures: scales, paths, legends, colours, and the document with its data. All are deterministic.

pub mod axis;
pub mod data;
pub mod document;
pub mod legend;
pub mod log_axis;
pub mod panel;
pub mod path;
pub mod prefix;
pub mod style;
pub mod view;

/// Identity of a figure: its name, and the prefix of its ids.
#[derive(Clone, Copy, Debug)]
pub struct Caption<'a> {
    /// The model's name.
    pub model: &'a str,
    /// Prefix of all ids of the figure: letters, digits and `-`, a letter first; unique in the page.
    pub prefix: &'a str,
}
