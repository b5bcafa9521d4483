//! "Did you mean": what to say of a name that is not known.

/// Known names that are looked at.
const MOST_KNOWN: usize = 1000;

/// Longest name that is compared or quoted in full.
const LONGEST: usize = 60;

/// The known name nearest to a mistyped one, if any is near.
pub fn nearest<'c>(name: &str, known: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let length = name.chars().count();
    if length > LONGEST {
        return None;
    }
    let lower = name.to_lowercase();
    // One slip in three letters; a name of one letter is near to no other.
    let limit = if length < 2 { 0 } else { (length / 3).max(1) };
    known
        .into_iter()
        .take(MOST_KNOWN)
        .filter(|candidate| candidate.len() <= 4 * LONGEST)
        .filter_map(|candidate| {
            let distance = if candidate.to_lowercase() == lower {
                0
            } else if candidate.chars().count().abs_diff(length) > limit {
                return None;
            } else {
                strsim::damerau_levenshtein(name, candidate)
            };
            // A short candidate is not near when every letter of it differs.
            (distance <= limit && distance < candidate.chars().count()).then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Help for an unknown name: the nearest known one, or all where they are few. `kind` is their plural: `bodies`.
pub fn help<'c>(name: &str, kind: &str, known: impl IntoIterator<Item = &'c str>) -> Option<String> {
    let known: Vec<&str> = known.into_iter().take(MOST_KNOWN).collect();
    if let Some(near) = nearest(name, known.iter().copied()) {
        return Some(format!("did you mean `{near}`?"));
    }
    match known.as_slice() {
        [] => Some(format!("there are no {kind}")),
        [one] if one.len() <= LONGEST => Some(format!("there is only `{one}`")),
        few if few.len() <= 16 && few.iter().all(|name| name.len() <= LONGEST) => {
            Some(format!("the {kind} are {}", list(few)))
        }
        _ => None,
    }
}

/// `` `a`, `b` and `c` ``.
pub fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// Text from a file as it may stand in a message: neither long nor over several lines.
pub fn clip(text: &str) -> String {
    let mut clipped: String =
        text.chars().take(LONGEST).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() {
        clipped.push('…');
    }
    clipped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let bodies = ["crank", "rod", "slider"];
        assert_eq!(nearest("crnk", bodies), Some("crank"));
        assert_eq!(nearest("CRANK", bodies), Some("crank"));
        assert_eq!(nearest("sildre", bodies), Some("slider"));
        assert_eq!(nearest("piston", bodies), None);
        assert_eq!(nearest("x", ["y"]), None);
        assert_eq!(nearest("l3", ["l1", "tau"]), Some("l1"));
        assert_eq!(help("piston", "bodies", bodies).unwrap(), "the bodies are `crank`, `rod` and `slider`");
        assert_eq!(clip(&"x".repeat(100)).chars().count(), 61);
    }
}
