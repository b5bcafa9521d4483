//! `docs/reference/methods.md`: every bounding method, from the list of `mbint explain --methods`.

use serde_json::Value;

/// The page.
pub fn page(methods: &str) -> String {
    let methods: Vec<Value> = serde_json::from_str(methods).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let mut page = "# Methods\n\nWhat `bounds:` may ask for, as `mbint explain --methods` lists it.\n".to_owned();
    for method in &methods {
        page += &format!("\n## {}\n\nBounds: {}.\n\n", text(&method["keyword"]), text(&method["description"]));
        let keys = method["keys"].as_array().unwrap();
        if keys.is_empty() {
            page += "It has no keys in a model: `--certify` on the command line asks for it.\n\n";
        } else {
            page += "| key | |\n|---|---|\n";
        }
        for key in keys {
            page += &format!("| `{}` | {} |\n", text(&key[0]), text(&key[1]).replace('|', "\\|"));
        }
        let gap = if keys.is_empty() { "" } else { "\n" };
        page += &format!("{gap}Source: {}.\n", text(&method["source"]).trim_end_matches('.'));
    }
    page
}
