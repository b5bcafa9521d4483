//! The page's files: its own, and the report's modules that it uses.

use super::answer::Answer;
use crate::export::{REPORT_STYLE, report_module};

const PAGE: &str = include_str!("page/studio.html");
const STYLE: &str = include_str!("page/studio.css");

/// Style of the edited text, which the playground shares.
const EDITOR_STYLE: &str = include_str!("page/editor.css");

/// The page's modules, with their names.
const MODULES: [(&str, &str); 9] = [
    ("studio.js", include_str!("page/studio.js")),
    ("server.js", include_str!("page/server.js")),
    ("editor.js", include_str!("page/editor.js")),
    ("overlay.js", include_str!("page/overlay.js")),
    ("assist.js", include_str!("page/assist.js")),
    ("problems.js", include_str!("page/problems.js")),
    ("stage.js", include_str!("page/stage.js")),
    ("curves.js", include_str!("page/curves.js")),
    ("sliders.js", include_str!("page/sliders.js")),
];

/// A file by its name; the page itself for an empty name.
pub fn file(name: &str) -> Option<Answer> {
    match name {
        "" => Some(Answer::part("text/html; charset=utf-8", PAGE)),
        "style.css" => Some(Answer::part("text/css; charset=utf-8", [REPORT_STYLE, STYLE, EDITOR_STYLE].concat())),
        name => {
            let own = MODULES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text);
            let text = own.or_else(|| report_module(name))?;
            Some(Answer::part("text/javascript; charset=utf-8", text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_imported_modules_are_served_under_distinct_names() {
        for (name, text) in MODULES {
            assert!(report_module(name).is_none(), "{name}");
            for import in text.split("from './").skip(1) {
                let import = import.split('\'').next().unwrap();
                assert!(file(import).is_some(), "{name} imports {import}");
            }
            // The namespace of SVG is not a request.
            assert!(!text.replace("http://www.w3.org/2000/svg", "").contains("http"), "{name}");
        }
        assert!(file("main.rs").is_none() && file("../studio.js").is_none());
    }
}
