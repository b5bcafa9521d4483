//! Names of files.

use super::tuning::TUNING;
use std::collections::HashSet;

/// `name` as a file name without extension that is valid on every system: letters, digits, `_`, `-` and `.` stay, the
/// rest becomes `_`.
pub fn file_stem(name: &str) -> String {
    /// Names of devices on Windows, with any extension.
    const RESERVED: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

    let keep = |c: char| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    let mut stem: String = name.chars().map(keep).collect();
    while stem.len() > TUNING.longest_name {
        stem.pop();
    }
    // No hidden files, no `..`, and no trailing dot, which Windows drops.
    let trimmed = stem.trim_end_matches('.').len();
    stem.truncate(trimmed);
    let device = stem.split('.').next().unwrap_or("").trim_end_matches(|c: char| c.is_ascii_digit());
    if stem.is_empty() || stem.starts_with('.') || RESERVED.iter().any(|name| device.eq_ignore_ascii_case(name)) {
        stem.insert(0, '_');
    }
    stem
}

/// [`file_stem`]s, made unique (also without distinction of case) by `-2`, `-3`, … on the later ones.
pub(super) fn unique_stems<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut unique = |name: &str| {
        let stem = file_stem(name);
        let mut candidate = stem.clone();
        let mut number = 1;
        while !taken.insert(candidate.to_lowercase()) {
            number += 1;
            candidate = format!("{stem}-{number}");
        }
        candidate
    };
    names.map(&mut unique).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_safe_and_unique_file_names() {
        for (name, stem) in [
            ("x3", "x3"),
            ("crank.angle", "crank.angle"),
            ("../../etc/passwd", "_.._.._etc_passwd"),
            ("..", "_"),
            ("", "_"),
            (".hidden", "_.hidden"),
            ("a b\n<c>:\"d\"|?*\\", "a_b__c___d_____"),
            ("NUL", "_NUL"),
            ("com1.x", "_com1.x"),
            ("command", "command"),
            ("θ₁", "θ₁"),
        ] {
            assert_eq!(file_stem(name), stem, "{name:?}");
        }
        assert!(file_stem(&"ä".repeat(500)).len() <= 121);
        let unique = unique_stems(["a b", "a/b", "A_B", "a_b-2", "c"].into_iter());
        assert_eq!(unique, ["a_b", "a_b-2", "A_B-3", "a_b-2-2", "c"]);
    }
}
