//! Verdicts as JUnit XML, which CI systems show as tests.

use std::io::Write;
use std::path::Path;

use quick_xml::Writer;
use quick_xml::events::BytesText;

use super::error::ExportError;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{RequirementSummary, Verdict};

/// A model's requirements.
pub struct Suite {
    /// Name of the model, and of the scene after a slash.
    pub model: String,
    /// With their verdicts.
    pub requirements: Vec<RequirementSummary>,
    /// Why there are none, where the run failed.
    pub failure: Option<String>,
}

/// Writes all of them: a violated requirement is a failure, an undecided one and a failed run are errors.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_junit(path: &Path, suites: &[Suite]) -> Result<(), ExportError> {
    let written = junit(suites).and_then(|text| std::fs::write(path, text));
    written.map_err(|source| ExportError::Write { path: path.to_owned(), source })
}

fn junit(suites: &[Suite]) -> std::io::Result<Vec<u8>> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    writer.get_mut().write_all(b"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n")?;
    writer
        .create_element("testsuites")
        .with_attribute(("name", "mbint"))
        .write_inner_content(|writer| suites.iter().try_for_each(|suite| write_suite(writer, suite)))?;
    let mut text = writer.into_inner();
    text.push(b'\n');
    Ok(text)
}

fn write_suite(writer: &mut Writer<Vec<u8>>, suite: &Suite) -> std::io::Result<()> {
    let count = |verdict: Verdict| suite.requirements.iter().filter(|own| own.verdict == verdict).count();
    let failed = usize::from(suite.failure.is_some());
    let tests = (suite.requirements.len() + failed).to_string();
    let failures = count(Verdict::Violated).to_string();
    let errors = (count(Verdict::Undecided) + failed).to_string();
    let attributes = [
        ("name", suite.model.as_str()),
        ("tests", tests.as_str()),
        ("failures", failures.as_str()),
        ("errors", errors.as_str()),
    ];
    writer.create_element("testsuite").with_attributes(attributes).write_inner_content(|writer| {
        if let Some(failure) = &suite.failure {
            case(writer, (&suite.model, "run"), Some(("error", "the run failed", failure)))?;
        }
        for own in &suite.requirements {
            let unit = ShownUnit::of(&own.display, &own.unit);
            let [margin, error] = [own.margin, own.error].map(|value| unit.of_si(value));
            let text = format!("{}\nmargin: {margin:e} {}, error: {error:e}", own.text, unit.text);
            let command = own.nearest.as_ref().map_or("", |nearest| nearest.command.as_str());
            let with_command = format!("{text}\n{command}");
            let decides = format!("{text}\nit takes {}", own.decides.as_deref().unwrap_or_default());
            let outcome = match own.verdict {
                Verdict::Holds => None,
                Verdict::Violated => Some(("failure", "violated", with_command.as_str())),
                Verdict::Undecided => Some(("error", "undecided", decides.as_str())),
            };
            case(writer, (&suite.model, &own.name), outcome)?;
        }
        Ok(())
    })?;
    Ok(())
}

/// A test, with what went wrong: the element's name, its message and its text.
fn case(
    writer: &mut Writer<Vec<u8>>,
    (class, name): (&str, &str),
    outcome: Option<(&str, &str, &str)>,
) -> std::io::Result<()> {
    let element = writer.create_element("testcase").with_attributes([("classname", class), ("name", name)]);
    match outcome {
        None => element.write_empty()?,
        Some((kind, message, text)) => element.write_inner_content(|writer| {
            writer
                .create_element(kind)
                .with_attribute(("message", message))
                .write_text_content(BytesText::new(text))?;
            Ok(())
        })?,
    };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_are_tests() {
        let own = |name: &str, text: &str, verdict| RequirementSummary {
            name: name.to_owned(),
            text: text.to_owned(),
            unit: "m".to_owned(),
            display: None,
            verdict,
            certified: false,
            margin: 0.5,
            percent: None,
            error: 1e-3,
            surrogate: 0.0,
            time: 0.0,
            method: "chebyshev".to_owned(),
            nearest: None,
            decides: Some("shorter steps".to_owned()),
            limits: vec![],
        };
        let requirements = vec![own("a", "x >= 1 m", Verdict::Holds), own("b", "x < 1 m", Verdict::Undecided)];
        let suite = Suite { model: "crank".to_owned(), requirements, failure: None };
        let failed = Suite { model: "rod".to_owned(), requirements: vec![], failure: Some("a & b".to_owned()) };
        let text = String::from_utf8(junit(&[suite, failed]).unwrap()).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let of = |name: &'static str| document.descendants().filter(move |node| node.has_tag_name(name));
        assert_eq!(of("testcase").count(), 3);
        assert_eq!(
            of("error").map(|node| node.text().unwrap()).collect::<Vec<_>>(),
            ["x < 1 m\nmargin: 5e-1 m, error: 1e-3\nit takes shorter steps", "a & b"]
        );
        assert_eq!(of("testsuite").next().unwrap().attribute("errors"), Some("1"));
    }
}
