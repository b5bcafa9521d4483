//! Text of others in a page: names, messages and models, with arbitrary contents.

use data_encoding::BASE64;
use serde_json::Value;

use crate::export::figure::style::STYLE;

/// Text between tags, or in an attribute with double quotes.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            c => safe.push(c),
        }
    }
    safe
}

/// JSON inside a script element, without anything that could end the element.
pub(super) fn script_json(value: &Value) -> String {
    // These occur in strings only; a browser reads the escapes as the same characters.
    let json = value.to_string();
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

/// An SVG document as an element of a page: without its declaration, its identifiers distinct from those of other
/// figures.
pub(super) fn inline_svg(document: &str, prefix: &str) -> String {
    let start = document.find("<svg").unwrap_or(0);
    let mut text = document[start..].trim_end().to_owned();
    for (from, to) in [
        (" id=\"", format!(" id=\"{prefix}")),
        ("url(#", format!("url(#{prefix}")),
        ("href=\"#", format!("href=\"#{prefix}")),
        ("labelledby=\"", format!("labelledby=\"{prefix}")),
    ] {
        text = text.replace(from, &to);
    }
    text
}

/// Elements of our own figures, and those among them that contain text only.
const ELEMENTS: [&str; 13] =
    ["svg", "g", "path", "rect", "circle", "line", "clipPath", "pattern", "defs", "text", "title", "style", "metadata"];
const TEXTS: [&str; 4] = ["text", "title", "style", "metadata"];

/// Whether an SVG document is only a figure as we write them: nothing in it acts, refers to anything elsewhere, or is
/// parsed by a browser differently. Files of a folder may be anyone's.
pub(super) fn is_figure(document: &str) -> bool {
    let start = document.find("<svg").unwrap_or(0);
    let text = &document[start..];
    // Comments, instructions and marked sections end elsewhere in HTML.
    if text.contains("<!") || text.contains("<?") {
        return false;
    }
    let Ok(parsed) = roxmltree::Document::parse(text) else { return false };
    let is_plain = |attribute: roxmltree::Attribute| {
        let (name, value) = (attribute.name(), attribute.value());
        let is_colour = |declaration: &str| declaration.trim().is_empty() || declaration.trim().starts_with("--mb-");
        match name {
            "style" => value.split(';').all(is_colour) && !value.contains("url("),
            "href" | "src" => false,
            _ => !name.to_ascii_lowercase().starts_with("on") && value.replace("url(#", "").find("url(").is_none(),
        }
    };
    let is_allowed = |element: roxmltree::Node| {
        let name = element.tag_name().name();
        let has_text_alone = !TEXTS.contains(&name) || element.children().all(|child| child.is_text());
        let is_our_style = name != "style" || element.text().is_some_and(|text| text.trim() == STYLE.trim());
        ELEMENTS.contains(&name) && has_text_alone && is_our_style && element.attributes().all(is_plain)
    };
    parsed.descendants().filter(roxmltree::Node::is_element).all(is_allowed)
}

/// An SVG document as the address of a picture.
pub(super) fn image(document: &str) -> String {
    format!("data:image/svg+xml;base64,{}", BASE64.encode(document.as_bytes()))
}

/// A number for people.
pub(super) fn number(value: &Value) -> String {
    let Some(value) = value.as_f64() else { return "unknown".to_owned() };
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        let digits = format!("{value:.5}");
        let short = format!("{value:.5e}").parse::<f64>().unwrap_or(value).to_string();
        return if short.len() < digits.len() + 4 { short } else { digits };
    }
    let text = format!("{value:.4e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{mantissa}·10<sup>{exponent}</sup>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_text_ends_no_script_or_attribute() {
        let hostile = "</script><img src=x onerror=\"alert('1')\">&\u{2028}";
        let text = escaped(hostile);
        assert!(!text.contains(['<', '>', '"', '\'']), "{text}");
        let json = script_json(&Value::String(hostile.to_owned()));
        assert!(!json.contains(['<', '>', '\u{2028}']), "{json}");
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), hostile);
    }

    #[test]
    fn figures_have_distinct_identifiers() {
        let svg = "<?xml version=\"1.0\"?>\n<svg><clipPath id=\"a\"/><g clip-path=\"url(#a)\"/></svg>\n";
        assert_eq!(inline_svg(svg, "s1-"), "<svg><clipPath id=\"s1-a\"/><g clip-path=\"url(#s1-a)\"/></svg>");
    }

    #[test]
    fn active_content_is_refused_in_figures() {
        let figure = |content: &str| {
            is_figure(&format!("<svg xmlns=\"http://www.w3.org/2000/svg\"><style>{STYLE}</style>{content}</svg>"))
        };
        for content in ["", "<g clip-path=\"url(#a)\" class=\"b\"><title>x &lt; 1</title><path d=\"M0,0\"/></g>"] {
            assert!(figure(content), "{content}");
        }
        for content in [
            "<script>alert(1)</script>",
            "<g onclick=\"alert(1)\"/>",
            "<g ONLOAD=\"alert(1)\"/>",
            "<a href=\"javascript:alert(1)\"><text>x</text></a>",
            "<path fill=\"url(http://a.b/c)\"/>",
            "<g style=\"background: url(x)\"/>",
            "<style>body { display: none }</style>",
            "<foreignObject><p>x</p></foreignObject>",
            "<title><g/></title>",
            "<!--> <img src=x> -->",
            "<![CDATA[x]]>",
            "<g>",
        ] {
            assert!(!figure(content), "{content}");
        }
    }

    #[test]
    fn numbers_are_short() {
        let shown = |value: f64| number(&Value::from(value));
        assert_eq!([shown(0.15), shown(0.0), shown(1234.5)], ["0.15", "0", "1234.5"]);
        assert_eq!(shown(1.25e-7), "1.25·10<sup>-7</sup>");
        assert_eq!(number(&Value::Null), "unknown");
    }
}
