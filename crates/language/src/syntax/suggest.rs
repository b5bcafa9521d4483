//! "Did you mean": help for unknown names.

use crate::syntax::tuning::TUNING;

/// The known name nearest to a mistyped one, if any is near.
pub fn nearest<'c>(name: &str, known: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let length = name.chars().count();
    if length > TUNING.name_length {
        return None;
    }
    let lower = name.to_lowercase();
    // One slip in three letters; a name of one letter is near to no other.
    let limit = if length < 2 { 0 } else { (length / 3).max(1) };
    known
        .into_iter()
        .take(TUNING.names_compared)
        .filter(|candidate| candidate.len() <= 4 * TUNING.name_length)
        .filter_map(|candidate| {
            let distance = if candidate.to_lowercase() == lower {
                0
            } else if candidate.chars().count().abs_diff(length) > limit {
                return None;
            } else {
                strsim::osa_distance(name, candidate)
            };
            // A short candidate is not near when every letter of it differs.
            (distance <= limit && distance < candidate.chars().count()).then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Help for an unknown name: the nearest known one, or all, or the most similar of many. `kind` is their plural:
/// `bodies`. `None` if no known name is short enough to be shown.
pub fn help<'c>(name: &str, kind: &str, known: impl IntoIterator<Item = &'c str>) -> Option<String> {
    help_beside(name, kind, known, &[])
}

/// As [`help`]; the names `beside` are proposed like known ones, but not listed.
pub fn help_beside<'c>(
    name: &str,
    kind: &str,
    known: impl IntoIterator<Item = &'c str>,
    beside: &[&'c str],
) -> Option<String> {
    let known: Vec<&str> = known.into_iter().take(TUNING.names_known).collect();
    if let Some(near) = nearest(name, known.iter().chain(beside).copied()) {
        return Some(format!("did you mean `{near}`?"));
    }
    // One word of several: `spring` of `spring_damper`.
    let has_word = |known: &&&str| name.len() > 3 && known.split('_').any(|word| word == name);
    if let Some(whole) = known.iter().filter(has_word).min_by_key(|known| known.len()) {
        return Some(format!("did you mean `{whole}`?"));
    }
    let short: Vec<&str> = known.iter().copied().filter(|name| name.len() <= TUNING.name_length).collect();
    match short.as_slice() {
        _ if known.is_empty() => Some(format!("there are no {kind}")),
        [] => None,
        [one] if known.len() == 1 => Some(format!("there is only `{one}`")),
        all if all.len() == known.len() && all.len() <= TUNING.names_listed => {
            Some(format!("the {kind} are {}", list(all)))
        }
        _ => {
            let name = clip(name).to_lowercase();
            // Names with the same beginning are similar; the sort is stable.
            let likeness = |other: &str| strsim::jaro_winkler(&name, &other.to_lowercase());
            let mut alike: Vec<(f64, &str)> = short.into_iter().map(|other| (likeness(other), other)).collect();
            alike.sort_by(|a, b| b.0.total_cmp(&a.0));
            let few: Vec<&str> = alike.into_iter().take(TUNING.names_of_many).map(|(_, other)| other).collect();
            Some(format!("there are {} {kind}, most like it {}", known.len(), list(&few)))
        }
    }
}

/// The text that a help proposes instead of the marked one: a near name, or a quoted formula or interval.
pub fn replacement(help: &str) -> Option<&str> {
    let before =
        ["did you mean `", "quote the formula: `", "quote the interval: `", "quote the text: `", "with an index: `"];
    let begun = before.iter().find_map(|phrase| help.split_once(phrase)).map(|(_, rest)| rest)?;
    // A text that was too long to be shown is not known.
    begun.split_once('`').map(|(text, _)| text).filter(|text| !text.is_empty() && !text.contains('…'))
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
    let mut clipped: String = text
        .chars()
        .take(TUNING.name_length)
        .map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c })
        .collect();
    if text.chars().nth(TUNING.name_length).is_some() {
        clipped.push('…');
    }
    clipped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspellings_are_matched_and_unrelated_names_are_not() {
        let bodies = ["crank", "rod", "slider"];
        assert_eq!(nearest("crnk", bodies), Some("crank"));
        assert_eq!(nearest("CRANK", bodies), Some("crank"));
        assert_eq!(nearest("sildre", bodies), Some("slider"));
        assert_eq!(nearest("piston", bodies), None);
        assert_eq!(nearest("x", ["y"]), None);
        assert_eq!(nearest("l3", ["l1", "tau"]), Some("l1"));
        assert_eq!(help("piston", "bodies", bodies).unwrap(), "the bodies are `crank`, `rod` and `slider`");
        let many: Vec<String> = (0..50).map(|index| format!("point{index}")).chain(["wheel".to_owned()]).collect();
        let many = || many.iter().map(String::as_str);
        assert_eq!(
            help("whee_of_cart", "points", many()).unwrap(),
            "there are 51 points, most like it `wheel`, `point0` and `point1`"
        );
        assert_eq!(help("wing", "points", many().take(30)).unwrap().matches("point").count(), 31);
        assert_eq!(help("wing", "points", []).unwrap(), "there are no points");
        let kinds = ["torsional_spring_damper", "spring_damper", "gravity"];
        assert_eq!(help("spring", "kinds", kinds).unwrap(), "did you mean `spring_damper`?");
        assert_eq!(help_beside("enrgy", "parameters", ["l"], &["energy"]).unwrap(), "did you mean `energy`?");
        assert_eq!(clip(&"x".repeat(100)).chars().count(), 61);
    }
}
