//! Aligned columns.

use super::marks::BOLD;

/// Alignment of a column's cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// To the left: texts.
    Left,
    /// To the right: numbers.
    Right,
}

/// Rows of `N` cells under headings.
pub struct Table<const N: usize> {
    headings: [(&'static str, Align); N],
    rows: Vec<[String; N]>,
}

impl<const N: usize> Table<N> {
    /// A table without rows.
    pub fn new(headings: [(&'static str, Align); N]) -> Self {
        Self { headings, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: [String; N]) {
        self.rows.push(cells);
    }

    /// Lines, indented, two spaces between columns, no trailing spaces. Headings are bold; if all are empty, there is
    /// no line for them.
    pub fn render(&self, indent: usize) -> String {
        let widths: [usize; N] = std::array::from_fn(|i| {
            let cells = self.rows.iter().map(|row| row[i].chars().count());
            cells.chain([self.headings[i].0.chars().count()]).max().unwrap_or(0)
        });
        let line = |cells: [&str; N]| {
            let mut text = " ".repeat(indent);
            for (i, (cell, width)) in cells.into_iter().zip(widths).enumerate() {
                if i > 0 {
                    text += "  ";
                }
                text += &match self.headings[i].1 {
                    Align::Left => format!("{cell:width$}"),
                    Align::Right => format!("{cell:>width$}"),
                };
            }
            text.truncate(text.trim_end().len());
            text
        };
        let mut text = String::new();
        if self.headings.iter().any(|(heading, _)| !heading.is_empty()) {
            text += &format!("{BOLD}{}{BOLD:#}\n", line(self.headings.map(|(heading, _)| heading)));
        }
        for row in &self.rows {
            text += &line(std::array::from_fn(|i| row[i].as_str()));
            text.push('\n');
        }
        text
    }
}
