//! Residuals in engineering units, as messages state them.

use crate::assemble::{ConstraintInfo, ResidualUnit};

/// The size of a residual in engineering units: mm below a metre, degrees for angles.
pub fn residual_text(residual: f64, constraint: &ConstraintInfo, of_velocities: bool) -> String {
    let size = residual.abs();
    let (value, unit) = match constraint.unit {
        ResidualUnit::Length if size < 1.0 => (1e3 * size, " mm"),
        ResidualUnit::Length => (size, " m"),
        ResidualUnit::Angle => (size.to_degrees(), "°"),
        ResidualUnit::Number => (size, ""),
    };
    let value = if (1e-2..1e4).contains(&value) { significant(value, 3) } else { format!("{value:.1e}") };
    format!("{value}{unit}{}", if of_velocities { "/s" } else { "" })
}

/// A positive number with `digits` significant digits, without trailing zeros.
fn significant(value: f64, digits: i32) -> String {
    let before_point = symdiff::math::log10(value).floor() as i32 + 1;
    let decimals = (digits - before_point).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residuals_are_in_engineering_units() {
        let text = |residual, unit, of_velocities| {
            let constraint = ConstraintInfo { name: "C.x".into(), joint: "C".into(), unit };
            residual_text(residual, &constraint, of_velocities)
        };
        assert_eq!(text(5.5e-2, ResidualUnit::Length, false), "55 mm");
        assert_eq!(text(-0.123_456, ResidualUnit::Length, false), "123 mm");
        assert_eq!(text(1.5, ResidualUnit::Length, true), "1.5 m/s");
        assert_eq!(text(1.139e-6, ResidualUnit::Length, false), "1.1e-3 mm");
        assert_eq!(text(1.0, ResidualUnit::Angle, false), "57.3°");
        assert_eq!(text(0.25, ResidualUnit::Number, false), "0.25");
        assert_eq!(text(f64::NAN, ResidualUnit::Length, false), "NaN m");
    }
}
