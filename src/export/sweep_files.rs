//! A sweep's files: `sweep.csv`, and a plot of each reduced output's bounds over the swept parameter.

use std::path::{Path, PathBuf};

use svg::Document;
use svg::node::element::{Group, Line, Path as Curve, Polygon, Rectangle, Text, Title};

use super::csv::number;
use super::error::ExportError;
use super::folder::AtomicFiles;
use super::stems::unique_stems;
use crate::results::{ReducedBand, ReducedSummary, RequirementSummary, Summary, foremost};

/// A parameter that is swept.
pub struct SweepAxis {
    pub name: String,
    /// As the command line gives it; empty for the model's own.
    pub unit: String,
    pub values: Vec<f64>,
}

/// What was found of one value of each.
pub struct SweepPoint {
    pub values: Vec<f64>,
    /// Absent where the run failed.
    pub summary: Option<Summary>,
}

/// A sweep; the last axis runs fastest.
pub struct Sweep {
    pub model: String,
    pub axes: Vec<SweepAxis>,
    pub points: Vec<SweepPoint>,
}

impl Sweep {
    /// Simulations of all runs.
    pub fn simulations(&self) -> usize {
        let all = self.points.iter().filter_map(|point| point.summary.as_ref());
        all.flat_map(|summary| &summary.methods).map(|method| method.simulations).sum()
    }

    /// The first run that did not fail.
    fn first(&self) -> Option<&Summary> {
        self.points.iter().find_map(|point| point.summary.as_ref())
    }
}

/// Writes `sweep.csv` and `sweep.NAME.svg` of each reduced output.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_sweep(dir: &Path, sweep: &Sweep) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("sweep.csv", &table(sweep)?)?;
    let reduced = sweep.first().map_or(&[][..], |summary| &summary.reduced);
    let stems = unique_stems(reduced.iter().map(|own| own.name.as_str()));
    for (place, stem) in stems.iter().enumerate() {
        files.add(&format!("sweep.{stem}.svg"), plot(sweep, place).as_bytes())?;
    }
    files.put_in_place()
}

/// Columns: the parameters; of each reduced output nominal, lower, upper, error and method; of each requirement margin, error and
/// verdict.
fn table(sweep: &Sweep) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let mut headings: Vec<String> = sweep.axes.iter().map(|axis| axis.name.clone()).collect();
    let (reduced, requirements) =
        sweep.first().map_or((&[][..], &[][..]), |first| (&first.reduced[..], &first.requirements[..]));
    for own in reduced {
        headings
            .extend(["nominal", "lower", "upper", "error", "method"].map(|column| format!("{}.{column}", own.name)));
    }
    for own in requirements {
        headings.extend(["margin", "error", "verdict"].map(|column| format!("{}.{column}", own.name)));
    }
    writer.write_record(&headings)?;
    for point in &sweep.points {
        let mut row: Vec<String> = point.values.iter().map(|&value| number(value)).collect();
        match &point.summary {
            Some(summary) => {
                summary.reduced.iter().for_each(|own| row.extend(of_reduced(own)));
                summary.requirements.iter().for_each(|own| row.extend(of_requirement(own)));
            }
            None => row.resize(headings.len(), "NaN".to_owned()),
        }
        writer.write_record(&row)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

fn foremost_of(own: &ReducedSummary) -> Option<&ReducedBand> {
    foremost(&own.bands, |band: &ReducedBand| !band.unresolved)
}

fn of_reduced(own: &ReducedSummary) -> [String; 5] {
    let band = foremost_of(own);
    let [lower, upper, error] = band.map_or([f64::NAN; 3], |band| [band.lower, band.upper, band.error]).map(number);
    [number(own.nominal), lower, upper, error, band.map_or_else(String::new, |band| band.method.clone())]
}

fn of_requirement(own: &RequirementSummary) -> [String; 3] {
    [number(own.margin), number(own.error), own.verdict.name().to_owned()]
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 420.0;
const LEFT: f64 = 86.0;
const RIGHT: f64 = 150.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 56.0;
const TICKS: usize = 5;

/// Colours for every colour vision: those of Okabe and Ito.
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555"];

/// A value of a reduced output at a value of the first parameter: that, lower, upper, nominal.
type Place = [f64; 4];

/// Bounds of one reduced output over the first parameter, for each value of the second one.
fn plot(sweep: &Sweep, reduced: usize) -> String {
    let inner = sweep.axes.get(1).map_or(1, |axis| axis.values.len());
    let mut series: Vec<Vec<Place>> = vec![Vec::new(); inner];
    let mut name = (String::new(), String::new());
    for (place, point) in sweep.points.iter().enumerate() {
        let Some(own) = point.summary.as_ref().and_then(|summary| summary.reduced.get(reduced)) else { continue };
        name = (own.name.clone(), own.unit.clone());
        let [lower, upper] = foremost_of(own).map_or([f64::NAN; 2], |band| [band.lower, band.upper]);
        if lower.is_finite() && upper.is_finite() {
            series[place % inner].push([point.values[0], lower, upper, own.nominal]);
        }
    }
    let extent = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if low < high {
            (low, high)
        } else if low == high {
            (low - 0.5, high + 0.5)
        } else {
            (0.0, 1.0)
        }
    };
    let x = extent(&mut series.iter().flatten().map(|place| place[0]));
    let y = extent(&mut series.iter().flatten().flat_map(|place| [place[1], place[2]]));
    let at_x = |value: f64| LEFT + (value - x.0) / (x.1 - x.0) * (WIDTH - LEFT - RIGHT);
    let at_y = |value: f64| HEIGHT - BOTTOM - (value - y.0) / (y.1 - y.0) * (HEIGHT - TOP - BOTTOM);
    let unit = |unit: &str| if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    let axis = &sweep.axes[0];
    let mut document = Document::new()
        .set("viewBox", (0, 0, WIDTH as i32, HEIGHT as i32))
        .set("font-family", "sans-serif")
        .set("font-size", 13)
        .add(Rectangle::new().set("width", WIDTH).set("height", HEIGHT).set("fill", "white"))
        .add(label((LEFT, 20.0), "start", &format!("{}: {}", sweep.model, name.0)))
        .add(label(
            (0.5 * (LEFT + WIDTH - RIGHT), HEIGHT - 14.0),
            "middle",
            &format!("{}{}", axis.name, unit(&axis.unit)),
        ))
        .add(label((8.0, TOP - 14.0), "start", &unit(&name.1)));
    for tick in 0..=TICKS {
        let share = tick as f64 / TICKS as f64;
        let (own_x, own_y) = (x.0 + share * (x.1 - x.0), y.0 + share * (y.1 - y.0));
        document = document
            .add(line((at_x(own_x), TOP), (at_x(own_x), HEIGHT - BOTTOM)))
            .add(line((LEFT, at_y(own_y)), (WIDTH - RIGHT, at_y(own_y))))
            .add(label((at_x(own_x), HEIGHT - BOTTOM + 18.0), "middle", &tick_text(own_x, x.1 - x.0)))
            .add(label((LEFT - 8.0, at_y(own_y) + 4.0), "end", &tick_text(own_y, y.1 - y.0)));
    }
    for (place, series) in series.iter().enumerate().filter(|(_, series)| !series.is_empty()) {
        let color = COLORS[place % COLORS.len()];
        let point = |x: f64, y: f64| format!("{:.2},{:.2}", at_x(x), at_y(y));
        let upper = series.iter().map(|place| point(place[0], place[2]));
        let lower = series.iter().rev().map(|place| point(place[0], place[1]));
        let around: Vec<String> = upper.chain(lower).collect();
        let nominal = series.iter().filter(|place| place[3].is_finite()).map(|place| point(place[0], place[3]));
        let nominal: Vec<String> = nominal.collect();
        let text = match sweep.axes.get(1) {
            Some(second) => format!("{} = {} {}", second.name, tick_text(second.values[place], 1.0), second.unit),
            None => "bounds, and nominal".to_owned(),
        };
        let shape = Polygon::new()
            .set("points", around.join(" "))
            .set("fill", color)
            .set("fill-opacity", 0.2)
            .set("stroke", color);
        let curve = Curve::new()
            .set("d", format!("M{}", nominal.join(" L")))
            .set("fill", "none")
            .set("stroke", color)
            .set("stroke-width", 2);
        let row = TOP + 14.0 + 20.0 * place as f64;
        let mut group = Group::new()
            .set("class", "series")
            .set("data-series", format!("sweep-{place}"))
            .add(Title::new(text.clone()))
            .add(shape);
        if !nominal.is_empty() {
            group = group.add(curve);
        }
        if row < HEIGHT - BOTTOM {
            group = group.add(label((WIDTH - RIGHT + 10.0, row), "start", text.trim()).set("fill", color));
        }
        document = document.add(group);
    }
    format!("{document}\n")
}

fn line(from: (f64, f64), to: (f64, f64)) -> Line {
    let line = Line::new().set("x1", from.0).set("y1", from.1).set("x2", to.0).set("y2", to.1);
    line.set("stroke", "#dddddd")
}

fn label((x, y): (f64, f64), anchor: &str, text: &str) -> Text {
    Text::new(text).set("x", x).set("y", y).set("text-anchor", anchor)
}

/// As many digits as the range needs.
fn tick_text(value: f64, range: f64) -> String {
    let digits = (2.0 - symdiff::math::log10(range.abs().max(f64::MIN_POSITIVE)).floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}
