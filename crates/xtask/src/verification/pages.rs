//! The pages of the report, from the measurements alone.

use std::fmt::Write;

use super::claims::{CLAIMS, Claim, Table};
use super::interval::{CONFIDENCE, clopper_pearson};
use super::record::{Case, Figure, Record, Section};
use super::verdict::Verdict;

/// Section of missed bands, which is not a claim.
pub const MISSES: &str = "misses";

/// A page: the name of its file, and its text.
pub type Page = (String, String);

/// The summary, a page a claim, and known misses.
pub fn all(record: &Record) -> Vec<Page> {
    let numbered = CLAIMS.iter().enumerate();
    let mut pages = vec![("index.md".to_owned(), summary(record))];
    pages.extend(numbered.map(|(index, claim)| (format!("{}.md", claim.name), section(index + 1, claim, record))));
    pages.push((format!("{MISSES}.md"), misses(record)));
    pages
}

/// The section of a claim; `None` if nothing ran.
fn of<'r>(record: &'r Record, claim: &str) -> Option<&'r Section> {
    record.sections.iter().find(|section| section.claim == claim)
}

/// The verdict on a claim.
pub fn verdict(record: &Record, claim: &Claim) -> Verdict {
    of(record, claim.name).map_or(Verdict::NotMeasured, Section::verdict)
}

const HEAD: &str = "# Verification report

Claims about the program, each with its set-up, acceptance criterion, result and limits, in the vocabulary of ASME V&V 10 and 20 and of NAFEMS: *code verification* asks
whether equations are solved as theory tells, *solution verification* whether stated errors hold, *validation* whether a model has the values that were measured on its mechanism. All
figures are measured by the command that writes these pages, `cargo xtask verification`; they stand with full digits in
[measured.json](measured.json). A verdict follows from figures and limits alone.

";

fn summary(record: &Record) -> String {
    let on = &record.on;
    let mut page = HEAD.to_owned();
    let rows = [
        ("program", format!("mbint {}, commit `{}`", on.version, on.commit)),
        ("day of the run", on.date.clone()),
        ("build", format!("{}, {}", on.profile, on.compiler)),
        ("processor", on.processor.clone()),
        ("command", format!("`{}`", on.command)),
    ];
    page += "| | |\n|---|---|\n";
    rows.iter().for_each(|(name, value)| writeln!(page, "| {name} | {value} |").expect(STRINGS));
    page += "\n| | claim | activity | cases | excepted | verdict |\n|--:|---|---|--:|--:|---|\n";
    for (index, claim) in CLAIMS.iter().enumerate() {
        let cases = of(record, claim.name).map_or(&[][..], |section| &section.cases);
        let excepted = cases.iter().filter(|case| case.exception.is_some()).count();
        let verdict = verdict(record, claim).name();
        writeln!(
            page,
            "| {} | [{}]({}.md) | {} | {} | {excepted} | {verdict} |",
            index + 1,
            claim.title,
            claim.name,
            claim.activity,
            cases.len() - excepted
        )
        .expect(STRINGS);
    }
    page += "\nAn *excepted* case is one that the claim does not cover, with its reason; all of them stand among [known misses](misses.md). *Undecided* means that the limit lies in the \
             interval of confidence, *not measured* that this machine lacks something.\n";
    page
}

/// Reason why writing cannot fail.
const STRINGS: &str = "a string can be written";

fn section(number: usize, claim: &Claim, record: &Record) -> String {
    let mut page = format!("# {number}. {}\n\n", claim.title);
    let verdict = verdict(record, claim).name();
    for (name, text) in [
        ("Claim", claim.claim),
        ("Activity", claim.activity),
        ("Set-up", claim.setup),
        ("Acceptance", claim.acceptance),
        ("Verdict", verdict),
        ("Scope and limits", claim.scope),
    ] {
        writeln!(page, "**{name}.** {text}{}\n", if text.ends_with(['.', ')']) { "" } else { "." }).expect(STRINGS);
    }
    let Some(section) = of(record, claim.name) else { return page + "Nothing was run.\n" };
    if let Some(on) = &section.apart {
        let words = format!("commit `{}`, {}, {}, {}", on.commit, on.date, on.profile, on.processor);
        writeln!(page, "**Measured apart.** By `{}`: {words}.\n", on.command).expect(STRINGS);
    }
    page += "## Result\n\n";
    for run in section.runs.iter().filter(|run| run.error.is_some() || run.left_out.is_some()) {
        let [said, why] = match (&run.error, &run.left_out) {
            (Some(error), _) => ["**failed**", error],
            (None, why) => ["not measured here", why.as_deref().unwrap_or_default()],
        };
        writeln!(page, "`{}`: {said}: {}\n", run.command, cell(why)).expect(STRINGS);
    }
    let covered: Vec<&Case> = section.cases.iter().filter(|case| case.exception.is_none()).collect();
    match claim.table {
        Table::Cases => page += &table_of_cases(&covered),
        Table::Extremes => page += &table_of_extremes(&covered),
    }
    if covered.iter().flat_map(|case| &case.figures).any(|figure| figure.count.is_some()) {
        writeln!(page, "\nShares stand with Clopper and Pearson's interval of {} % confidence.", 100.0 * CONFIDENCE)
            .expect(STRINGS);
    }
    let excepted = section.cases.len() - covered.len();
    if excepted > 0 {
        writeln!(page, "\nExcepted, with their reasons: {excepted} cases among [known misses]({MISSES}.md).")
            .expect(STRINGS);
    }
    page += "\n## Commands\n\n";
    let ran = section.runs.iter().filter(|run| run.left_out.is_none());
    for run in ran {
        let tests = match run.passed + run.failed {
            0 => String::new(),
            tests => format!(" ({} of {tests} passed)", run.passed),
        };
        writeln!(page, "- `{}`{tests}", run.command).expect(STRINGS);
    }
    page
}

/// Names of figures of all cases, in the order in which they come.
fn names<'c>(cases: &[&'c Case]) -> Vec<&'c str> {
    let mut names = Vec::new();
    for figure in cases.iter().flat_map(|case| &case.figures) {
        if !names.contains(&figure.name.as_str()) {
            names.push(&figure.name);
        }
    }
    names
}

fn table_of_cases(cases: &[&Case]) -> String {
    let names = names(cases);
    let is_sourced = cases.iter().any(|case| case.source.is_some());
    let mut head = vec!["case"];
    head.extend(&names);
    head.extend(is_sourced.then_some("against"));
    head.push("verdict");
    let mut table = row(&head.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>());
    table += &format!("|---|{}{}---|\n", "--:|".repeat(names.len()), if is_sourced { "---|" } else { "" });
    for case in cases {
        let mut cells = vec![cell(&case.case)];
        let of = |name: &&str| case.figures.iter().find(|figure| figure.name == *name).map_or(String::new(), shown);
        cells.extend(names.iter().map(of));
        cells.extend(is_sourced.then(|| cell(case.source.as_deref().unwrap_or_default())));
        cells.push(case.verdict().name().to_owned());
        table += &row(&cells);
    }
    table
}

fn table_of_extremes(cases: &[&Case]) -> String {
    let mut table = format!(
        "{} cases.\n\n| figure | cases | least | greatest | limit | not kept by |\n|---|--:|--:|--:|---|---|\n",
        cases.len()
    );
    for name in names(cases) {
        let figures = |case: &&&Case| case.figures.iter().any(|figure| figure.name == name);
        let with: Vec<&&Case> = cases.iter().filter(figures).collect();
        let all: Vec<&Figure> =
            with.iter().flat_map(|case| &case.figures).filter(|figure| figure.name == name).collect();
        let values = || all.iter().filter_map(|figure| figure.value);
        if values().next().is_none() {
            continue;
        }
        let [least, greatest] = [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)];
        let limit = all.iter().find_map(|figure| limit(figure)).unwrap_or_default();
        let fails = |case: &&&&Case| case.figures.iter().any(|own| own.name == name && own.verdict() == Verdict::Fails);
        let failing: Vec<&str> = with.iter().filter(fails).map(|case| case.case.as_str()).collect();
        table += &row(&[
            name.to_owned(),
            values().count().to_string(),
            number(least),
            number(greatest),
            limit,
            failing.join(", "),
        ]);
    }
    table
}

fn misses(record: &Record) -> String {
    let mut page = "# Known misses\n\nCases that the claims do not cover, and answers that are known to be wrong. Kinds of misses and their causes are told in \
                    [falsification](../theory/falsification.md) and in [limits of bounds](../guides/bounds.md).\n\n## Missed bands of this run\n\n"
        .to_owned();
    match of(record, MISSES).map(|section| section.cases.iter().collect::<Vec<_>>()) {
        Some(cases) if !cases.is_empty() => page += &table_of_cases(&cases),
        _ => page += "None.\n",
    }
    page += "\n## Excepted cases\n\n";
    let sections = CLAIMS.iter().filter_map(|claim| Some((claim, of(record, claim.name)?)));
    let excepted: Vec<String> = sections
        .flat_map(|(claim, section)| section.cases.iter().map(move |case| (claim, case)))
        .filter_map(|(claim, case)| {
            let why = case.exception.as_deref()?;
            Some(row(&[format!("[{}]({}.md)", claim.title, claim.name), cell(&case.case), cell(why)]))
        })
        .collect();
    if excepted.is_empty() {
        return page + "None.\n";
    }
    page + "| claim | case | reason |\n|---|---|---|\n" + &excepted.concat()
}

fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// Text of a cell of a table, on one line.
fn cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// A figure with its limit.
fn shown(figure: &Figure) -> String {
    if let (Some(count), Some(of)) = (figure.count, figure.of) {
        let [lower, upper] = clopper_pearson(count, of).map(|share| 100.0 * share);
        return format!("{count} of {of}: {lower:.2} to {upper:.2} %");
    }
    let value = match (&figure.text, figure.value) {
        (Some(text), _) => cell(text),
        (None, Some(value)) => number(value),
        (None, None) => "–".to_owned(),
    };
    match limit(figure) {
        Some(limit) => format!("{value} ({limit})"),
        None => value,
    }
}

fn limit(figure: &Figure) -> Option<String> {
    match (figure.low, figure.high) {
        (Some(low), Some(high)) => Some(format!("{} to {}", number(low), number(high))),
        (Some(low), None) => Some(format!("≥ {}", number(low))),
        (None, Some(high)) => Some(format!("≤ {}", number(high))),
        (None, None) => None,
    }
}

/// Integers unchanged, others to three digits, large ones to four.
fn number(value: f64) -> String {
    let size = value.abs();
    if value.fract() == 0.0 && size < 1e9 {
        format!("{value:.0}")
    } else if (1e-2..1e5).contains(&size) {
        let digits = if size < 1.0 { 3 } else { 2 };
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}").replace(".0e", "e")
    }
}
