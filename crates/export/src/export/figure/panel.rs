//! A panel of a figure: axes, curves, and bands with their errors.
//!
//! A lighter band around each band shows its error; unreliable parts of a band are hatched.

use svg::node::element::{Circle, ClipPath, Group, Path, Pattern, Rectangle, Title};

use super::axis::Axis;
use super::data::{PanelData, ScaleData};
use super::document::{Anchor, group, line, text, text_width, upright};
use super::path::{Point, line_data, px, runs, thinned};
use super::style::{Color, Hue};
use crate::export::tuning::TUNING;
use crate::results::Band;

/// Opacity of the error around a band, relative to the band's own.
const LIGHTER: f64 = 0.5;
/// Distance of the lines of a hatched band, px.
const HATCH: f64 = 6.0;

/// Style of a band.
#[derive(Clone, Debug)]
pub struct Style {
    /// Label in the legend.
    pub label: String,
    /// Colour of edges and areas.
    pub color: Color,
    /// Width of the edges, px.
    pub edge: f64,
    /// Opacity of the band; 0 if only its edges are drawn, without error.
    pub fill: f64,
    /// Lengths of dash and gap, px.
    pub dashes: Option<Vec<f64>>,
    /// Slant of the hatching, degrees.
    pub slant: f64,
}

impl Style {
    /// The dashes in the notation of SVG.
    pub fn dasharray(&self) -> Option<String> {
        let dashes = self.dashes.as_ref()?;
        Some(dashes.iter().map(f64::to_string).collect::<Vec<_>>().join(" "))
    }
}

/// A rectangle of the figure with its axes; lengths in px.
#[derive(Clone)]
pub struct Panel<'a> {
    /// Identifier, unique in the page.
    pub id: String,
    /// Left edge.
    pub left: f64,
    /// Right edge.
    pub right: f64,
    /// Upper edge.
    pub top: f64,
    /// Lower edge.
    pub bottom: f64,
    /// Axis of the time.
    pub x: &'a Axis,
    /// Axis of the values.
    pub y: &'a Axis,
}

/// A drawing in a panel: its name in the figure's data, and the key of its group.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    /// Identifier of the series.
    pub id: &'a str,
    /// Key of its group in all panels.
    pub group: &'a str,
    /// Title for people.
    pub title: &'a str,
}

impl Panel<'_> {
    /// The panel's group around its drawings.
    pub fn framed(&self, title: &str, y_title: &str, series: impl IntoIterator<Item = Group>) -> Group {
        let clip = format!("{}-clip", self.id);
        let (x, y, width, height) = (px(self.left), px(self.top), self.right - self.left, self.bottom - self.top);
        let rectangle = || Rectangle::new().set("x", x).set("y", y).set("width", px(width)).set("height", px(height));
        let inside = group("data").set("clip-path", format!("url(#{clip})"));
        let mut whole = group("panel")
            .set("data-panel", self.id.clone())
            .add(Title::new(title))
            .add(ClipPath::new().set("id", clip).add(rectangle()))
            .add(self.grid())
            .add(series.into_iter().fold(inside, Group::add))
            .add(rectangle().set("class", "frame"))
            .add(self.values())
            .add(upright(y_title, (14.0, 0.5 * (self.top + self.bottom))));
        if self.y.is_constant {
            whole = whole.add(text("constant", (self.right - 8.0, self.top + 14.0), Anchor::End));
        }
        whole
    }

    fn grid(&self) -> Group {
        let across = self.x.ticks().into_iter().map(|(at, _)| {
            let x = self.left + at * (self.right - self.left);
            line((x, self.top), (x, self.bottom))
        });
        let up = self.y.ticks().into_iter().map(|(at, _)| {
            let y = self.bottom - at * (self.bottom - self.top);
            line((self.left, y), (self.right, y))
        });
        across.chain(up).fold(group("grid"), Group::add)
    }

    /// Ticks and labels of the values.
    fn values(&self) -> Group {
        self.y.ticks().into_iter().fold(group("axis"), |group, (at, label)| {
            let y = self.bottom - at * (self.bottom - self.top);
            group.add(line((self.left - 4.0, y), (self.left, y)).set("class", "frame")).add(text(
                &label,
                (self.left - 7.0, y),
                Anchor::End,
            ))
        })
    }

    /// Ticks, labels and title of the time axis, below the panel.
    pub fn time_axis(&self, title: &str) -> Group {
        let ticks = self.x.ticks().into_iter().fold(group("axis"), |group, (at, label)| {
            let x = self.left + at * (self.right - self.left);
            group.add(line((x, self.bottom), (x, self.bottom + 4.0)).set("class", "frame")).add(text(
                &label,
                (x, self.bottom + 15.0),
                Anchor::Middle,
            ))
        });
        let middle = 0.5 * (self.left + self.right);
        ticks.add(text(&self.x.title(title), (middle, self.bottom + 35.0), Anchor::Middle))
    }

    /// A curve.
    pub fn curve(&self, named: Named, times: &[f64], values: &[f64], hue: Hue, width: f64) -> Group {
        runs([times, values]).into_iter().fold(hue.paint(series(named), "series"), |group, rows| {
            let points: Vec<Point> = rows.map(|row| self.place(times[row], values[row])).collect();
            match points[..] {
                [only] => group.add(dot(only, 0.8 * width + 0.7)),
                _ => group.add(
                    Path::new()
                        .set("class", "line")
                        .set("d", line_data(&thinned(points.into_iter())))
                        .set("stroke-width", width),
                ),
            }
        })
    }

    /// A band's error: the area between its sides moved outwards.
    pub fn error(&self, named: Named, times: &[f64], band: &Band, style: &Style) -> Group {
        let apart = |side: &[f64], sign: f64| -> Vec<f64> {
            side.iter().zip(&band.error.total).map(|(bound, error)| bound + sign * error).collect()
        };
        let (lower, upper) = (apart(&band.lower, -1.0), apart(&band.upper, 1.0));
        self.areas(named, times, [&lower, &upper], style.color, "area", rounded(LIGHTER * style.fill))
    }

    /// A layer of a stack: the area between two curves.
    pub fn layer(&self, named: Named, times: &[f64], sides: [&[f64]; 2], color: Color) -> Group {
        self.areas(named, times, sides, color, "layer", 1.0)
    }

    fn areas(&self, named: Named, times: &[f64], sides: [&[f64]; 2], color: Color, class: &str, opacity: f64) -> Group {
        let pieces = runs([times, sides[0], sides[1]]).into_iter().filter(|rows| rows.len() > 1);
        pieces.fold(Hue::Color(color).paint(series(named), "series"), |group, rows| {
            let outline = self.outline(times, sides, rows) + "z";
            group.add(Path::new().set("class", class).set("d", outline).set("fill-opacity", opacity))
        })
    }

    /// A band, hatched where it is unreliable.
    pub fn band(&self, named: Named, times: &[f64], band: &Band, style: &Style) -> Group {
        let sides: [&[f64]; 2] = [&band.lower, &band.upper];
        let mut group = Hue::Color(style.color).paint(series(named), "series");
        for rows in runs([times, sides[0], sides[1]]) {
            if rows.len() == 1 {
                let ends = sides.map(|side| self.place(times[rows.start], side[rows.start]));
                group = ends.into_iter().fold(group, |group, end| group.add(dot(end, 0.8 * style.edge + 0.7)));
                continue;
            }
            let outline = Path::new()
                .set("class", "band")
                .set("d", self.outline(times, sides, rows.clone()) + "z")
                .set("fill-opacity", rounded(style.fill))
                .set("stroke-width", style.edge);
            group = group.add(match style.dasharray() {
                Some(dashes) => outline.set("stroke-dasharray", dashes),
                None => outline,
            });
            group = self.hatched(group, named, times, band, style, rows);
        }
        group
    }

    /// Hatching of the unreliable parts of a run of rows.
    fn hatched(
        &self,
        group: Group,
        named: Named,
        times: &[f64],
        band: &Band,
        style: &Style,
        rows: std::ops::Range<usize>,
    ) -> Group {
        let parts = self.unreliable(times, &band.error.unresolved, rows);
        let Some(first) = parts.first() else { return group };
        let id = format!("{}-hatch-{}", named.id, first.start);
        let pattern = Pattern::new()
            .set("id", id.clone())
            .set("width", HATCH)
            .set("height", HATCH)
            .set("patternUnits", "userSpaceOnUse")
            .set("patternTransform", format!("rotate({})", style.slant))
            .add(line((0.5 * HATCH, 0.0), (0.5 * HATCH, HATCH)).set("class", "line").set("stroke-width", 1.5));
        let data: String =
            parts.into_iter().map(|rows| self.outline(times, [&band.lower, &band.upper], rows) + "z").collect();
        group.add(pattern).add(Path::new().set("class", "hatch").set("d", data).set("fill", format!("url(#{id})")))
    }

    /// Unreliable parts of a run, wide enough to be seen.
    fn unreliable(
        &self,
        times: &[f64],
        unresolved: &[bool],
        rows: std::ops::Range<usize>,
    ) -> Vec<std::ops::Range<usize>> {
        let across = |row: usize| self.place(times[row], 0.0).0;
        let mut parts: Vec<std::ops::Range<usize>> = Vec::new();
        for row in rows.clone().filter(|&row| unresolved[row]) {
            // To the next row, and farther if that is near.
            let mut end = row + 1;
            while end + 1 < rows.end && across(end) - across(row) < TUNING.narrowest_hatched {
                end += 1;
            }
            let end = (end + 1).min(rows.end);
            match parts.last_mut() {
                Some(last) if row <= last.end => last.end = end.max(last.end),
                _ => parts.push(row..end),
            }
        }
        parts
    }

    /// The outline of the area between two curves.
    fn outline(&self, times: &[f64], [lower, upper]: [&[f64]; 2], rows: std::ops::Range<usize>) -> String {
        let side = |side: &[f64]| thinned(rows.clone().map(|row| self.place(times[row], side[row])));
        let mut outline = side(upper);
        outline.extend(side(lower).into_iter().rev());
        line_data(&outline)
    }

    /// Position on the page of a point of the data; points far beyond the panel are moved nearer.
    pub fn place(&self, t: f64, y: f64) -> Point {
        let across = self.left + self.x.place(t) * (self.right - self.left);
        let up = self.y.place(y).clamp(-TUNING.beyond_panel, 1.0 + TUNING.beyond_panel);
        (across, self.bottom - up * (self.bottom - self.top))
    }

    /// The scales, for the scripts that show the figure.
    pub fn data(&self) -> PanelData {
        let seconds = self.x.unit.factor;
        PanelData {
            id: self.id.clone(),
            unit: self.y.unit.text.clone(),
            si: self.y.unit.factor,
            x: ScaleData {
                min: self.x.min * seconds,
                max: self.x.max * seconds,
                from_px: px(self.left),
                to_px: px(self.right),
            },
            y: ScaleData { min: self.y.min, max: self.y.max, from_px: px(self.bottom), to_px: px(self.top) },
        }
    }
}

/// The group of a series.
fn series(named: Named) -> Group {
    Group::new().set("data-series", named.id).set("data-group", named.group).add(Title::new(named.title))
}

fn dot(at: Point, radius: f64) -> Circle {
    Circle::new().set("class", "area").set("cx", px(at.0)).set("cy", px(at.1)).set("r", px(radius))
}

/// An opacity with three decimals.
fn rounded(opacity: f64) -> f64 {
    (1e3 * opacity).round() / 1e3
}

/// Width of an axis' widest label, px.
pub fn label_width(axis: &Axis) -> f64 {
    axis.ticks().iter().map(|(_, label)| text_width(label)).fold(0.0, f64::max)
}
