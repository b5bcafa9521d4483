//! The table of the format: as the guide has it, and one rule for each element.

use std::fmt::Write;
use std::path::Path;

use super::format::Fate;
use super::table::rules;

const MARK: &str = "<!-- table: made from the reader's own by `MBINT_UPDATE_DOCS=1 cargo test --lib mjcf` -->\n";

fn table() -> String {
    let quoted = |names: &str| names.split_whitespace().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" ");
    let mut table = "\n| element | in | supported | ignored | refused |\n|---|---|---|---|---|\n".to_owned();
    for rule in rules() {
        let (mut ignored, mut refused) = (Vec::new(), Vec::new());
        match rule.fate {
            Fate::Supported => {}
            Fate::Ignored(why) => ignored.push(format!("all: {why}")),
            Fate::Refused(why) => refused.push(format!("all: {why}")),
        }
        for (names, why) in rule.ignored {
            ignored.push(if why.is_empty() { quoted(names) } else { format!("{}: {why}", quoted(names)) });
        }
        for (names, harmless, why) in rule.refused {
            let but = if harmless.is_empty() { String::new() } else { format!(" (`{harmless}`)") };
            refused.push(format!("{}{but}: {why}", quoted(names)));
        }
        let (tag, within, supported) = (rule.tag, quoted(rule.within), quoted(rule.supported));
        let (ignored, refused) = (ignored.join("<br>"), refused.join("<br>"));
        writeln!(table, "| `<{tag}>` | {within} | {supported} | {ignored} | {refused} |").unwrap();
    }
    table
}

#[test]
fn the_guide_has_the_readers_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guides/mjcf.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let (before, found) = text.split_once(MARK).unwrap();
    if std::env::var_os("MBINT_UPDATE_DOCS").is_some() {
        std::fs::write(&path, format!("{before}{MARK}{}", table())).unwrap();
        return;
    }
    assert_eq!(found, table(), "MBINT_UPDATE_DOCS=1 cargo test --lib mjcf");
}

#[test]
fn each_element_has_one_rule_per_parent() {
    let mut places: Vec<(&str, &str)> =
        rules().flat_map(|rule| rule.within.split_whitespace().map(|within| (rule.tag, within))).collect();
    places.sort_unstable();
    let count = places.len();
    places.dedup();
    assert_eq!(places.len(), count);
    for rule in rules() {
        let mut names: Vec<&str> = rule.attributes().collect();
        names.sort_unstable();
        let twice = names.windows(2).find(|pair| pair[0] == pair[1]);
        assert_eq!(twice, None, "{}", rule.tag);
    }
}
