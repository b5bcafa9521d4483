//! Verdicts as JUnit XML, which CI systems show as tests: of requirements, and of a verification.

use std::io::Write;
use std::path::Path;

use quick_xml::Writer;
use quick_xml::events::BytesText;

use super::error::ExportError;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{FormulationVerification, RequirementSummary, Verdict, Verification};

/// The tests of a model.
pub struct Suite {
    /// Name of the model, and of the scene after a slash.
    model: String,
    cases: Vec<Case>,
}

/// A test.
struct Case {
    name: String,
    /// `None` if it passed.
    fault: Option<Fault>,
}

/// Reason why a test did not pass.
struct Fault {
    /// `failure`, or `error` if undecided.
    element: &'static str,
    message: String,
    text: String,
}

impl Suite {
    /// Tests of a model's requirements: a violated one is a failure, an undecided one an error.
    pub fn of_requirements(model: &str, requirements: &[RequirementSummary]) -> Self {
        Self { model: model.to_owned(), cases: requirements.iter().map(of_requirement).collect() }
    }

    /// Test of a run that failed.
    pub fn failed(model: &str, why: &str) -> Self {
        let fault = Fault { element: "error", message: "the run failed".to_owned(), text: why.to_owned() };
        Self { model: model.to_owned(), cases: vec![Case { name: "run".to_owned(), fault: Some(fault) }] }
    }

    /// Tests of a verification: one for each quantity, scheme and formulation, and one for each balance of power.
    pub fn of_verification(found: &Verification) -> Self {
        Self { model: found.model.clone(), cases: found.formulations.iter().flat_map(of_formulation).collect() }
    }

    fn count(&self, element: &str) -> String {
        self.cases
            .iter()
            .filter_map(|case| case.fault.as_ref())
            .filter(|own| own.element == element)
            .count()
            .to_string()
    }
}

fn of_requirement(own: &RequirementSummary) -> Case {
    let unit = ShownUnit::of(&own.display, &own.unit);
    let [margin, error] = [own.margin, own.error].map(|value| unit.of_si(value));
    let text = format!("{}\nmargin: {margin:e} {}, error: {error:e}", own.text, unit.text);
    let fault = |element, message: &str, last: &str| {
        Some(Fault { element, message: message.to_owned(), text: format!("{text}\n{last}") })
    };
    let fault = match own.verdict {
        Verdict::Holds => None,
        Verdict::Violated => {
            fault("failure", "violated", own.nearest.as_ref().map_or("", |nearest| nearest.command.as_str()))
        }
        Verdict::Undecided => {
            fault("error", "undecided", &format!("it takes {}", own.decides.as_deref().unwrap_or_default()))
        }
    };
    Case { name: own.name.clone(), fault }
}

fn of_formulation(own: &FormulationVerification) -> Vec<Case> {
    let from = if own.begin > 0.0 { format!(" from {} s on", own.begin) } else { String::new() };
    let formulation = &format!("{}{from}", own.formulation);
    let error = |why: &String| Fault { element: "error", message: "not verified".to_owned(), text: why.clone() };
    if let Some(why) = &own.failure {
        return vec![Case { name: formulation.clone(), fault: Some(error(why)) }];
    }
    let mut cases = Vec::new();
    for scheme in &own.schemes {
        let name = format!("{formulation}, {}", scheme.scheme);
        if let Some(why) = &scheme.failure {
            cases.push(Case { name, fault: Some(error(why)) });
            continue;
        }
        cases.extend(scheme.convergence.iter().map(|found| {
            let fault = (!found.is_verified).then(|| Fault {
                element: "failure",
                message: "not as in theory".to_owned(),
                text: found.errors.iter().fold(format!("order {} of theory", found.theory), |text, (step, error)| {
                    format!("{text}\nstep {step:e} s, error {error:e}")
                }),
            });
            Case { name: format!("{name}: {}", found.quantity.name()), fault }
        }));
    }
    cases.extend(own.derivatives.iter().map(|check| {
        let fault = (!check.is_verified()).then(|| Fault {
            element: "failure",
            message: "not the derivative".to_owned(),
            text: format!("largest difference {:e} of {} derivatives", check.difference, check.derivatives),
        });
        Case { name: format!("{formulation}, derivatives: {} by {}", check.of, check.by), fault }
    }));
    cases.extend(own.balance.as_ref().map(|balance| {
        let fault = (!balance.is_verified()).then(|| Fault {
            element: "failure",
            message: "not balanced".to_owned(),
            text: format!("powers are off by {:e} of {:e} W", balance.defect, balance.size),
        });
        Case { name: format!("{formulation}: power"), fault }
    }));
    cases
}

/// Writes all suites.
///
/// # Errors
/// If the file cannot be written.
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
    let [failures, errors] = ["failure", "error"].map(|element| suite.count(element));
    let tests = suite.cases.len().to_string();
    let attributes = [
        ("name", suite.model.as_str()),
        ("tests", tests.as_str()),
        ("failures", failures.as_str()),
        ("errors", errors.as_str()),
    ];
    writer
        .create_element("testsuite")
        .with_attributes(attributes)
        .write_inner_content(|writer| suite.cases.iter().try_for_each(|own| write_case(writer, &suite.model, own)))?;
    Ok(())
}

/// Writes a test, with its fault.
fn write_case(writer: &mut Writer<Vec<u8>>, class: &str, own: &Case) -> std::io::Result<()> {
    let element =
        writer.create_element("testcase").with_attributes([("classname", class), ("name", own.name.as_str())]);
    match &own.fault {
        None => element.write_empty()?,
        Some(fault) => element.write_inner_content(|writer| {
            writer
                .create_element(fault.element)
                .with_attribute(("message", fault.message.as_str()))
                .write_text_content(BytesText::new(&fault.text))?;
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
        let suite = Suite::of_requirements("crank", &requirements);
        let failed = Suite::failed("rod", "a & b");
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
