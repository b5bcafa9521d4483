//! Names with stars: `front_*.damper`.

/// Whether a text is a pattern.
pub fn is_pattern(text: &str) -> bool {
    text.contains('*')
}

/// Whether a name is one of a pattern's: `*` stands for any letters, dots included.
pub fn matches(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let first = parts.next().unwrap_or("");
    let Some(mut rest) = name.strip_prefix(first) else { return false };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else { return rest.is_empty() };
    for part in parts {
        match rest.find(part) {
            Some(index) => rest = &rest[index + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn stars_match_any_text() {
        for (pattern, name, expected) in [
            ("a", "a", true),
            ("a", "ab", false),
            ("a*", "ab.c", true),
            ("*", "", true),
            ("*.spring", "front_left.spring", true),
            ("*.spring", "front_left.springs", false),
            ("f*_l*.s*g", "front_left.spring", true),
            ("ab*b", "ab", false),
            ("a*b*c", "a1b2", false),
            ("**", "x", true),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
