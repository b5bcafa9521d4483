//! Effects of excitations as constants and as arbitrary functions, for people; random ones.

use super::tuning::TUNING;
use super::words::digits;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{ExcitationSummary, Summary};
use crate::syntax::suggest;

/// A line for each output that excitations move, and one of random ones.
pub fn lines(summary: &Summary) -> String {
    limited(&summary.excitations) + &random(&summary.realisations)
}

/// A line if bounds have one realisation of random excitations.
fn random(realisations: &[String]) -> String {
    let names: Vec<&str> = realisations.iter().map(String::as_str).collect();
    match names.as_slice() {
        [] => String::new(),
        names => {
            let names = suggest::list(names);
            format!("  bounds have one realisation of {names}: `statistics:` simulates many\n\n")
        }
    }
}

fn limited(excitations: &[ExcitationSummary]) -> String {
    let line = |own: &ExcitationSummary| {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let shown = |value: f64| format!("± {} {}", digits(unit.of_si(value)), unit.text).trim_end().to_owned();
        let ratio = own.as_function / own.as_constant;
        let told = match ratio {
            ratio if ratio <= TUNING.constants_are_enough => ": constants are enough".to_owned(),
            ratio if ratio.is_finite() => format!(": {} times as far", digits(ratio)),
            _ => String::new(),
        };
        let (constant, function) = (shown(own.as_constant), shown(own.as_function));
        format!("  {}: as a constant {constant}, as any function {function}{told}\n", own.output)
    };
    let moved = || excitations.iter().filter(|own| own.as_function > 0.0);
    let mut text: String = moved().take(TUNING.excitation_lines).map(line).collect();
    if moved().count() > TUNING.excitation_lines {
        text += &format!("  … and {} more in summary.json\n", moved().count() - TUNING.excitation_lines);
    }
    if text.is_empty() { text } else { text + "\n" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_compares_functions_with_constants() {
        let of = |as_constant, as_function| ExcitationSummary {
            output: "shake".into(),
            unit: "m/s^2".into(),
            display: None,
            as_constant,
            as_function,
            time: 6.0,
            value: as_function,
        };
        let text = limited(&[of(0.689, 2.573), of(1.0, 1.001), of(0.0, 2.0), of(0.0, 0.0)]);
        let expected = "  shake: as a constant ± 0.689 m/s^2, as any function ± 2.573 m/s^2: 3.734 times as far\n  \
                        shake: as a constant ± 1 m/s^2, as any function ± 1.001 m/s^2: constants are enough\n  \
                        shake: as a constant ± 0 m/s^2, as any function ± 2 m/s^2\n\n";
        assert_eq!(text, expected);
        let text = random(&["road".to_owned()]);
        assert_eq!(text, "  bounds have one realisation of `road`: `statistics:` simulates many\n\n");
    }
}
