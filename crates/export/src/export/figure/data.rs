//! The data of a figure of courses over time, for the scripts that show it: scales, and series as thin as the page.

use serde::Serialize;

use super::axis::Axis;
use crate::export::tuning::TUNING;

/// All data of a figure of courses.
#[derive(Clone, Debug, Serialize)]
pub struct FigureData {
    /// The model's name.
    pub model: String,
    /// The output's name.
    pub output: String,
    /// Unit of the upper panel.
    pub unit: String,
    /// Quantity of the horizontal axis, if that is not the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub across: Option<AcrossData>,
    /// Times of the rows, s, or values of the quantity on the axis.
    pub time: Vec<f64>,
    /// From top to bottom.
    pub panels: Vec<PanelData>,
    /// In the order in which they are drawn.
    pub series: Vec<SeriesData>,
}

/// Quantity of the horizontal axis of a figure.
#[derive(Clone, Debug, Serialize)]
pub struct AcrossData {
    /// Its name.
    pub name: String,
    /// Unit of its values.
    pub unit: String,
}

/// A panel's scales.
#[derive(Clone, Debug, Serialize)]
pub struct PanelData {
    /// Identifier, as in its group.
    pub id: String,
    /// Unit of the panel's numbers.
    pub unit: String,
    /// Value of the panel's unit in SI.
    pub si: f64,
    /// The time, s.
    pub x: ScaleData,
    /// The panel's numbers.
    pub y: ScaleData,
}

/// A linear scale.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleData {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
    /// Position of the lower end, px.
    pub from_px: f64,
    /// Position of the upper end, px.
    pub to_px: f64,
}

/// One of the series of a panel; numbers in the panel's unit, `null` if unknown.
#[derive(Clone, Debug, Serialize)]
pub struct SeriesData {
    /// Identifier, as in its group.
    pub id: String,
    /// Key of its group in all panels: groups and entries of the legend have it too.
    pub group: String,
    /// Label for people.
    pub label: String,
    /// `nominal`, `bounds` or `error`.
    pub kind: &'static str,
    /// The panel's `id`.
    pub panel: String,
    /// Times of the rows, s, if they are not those of the figure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<Vec<f64>>,
    /// Lowest in each row.
    pub lower: Vec<Option<f64>>,
    /// Highest in each row.
    pub upper: Vec<Option<f64>>,
}

/// Number of rows that are merged into one.
fn bucket(rows: usize) -> usize {
    rows.div_ceil(TUNING.rows_of_series).max(1)
}

/// Times of the rows, s: the middle one of each.
pub fn times(times: &[f64]) -> Vec<f64> {
    times.chunks(bucket(times.len())).map(|rows| rounded(rows[(rows.len() - 1) / 2], 1e-12)).collect()
}

/// Extremes of two curves in each row, in the unit of an axis.
pub fn extremes(lower: &[f64], upper: &[f64], axis: &Axis) -> [Vec<Option<f64>>; 2] {
    let step = TUNING.resolution_of_numbers * (axis.max - axis.min);
    let of = |values: &[f64], choose: fn(f64, f64) -> f64| -> Vec<Option<f64>> {
        let rows = values.chunks(bucket(values.len()));
        let extreme = rows.map(|rows| rows.iter().copied().filter(|x| x.is_finite()).reduce(choose));
        extreme.map(|extreme| extreme.map(|x| rounded(x / axis.unit.factor, step)).filter(|x| x.is_finite())).collect()
    };
    [of(lower, f64::min), of(upper, f64::max)]
}

/// A number rounded to the decimals of a step.
pub fn rounded(x: f64, step: f64) -> f64 {
    let decimals = (-symdiff::math::log10(step.max(f64::MIN_POSITIVE)).floor()).clamp(0.0, 300.0) as usize;
    if x.abs() >= 1e15 {
        return x;
    }
    format!("{x:.decimals$}").parse().unwrap_or(x) + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_series_keep_their_extremes() {
        let n = 100_000;
        let mut values: Vec<f64> = (0..n).map(|i| (f64::from(i) / 500.0).sin()).collect();
        values[77_777] = 9.0;
        values[5] = f64::NAN;
        let axis = Axis::fit(values.iter().copied(), "m", 5, 0.0, 0.0);
        let [lower, upper] = extremes(&values, &values, &axis);
        assert!(lower.len() == 400 && upper.contains(&Some(9.0)) && !lower.contains(&None));
        assert_eq!(times(&values.iter().enumerate().map(|(row, _)| row as f64).collect::<Vec<_>>())[0], 124.0);
    }

    #[test]
    fn numbers_are_rounded_to_visible_digits() {
        assert_eq!(rounded(0.123_456_789, 1e-4), 0.1235);
        assert_eq!(rounded(-1e-9, 1e-4).to_bits(), 0.0_f64.to_bits());
        let axis = Axis::fit([25_000.0, 26_000.0].into_iter(), "N", 5, 0.0, 0.0);
        assert_eq!(extremes(&[25_123.456], &[f64::NAN], &axis), [vec![Some(25.1235)], vec![None]]);
    }
}
