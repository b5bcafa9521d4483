//! `mbint explain --methods`: every bounding method, from the registry.

use serde::Serialize;

use super::console::BOLD;
use crate::methods::{About, Method};
use crate::overview::{Align, Table};

/// Documentation of a method for people.
#[derive(Debug, Serialize)]
pub(super) struct MethodDocs {
    keyword: &'static str,
    description: &'static str,
    source: &'static str,
    /// Names and descriptions of its keys; empty if only the command line can request it.
    keys: Vec<(String, String)>,
}

/// All methods, in the order in which they are reported.
pub(super) fn all() -> Vec<MethodDocs> {
    let docs = |method: Method| {
        let About { summary, source, .. } = *method.about();
        MethodDocs { keyword: method.name(), description: summary, source, keys: keys(method) }
    };
    Method::ALL.map(docs).into()
}

fn keys(method: Method) -> Vec<(String, String)> {
    let schema = method.schema();
    let properties = schema.as_ref().and_then(|schema| schema.get("properties")).and_then(|keys| keys.as_object());
    let description = |key: &serde_json::Value| {
        let text = key.get("description").and_then(|text| text.as_str()).unwrap_or_default();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    properties.into_iter().flatten().map(|(name, key)| (name.clone(), description(key))).collect()
}

/// All methods, for people.
pub(super) fn text() -> String {
    let paragraph = |MethodDocs { keyword, description, source, keys }: MethodDocs| {
        let mut table = Table::new([("", Align::Left), ("", Align::Left)]);
        keys.into_iter().for_each(|(name, description)| table.row([name, description]));
        format!("{BOLD}{keyword}{BOLD:#}: {description}\n{}  {source}\n", table.render(2))
    };
    all().into_iter().map(paragraph).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_and_key_is_documented() {
        for MethodDocs { keyword, description, source, keys } in all() {
            assert!(!description.is_empty() && !source.is_empty(), "{keyword}");
            assert!(keys.iter().all(|(_, description)| !description.is_empty()), "{keyword}: {keys:?}");
            assert_eq!(keys.is_empty(), keyword == "certified", "only that has no keys");
        }
    }
}
