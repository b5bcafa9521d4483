//! The scripts and the style of a report. The scripts are modules for development and checks, and one script in a page.

use std::sync::LazyLock;

/// The style.
pub const REPORT_STYLE: &str = include_str!("style.css");

/// The modules with their names, each after those that it imports.
const MODULES: [(&str, &str); 14] = [
    ("data.js", include_str!("data.js")),
    ("vectors.js", include_str!("vectors.js")),
    ("motion.js", include_str!("motion.js")),
    ("solids.js", include_str!("solids.js")),
    ("renderer.js", include_str!("renderer.js")),
    ("camera.js", include_str!("camera.js")),
    ("mechanism.js", include_str!("mechanism.js")),
    ("clock.js", include_str!("clock.js")),
    ("regions.js", include_str!("regions.js")),
    ("plots.js", include_str!("plots.js")),
    ("slopes.js", include_str!("slopes.js")),
    ("controls.js", include_str!("controls.js")),
    ("view.js", include_str!("view.js")),
    ("main.js", include_str!("main.js")),
];

/// A module, for a page that is served and loads its modules itself.
pub fn report_module(name: &str) -> Option<&'static str> {
    MODULES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// All modules as one script, without their imports from each other.
pub(super) static SCRIPT: LazyLock<String> = LazyLock::new(|| MODULES.map(|(_, text)| plain(text)).concat());

/// A module without imports, comments, and the word `export`.
fn plain(module: &str) -> String {
    let mut text = String::with_capacity(module.len());
    let mut in_comment = false;
    for line in module.lines() {
        let code = line.trim_start();
        let comment = code.starts_with("//") || code.starts_with("/*") || in_comment;
        in_comment = (in_comment || code.starts_with("/*")) && !code.ends_with("*/");
        if comment || code.is_empty() || code.starts_with("import ") {
            continue;
        }
        text += code.strip_prefix("export ").unwrap_or(code);
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_become_one_script() {
        let module = "// A comment.\nimport { a } from './a.js';\n\n/**\n * About b.\n */\nexport const b = a;\n";
        assert_eq!(plain(module), "const b = a;\n");
    }

    #[test]
    fn the_script_is_small_and_cannot_end_early() {
        assert!(SCRIPT.len() < 65_000, "{}", SCRIPT.len());
        assert!(!SCRIPT.to_lowercase().contains("</script") && !SCRIPT.contains("<!--"));
        assert!(
            !SCRIPT.contains("http:") && !SCRIPT.contains("https:")
                || SCRIPT.matches("http").count() == SCRIPT.matches("http://www.w3.org/").count()
        );
    }
}
