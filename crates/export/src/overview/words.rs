//! Numbers and counts in words.

/// `1 step`, `2 steps`, `no steps`.
pub fn count(n: usize, one: &str, many: &str) -> String {
    match n {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        _ => format!("{n} {many}"),
    }
}

/// `7 absolute coordinates`.
pub fn coordinates(n: usize, formulation: &str) -> String {
    count(n, &format!("{formulation} coordinate"), &format!("{formulation} coordinates"))
}

/// Four significant digits, without zeros at the end.
pub fn digits(value: f64) -> String {
    significant(value, 4)
}

/// `digits` significant digits, without zeros at the end.
pub fn significant(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    let text = match rounded.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    };
    text.replace('-', "−").replace("e−", "e-")
}

/// Six digits, without zeros at the end.
pub fn short(value: f64) -> String {
    if value.is_nan() {
        return "unknown".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let digits = format!("{value:.6}");
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}
