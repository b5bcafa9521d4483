//! A page of tables and figures without scripts, which prints: the answer to one question.

use super::html::{escaped, inline_svg};
use super::script::REPORT_STYLE;

/// A part of the page.
pub enum Section {
    /// A sentence.
    Text(String),
    /// A heading, the columns' headings, and rows of cells.
    Table(&'static str, Vec<String>, Vec<Vec<String>>),
    /// An SVG document of ours.
    Figure(String),
}

/// The page.
pub fn plain_page(title: &str, sections: &[Section]) -> String {
    let content: String = sections.iter().enumerate().map(|(index, section)| section.html(index)).collect();
    let title = escaped(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title} – mbint</title>\n\
         <style>{REPORT_STYLE}</style>\n</head>\n<body>\n<header><div class=\"title\"><h1>{title}</h1></div></header>\n\
         <main>\n<article class=\"scene\">\n{content}</article>\n</main>\n\
         <footer>Made by mbint {}. Nothing on this page comes from elsewhere.</footer>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    )
}

impl Section {
    fn html(&self, index: usize) -> String {
        match self {
            Self::Text(text) => format!("<p>{}</p>\n", escaped(text)),
            Self::Figure(svg) => format!("<div class=\"plot\">{}</div>\n", inline_svg(svg, &format!("f{index}-"))),
            Self::Table(heading, columns, rows) => {
                let cells = |tag: &str, cells: &[String]| -> String {
                    cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect()
                };
                let rows: String = rows.iter().map(|row| format!("<tr>{}</tr>\n", cells("td", row))).collect();
                format!(
                    "<section><h2>{}</h2>\n<table><thead><tr>{}</tr></thead>\n<tbody>\n{rows}</tbody></table></section>\n",
                    escaped(heading),
                    cells("th", columns)
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped() {
        let table = Section::Table("a", vec!["<b>".to_owned()], vec![vec!["<script>".to_owned()]]);
        let page = plain_page("<i>", &[table, Section::Text("x < 1".to_owned())]);
        assert!(page.contains("<td>&lt;script&gt;</td>") && page.contains("x &lt; 1") && !page.contains("<script>"));
    }
}
