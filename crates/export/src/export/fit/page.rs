//! The page of a fit.

use crate::export::report::{Section, plain_page};
use crate::export::rounded::{rounded, shown, significant};
use crate::grammar::display_unit::ShownUnit;
use crate::results::{ConsistentSet, Fit, FitParameter};

/// The page with these figures.
pub(super) fn page(fit: &Fit, figures: impl Iterator<Item = String>) -> String {
    let mut sections = vec![Section::Text(format!(
        "{} measured values of {}; residuals at the least-squares estimate are {} of the noise bounds (root mean square).",
        fit.rows.len(),
        fit.outputs.iter().map(|output| output.name.as_str()).collect::<Vec<_>>().join(", "),
        rounded(significant(fit.residual, 3))
    ))];
    let lost = fit.rows.iter().filter(|row| !row.error.is_finite()).count();
    if lost > 0 {
        let text = "without a reliable value of the model are not used, neither for the set nor against the model.";
        sections.push(Section::Text(format!("{lost} of them {text}")));
    }
    sections.push(parameters(fit));
    sections.extend(fit.set.iter().flat_map(|set| of_set(fit, set)));
    if let Some(unexplained) = &fit.unexplained {
        let enough = rounded(significant(unexplained.factor, 4));
        sections.push(Section::Text(format!(
            "No parameters within the intervals agree with all rows: some would if the noise were {enough} times as large."
        )));
        if let Some((row, factor)) = unexplained.worst {
            let row = &fit.rows[row];
            sections.push(Section::Text(format!(
                "The row that fits least is line {} (t = {} s, {}): without it a factor of {} is enough for the others.",
                row.line,
                rounded(row.time),
                fit.outputs[row.output].name,
                rounded(significant(factor, 4))
            )));
        }
    }
    sections.extend(figures.map(Section::Figure));
    plain_page(&format!("{}: fit", fit.model), &sections)
}

fn parameters(fit: &Fit) -> Section {
    let row = |own: &FitParameter| {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let interval = |ends: [f64; 2]| format!("{} to {}", shown(unit, ends[0]), shown(unit, ends[1]));
        let deviation =
            if own.deviation.is_finite() { shown(unit, own.deviation) } else { "not determined".to_owned() };
        vec![
            own.name.clone(),
            interval(own.prior),
            shown(unit, own.estimate),
            deviation,
            own.hull.map_or_else(|| "none".to_owned(), interval),
        ]
    };
    let headings = ["parameter", "model", "least squares", "standard deviation", "consistent"].map(str::to_owned);
    Section::Table("Parameters", headings.to_vec(), fit.parameters.iter().map(row).collect())
}

fn of_set(fit: &Fit, set: &ConsistentSet) -> [Section; 2] {
    let [inner, outer] = set.volumes.map(|volume| rounded(significant(volume, 4)));
    let text = format!("The consistent set takes between {inner} and {outer} of the volume of the model's box.");
    let row = |index: usize| {
        let axis = &set.axes[index];
        let terms = axis.direction.iter().zip(&fit.parameters).filter(|(own, _)| own.abs() > 0.05);
        let terms = terms.map(|(own, parameter)| format!("{own:+.2} {}", parameter.name)).collect::<Vec<_>>();
        vec![terms.join(" "), rounded(significant(0.5 * axis.extent, 3))]
    };
    let headings = ["combination (half intervals)", "left open, share of the interval"].map(str::to_owned).to_vec();
    [Section::Text(text), Section::Table("Principal axes", headings, (0..set.axes.len()).map(row).collect())]
}
