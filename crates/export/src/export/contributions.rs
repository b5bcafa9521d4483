//! `contributions.csv` and `NAME.contributions.svg`: the tolerances that matter at each time.

use csv::WriterBuilder;

use super::csv::number;
use super::figure::Caption;
use super::figure::axis::Axis;
use super::figure::data::{self, FigureData, SeriesData, extremes};
use super::figure::document::{document, finished, group, heading, metadata, shortened, text_width};
use super::figure::legend::{Entry, ROW, Sign};
use super::figure::panel::{Named, Panel};
use super::figure::style::{Color, Hue};
use super::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Bounds, Contribution};

/// The table of all contributions as CSV.
///
/// Columns: `t`, then for each output and parameter `x3.l1.main` and `.total`, the parameter's share of the output's
/// variance alone and with others, and `.width_without`, how wide the output's range would be if the parameter were at
/// its nominal value. Unknown values are `NaN`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn contributions_csv(bounds: &Bounds) -> Result<Vec<u8>, csv::Error> {
    let mut columns: Vec<(String, &[f64])> = vec![("t".to_owned(), &bounds.times)];
    for (output, contributions) in bounds.outputs.iter().zip(&bounds.contributions) {
        for Contribution { parameter, main, total, width_without } in contributions {
            for (name, values) in [("main", main), ("total", total), ("width_without", width_without)] {
                columns.push((format!("{}.{parameter}.{name}", output.name), values));
            }
        }
    }
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(columns.iter().map(|(name, _)| name))?;
    for row in 0..bounds.times.len() {
        writer.write_record(columns.iter().map(|(_, values)| number(values[row])))?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// Size on the page, px.
const SIZE: (f64, f64) = (900.0, 380.0);
/// Space on three sides, px; on the right is the legend.
const LEFT: f64 = 74.0;
const TOP: f64 = 36.0;
const BOTTOM: f64 = 50.0;

/// The layer of the parameters' interactions.
const TOGETHER: Color = Color([190, 190, 190]);
/// The layer of all other parameters.
const OTHERS: Color = Color([120, 120, 120]);

/// A layer of the stack.
struct Layer {
    /// Key of its group, as in the groups and the legend.
    group: String,
    label: String,
    color: Color,
    /// Share of the variance, 0 to 1.
    share: Vec<f64>,
}

/// The parameters' shares of one output's variance over time, stacked, the largest lowest, with the legend next to them
/// in the same order.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn contributions_svg(
    caption: Caption,
    times: &[f64],
    name: &str,
    contributions: &[Contribution],
) -> Result<String, serde_json::Error> {
    let layers = layers(contributions, times.len());
    let width = layers.iter().map(|layer| text_width(&layer.label)).fold(0.0, f64::max);
    let right = (SIZE.0 - 50.0 - width).max(0.5 * SIZE.0);
    let time = Axis::fit(times.iter().copied(), "s", 9, 0.0, 0.0);
    let percent = Axis::fit([0.0, 1.0].into_iter(), ShownUnit { text: "%", si: 0.01 }, 5, 0.0, 0.0);
    let id = format!("{}-shares", caption.prefix);
    let panel = Panel { id, left: LEFT, right, top: TOP, bottom: SIZE.1 - BOTTOM, x: &time, y: &percent };

    let mut series = Vec::new();
    let (mut drawn, mut legend) = (Vec::new(), group("legend"));
    let mut below = vec![0.0; times.len()];
    for (index, layer) in layers.iter().enumerate() {
        let above: Vec<f64> =
            below.iter().zip(&layer.share).map(|(below, share)| (below + share).clamp(0.0, 1.0)).collect();
        let id = format!("{}-{}", panel.id, layer.group);
        let named = Named { id: &id, group: &layer.group, title: &layer.label };
        drawn.push(panel.layer(named, times, [&below, &above], layer.color));
        let [lower, upper] = extremes(&below, &above, &percent);
        let (group, label, panel) = (layer.group.clone(), layer.label.clone(), panel.id.clone());
        series.push(SeriesData { id, group, label, kind: "share", panel, time: None, lower, upper });
        // The lowest layer has the lowest entry.
        let at = (right + 14.0, TOP + 12.0 + ROW * (layers.len() - 1 - index) as f64);
        let (group, label) = (layer.group.clone(), layer.label.clone());
        legend = legend.add(Entry { group, label, sign: Sign::Area(Hue::Color(layer.color)) }.drawn(at));
        below = above;
    }
    let panels = vec![panel.data()];
    let (model, output, unit) = (caption.model.to_owned(), name.to_owned(), "%".to_owned());
    let data = FigureData { model, output, unit, across: None, time: data::times(times), panels, series };
    let title = format!("{}: tolerances that matter for {}", shortened(caption.model, 60), shortened(name, 60));
    let figure = document(SIZE, &format!("{}: tolerances that matter for {name}", caption.model))
        .add(metadata(&data)?)
        .add(heading(&title, (LEFT, 15.0)))
        .add(panel.framed(name, &percent.title("share of the variance"), drawn))
        .add(panel.time_axis("t"))
        .add(legend);
    Ok(finished(&figure))
}

/// The layers from the lowest to the highest: the parameters by their mean share, all others, and their interactions.
/// Rows without variance or without known shares stay empty.
fn layers(contributions: &[Contribution], rows: usize) -> Vec<Layer> {
    let mut ranked: Vec<&Contribution> = contributions.iter().collect();
    let mean = |contribution: &Contribution| contribution.main.iter().filter(|share| share.is_finite()).sum::<f64>();
    ranked.sort_by(|a, b| mean(b).total_cmp(&mean(a)));
    let is_known = |row: usize| contributions.iter().any(|contribution| contribution.main[row] > 0.0);
    let sum = |of: &[&Contribution]| -> Vec<f64> {
        let share = |row: usize| of.iter().map(|contribution| contribution.main[row]).sum();
        (0..rows).map(|row| if is_known(row) { share(row) } else { f64::NAN }).collect()
    };
    let own = if ranked.len() > TUNING.most_layers + 1 { TUNING.most_layers } else { ranked.len() };
    let mut layers = Vec::new();
    for (index, contribution) in ranked[..own].iter().enumerate() {
        let (group, label) = (format!("share-{index}"), contribution.parameter.clone());
        layers.push(Layer { group, label, color: Color::of(index), share: sum(&[contribution]) });
    }
    if own < ranked.len() {
        let label = format!("{} others", ranked.len() - own);
        layers.push(Layer { group: "others".to_owned(), label, color: OTHERS, share: sum(&ranked[own..]) });
    }
    let share = sum(&ranked).iter().map(|share| 1.0 - share.clamp(0.0, 1.0)).collect();
    layers.push(Layer { group: "together".to_owned(), label: "together".to_owned(), color: TOGETHER, share });
    layers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::OutputBounds;

    fn contribution(parameter: &str, main: f64) -> Contribution {
        let shares = vec![f64::NAN, main, main];
        Contribution {
            parameter: parameter.into(),
            main: shares.clone(),
            total: shares,
            width_without: vec![0.0, 1.0, 2.0],
        }
    }

    #[test]
    fn a_column_for_each_share() {
        let output =
            OutputBounds { name: "x3".into(), unit: "m".into(), display: None, nominal: vec![0.0; 3], bands: vec![] };
        let bounds = Bounds {
            times: vec![0.0, 0.5, 1.0],
            outputs: vec![output],
            contributions: vec![vec![contribution("l1", 0.25), contribution("tau", 0.5)]],
            ..Bounds::default()
        };
        let text = String::from_utf8(contributions_csv(&bounds).unwrap()).unwrap();
        assert_eq!(
            text,
            "t,x3.l1.main,x3.l1.total,x3.l1.width_without,x3.tau.main,x3.tau.total,x3.tau.width_without\n\
             0,NaN,NaN,0,NaN,NaN,0\n0.5,0.25,0.25,1,0.5,0.5,1\n1,0.25,0.25,2,0.5,0.5,2\n"
        );
    }

    #[test]
    fn shares_are_stacked_and_named() {
        let shares: Vec<Contribution> =
            (0..9).map(|index| contribution(&format!("p{index}"), 0.1)).chain([contribution("l1", 0.05)]).collect();
        let caption = Caption { model: "crank", prefix: "c" };
        let svg = contributions_svg(caption, &[0.0, 0.5, 1.0], "x3", &shares).unwrap();
        assert!(!svg.contains("NaN"));
        let document = roxmltree::Document::parse(&svg).unwrap();
        let texts = || document.descendants().filter(|node| node.has_tag_name("text"));
        let find = |text: &str| texts().find(|node| node.text().map(str::trim) == Some(text));
        for text in ["p0", "4 others", "together", "t [s]", "100", "share of the variance [%]"] {
            assert!(find(text).is_some(), "{text}");
        }
        let height = |text: &str| -> f64 { find(text).unwrap().attribute("y").unwrap().parse().unwrap() };
        assert!(height("together") < height("4 others") && height("4 others") < height("p1"), "as the stack");
        assert!(height("p1") < height("p0"));
        assert!(contributions_svg(caption, &[], "x3", &[]).is_ok());
    }
}
