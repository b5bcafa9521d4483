//! Statistics for people, in addition to the bounds: worst case first.

use super::stack;
use super::table::{Align, Table};
use crate::grammar::display_unit::ShownUnit;
use crate::results::{StatisticsSummary, Summary, Uncertain};
use crate::syntax::suggest;

/// Laws, and for each output the worst case, the linearised stack and the distribution.
pub fn statistics(summary: &Summary) -> String {
    let Some(found) = summary.statistics.as_ref().map(|found| &found.summary) else { return String::new() };
    let note = found.failure.as_ref().map_or_else(String::new, |failure| format!("  statistics: {failure}\n\n"));
    if found.outputs.is_empty() {
        return note;
    }
    let mut table = Table::new([
        ("at its widest", Align::Left),
        ("t", Align::Right),
        ("worst case", Align::Right),
        ("linear", Align::Right),
        ("RSS", Align::Right),
        ("mean", Align::Right),
        ("deviation", Align::Right),
        ("statistical", Align::Right),
        ("unit", Align::Left),
    ]);
    let has_time = has_time(summary);
    for output in &found.outputs {
        let unit = ShownUnit::of(&output.display, &output.unit);
        let shown = |value: f64| unit.of_si(value);
        let digits = decimals(shown(output.deviation.value));
        let number = |value: f64| match digits {
            Some(digits) => format!("{value:.digits$}"),
            None => format!("{value:.4e}"),
        };
        let ends = |lower: f64, upper: f64| format!("[{}, {}]", number(shown(lower)), number(shown(upper)));
        // Simulated motions have no linear stack, and under random excitations no box.
        let known = |value: f64, text: String| if value.is_nan() { "–".to_owned() } else { text };
        let estimate = |value: f64, of: Uncertain| format!("{} ± {:.1e}", number(value), shown(of.total()));
        let statistical = match (output.quantiles.first(), output.quantiles.last()) {
            (Some(low), Some(high)) => known(low.value + high.value, ends(low.value, high.value)),
            _ => String::new(),
        };
        table.row([
            output.output.clone(),
            if has_time { format!("{:.4}", output.time) } else { "–".to_owned() },
            known(output.worst_case[0], ends(output.worst_case[0], output.worst_case[1])),
            known(output.linear, format!("± {}", number(shown(output.linear)))),
            known(output.rss, format!("± {}", number(shown(output.rss)))),
            estimate(shown(output.mean.value), output.mean),
            estimate(shown(output.deviation.value), output.deviation),
            statistical,
            unit.text.to_owned(),
        ]);
    }
    let shares = match (found.quantiles.first(), found.quantiles.last()) {
        (Some(low), Some(high)) => {
            // 99.865 % is 0.99865, as it is written, and not 0.9986499999999999.
            let [low, high] = [low, high].map(|share| (share * 1e12).round() / 1e12);
            format!("; statistical: from the {low}-quantile to the {high}-quantile")
        }
        _ => String::new(),
    };
    let by = match &found.random {
        Some(random) => {
            let names: Vec<&str> = random.excitations.iter().map(String::as_str).collect();
            let (names, seed) = (suggest::list(&names), random.seed);
            format!("samples are {} simulated motions under {names} (seed {seed}){shares}", found.samples)
        }
        None => {
            let by = match (found.samples, found.products) {
                (samples, None) => format!("{samples} samples of the surrogate"),
                (samples, Some(products)) if samples == products => format!("{products} simulated products"),
                (samples, Some(products)) => {
                    format!("{samples} samples of the surrogate and {products} simulated products")
                }
            };
            format!("the worst case is every case of the box{shares}, by {by}")
        }
    };
    format!(
        "{}{note}{}{}{}  {by}\n{}\n",
        laws(found),
        table.render(2),
        reduced(found),
        stack::sensitivities(summary),
        yields(found.requirements.iter().chain(&found.together))
    )
}

/// Table of the reduced outputs, with every quantile; empty if there are none.
fn reduced(found: &StatisticsSummary) -> String {
    if found.reduced.is_empty() {
        return String::new();
    }
    let mut table = Table::new([
        ("reduced output", Align::Left),
        ("mean", Align::Right),
        ("deviation", Align::Right),
        ("quantiles", Align::Left),
        ("unit", Align::Left),
    ]);
    for own in &found.reduced {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let digits = decimals(unit.of_si(own.deviation.value));
        let estimate = |of: &Uncertain| {
            let value = unit.of_si(of.value);
            if value.is_nan() {
                return "–".to_owned();
            }
            let number = match digits {
                Some(digits) => format!("{value:.digits$}"),
                None => format!("{value:.4e}"),
            };
            format!("{number} ± {:.1e}", unit.of_si(of.total()))
        };
        let quantile =
            |(share, of): (&f64, &Uncertain)| format!("{} %: {}", (share * 1e14).round() / 1e12, estimate(of));
        let quantiles: Vec<String> = found.quantiles.iter().zip(&own.quantiles).map(quantile).collect();
        let [mean, deviation] = [&own.mean, &own.deviation].map(estimate);
        table.row([own.name.clone(), mean, deviation, quantiles.join(", "), unit.text.to_owned()]);
    }
    table.render(2)
}

/// The share that fulfils each requirement.
pub fn yields<'y>(found: impl IntoIterator<Item = &'y crate::results::YieldSummary>) -> String {
    let line = |of: &crate::results::YieldSummary| {
        let [least, most] = of.ppm_interval;
        let cp = of.cp.map_or_else(String::new, |cp| format!("; Cp {cp:.2}"));
        let cpk =
            of.cpk.map_or_else(String::new, |cpk| format!("{} Cpk {cpk:.2}", if cp.is_empty() { ";" } else { "," }));
        let time = of.time.map_or_else(String::new, |time| format!(" at t = {time:.4} s"));
        let rare = of.method.as_ref().map_or_else(String::new, |method| format!(", by {method}"));
        let exposure = of.exposure.as_ref().map_or_else(String::new, |own| {
            let [least, most] = own.ppm_interval.map(parts);
            format!("; within {} s {} ppm (95 %: {least} to {most})", own.time, parts(own.ppm))
        });
        format!(
            "  statistically, {} {} fulfilled by {} %: {} ppm fail (95 %: {} to {}{rare}){exposure}{cp}{cpk}{time}\n",
            of.requirement,
            if of.requirement.contains(' ') { "are" } else { "is" },
            percent(of.share),
            parts(of.ppm),
            parts(least),
            parts(most),
        )
    };
    found.into_iter().map(line).collect()
}

/// A share in per cent, with the digits that a high yield needs.
fn percent(share: f64) -> String {
    let digits = if share > 0.9999 && share < 1.0 { 8 } else { 4 };
    format!("{:.digits$}", 100.0 * share)
}

/// Parts per million: an integer, or three digits below 100.
fn parts(ppm: f64) -> String {
    if ppm >= 100.0 || ppm == 0.0 { format!("{ppm:.0}") } else { format!("{ppm:.2e}") }
}

/// Decimals that show four digits of a deviation; `None` if an exponent is better.
fn decimals(deviation: f64) -> Option<usize> {
    let digits = 3.0 - symdiff::math::log10(deviation).floor();
    if deviation == 0.0 { Some(6) } else { (-3.0..=8.0).contains(&digits).then(|| digits.max(0.0) as usize) }
}

/// Law assumed for each parameter.
fn laws(found: &StatisticsSummary) -> String {
    let law = |law: &crate::results::LawSummary| {
        let rule = if law.tolerance_is_three_sigma { ", of which the tolerance is three" } else { "" };
        format!("{} {} (deviation {:.3e}{rule})", law.parameter, law.distribution, law.deviation)
    };
    let laws: Vec<String> = found.parameters.iter().map(law).collect();
    let outside = match found.outside {
        0.0 => String::new(),
        outside => format!("; up to {:.2} % of them lies outside of the box that is bounded", 100.0 * outside),
    };
    format!("  distributions: {}{outside}\n", laws.join(", "))
}

/// Whether the numbers have a time: a stack of dimensions has none.
fn has_time(summary: &Summary) -> bool {
    summary.analysis.as_ref().is_none_or(|analysis| analysis.kind != "dimensions")
}
