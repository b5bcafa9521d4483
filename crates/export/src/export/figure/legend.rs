//! Legends: rows of entries above the panels, clear of the data.

use svg::node::element::{Group, Path, Title};

use super::document::{Anchor, group, line, text, text_width};
use super::panel::Style;
use super::path::{Point, line_data};
use super::style::Hue;

/// Distance from one row to the next, px.
pub const ROW: f64 = 20.0;

/// Width of an entry's sign, px.
const SIGN: f64 = 26.0;

/// An entry.
pub struct Entry {
    /// Key of its group, as in the series.
    pub group: String,
    /// Label for people.
    pub label: String,
    /// Its sign.
    pub sign: Sign,
}

/// Sign of an entry.
pub enum Sign {
    /// A line.
    Line(Hue),
    /// A band.
    Band(Style),
    /// A filled square.
    Area(Hue),
    /// A limit.
    Limit,
}

/// Entries in rows of a width, px.
pub struct Legend(Vec<Vec<Entry>>);

impl Legend {
    /// Arranges entries in rows, each with as many as fit into a width, px.
    pub fn new(entries: Vec<Entry>, width: f64) -> Self {
        let mut rows: Vec<Vec<Entry>> = vec![Vec::new()];
        let mut x = 0.0;
        for entry in entries {
            let step = entry.step();
            if x > 0.0 && x + step > width {
                rows.push(Vec::new());
                x = 0.0;
            }
            x += step;
            if let Some(row) = rows.last_mut() {
                row.push(entry);
            }
        }
        Self(rows)
    }

    /// Height of the rows after the first, px.
    pub fn more(&self) -> f64 {
        ROW * self.0.len().saturating_sub(1) as f64
    }

    /// The entries, beginning at a point.
    pub fn drawn(&self, (left, top): Point) -> Group {
        let mut legend = group("legend");
        for (row, entries) in self.0.iter().enumerate() {
            let (mut x, y) = (left, top + ROW * row as f64);
            for entry in entries {
                legend = legend.add(entry.drawn((x, y)));
                x += entry.step();
            }
        }
        legend
    }
}

impl Entry {
    /// Distance from its left end to the next entry's, px.
    fn step(&self) -> f64 {
        SIGN + 7.0 + text_width(&self.label) + 22.0
    }

    /// The entry, its left end at a point.
    pub fn drawn(&self, (x, y): Point) -> Group {
        let key = Group::new().set("data-group", self.group.clone()).add(Title::new(self.label.clone()));
        let label = text(&self.label, (x + SIGN + 7.0, y), Anchor::Start);
        let rectangle = |half: f64, right: f64| {
            line_data(&[(x, y - half), (right, y - half), (right, y + half), (x, y + half)]) + "z"
        };
        match &self.sign {
            Sign::Line(hue) => {
                hue.paint(key, "key").add(line((x, y), (x + SIGN, y)).set("class", "line").set("stroke-width", 1.4))
            }
            Sign::Band(style) => {
                let sign = Path::new()
                    .set("class", "band")
                    .set("d", rectangle(6.0, x + SIGN))
                    .set("fill-opacity", style.fill)
                    .set("stroke-width", style.edge);
                let sign = match style.dasharray() {
                    Some(dashes) => sign.set("stroke-dasharray", dashes),
                    None => sign,
                };
                Hue::Color(style.color).paint(key, "key").add(sign)
            }
            Sign::Limit => key.set("class", "key").add(line((x, y), (x + SIGN, y)).set("class", "limit")),
            Sign::Area(hue) => {
                hue.paint(key, "key").add(Path::new().set("class", "area").set("d", rectangle(6.5, x + SIGN)))
            }
        }
        .add(label)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_wrap_into_rows() {
        let entry = |label: &str| Entry { group: "g".into(), label: label.into(), sign: Sign::Line(Hue::Ink) };
        let legend = Legend::new((0..9).map(|index| entry(&format!("scene {index}"))).collect(), 400.0);
        assert_eq!(legend.0.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3, 3]);
        assert_eq!(legend.more(), 2.0 * ROW);
        assert_eq!(Legend::new(vec![], 400.0).more(), 0.0);
    }
}
