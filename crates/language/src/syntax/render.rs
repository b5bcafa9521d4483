//! Diagnostics as text, in the style of rustc, through `annotate-snippets`.

use std::collections::HashMap;
use std::ops::Range;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use super::diagnostic::{Diagnostic, Diagnostics, Severity};
use super::habit::{Habit, owner};
use super::harmless::{harmless, is_harmful};
use super::source::{LineColumn, Source};
use crate::syntax::tuning::TUNING;

/// Begins a colour; text from a file never has it in the rendered text.
const ESCAPE: char = '\u{1b}';

impl Diagnostics {
    /// All as text for people, each with its line and marker; in colour or plain. Ends with a newline unless empty.
    /// The only control characters are those of the colours.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let mut text = String::new();
        let shown = self.distinct();
        for (diagnostic, repeated) in shown.iter().take(TUNING.diagnostics_shown) {
            let note = self.note(diagnostic, repeated);
            let diagnostic = diagnostic.harmless();
            let (report, moved) = self.report(&diagnostic, note.as_deref());
            let mut rendered = renderer.render(&report);
            for (shown, meant) in moved {
                rendered = rendered.replacen(&shown, &meant, 1);
            }
            // The renderer shows the control characters of an excerpt by pictures, except for some.
            text += &rendered.replace(|c| is_harmful(c) && c != ESCAPE, "\u{fffd}");
            text += "\n\n";
        }
        let hidden = shown.len().saturating_sub(TUNING.diagnostics_shown);
        if hidden > 0 {
            text += &format!("… and {hidden} more\n\n");
        }
        text.truncate(text.trim_end().len());
        if !text.is_empty() {
            text.push('\n');
        }
        text
    }

    /// All diagnostics; for a message that occurs often, only the first, with the others.
    fn distinct(&self) -> Vec<(&Diagnostic, Vec<&Diagnostic>)> {
        let mut distinct: Vec<(&Diagnostic, Vec<&Diagnostic>)> = Vec::new();
        let mut first: HashMap<Habit, usize> = HashMap::new();
        let mut counts: HashMap<Habit, usize> = HashMap::new();
        for diagnostic in self.iter() {
            *counts.entry(Habit::of(diagnostic)).or_default() += 1;
        }
        for diagnostic in self.iter() {
            let key = Habit::of(diagnostic);
            match first.get(&key) {
                Some(&index) if counts[&key] >= TUNING.occurrences => distinct[index].1.push(diagnostic),
                _ => {
                    first.entry(key).or_insert(distinct.len());
                    distinct.push((diagnostic, Vec::new()));
                }
            }
        }
        distinct
    }

    /// Note with the lines of the other occurrences of a message.
    fn note(&self, of: &Diagnostic, repeated: &[&Diagnostic]) -> Option<String> {
        if repeated.is_empty() {
            return None;
        }
        let places = repeated.iter().filter_map(|diagnostic| self.sources.locate(diagnostic.span.as_ref()?));
        let mut lines: Vec<String> = places
            .map(|(source, span)| {
                let line = source.place(span.start).line;
                let first = self.sources.first().is_some_and(|first| std::ptr::eq(first, source));
                if first { line.to_string() } else { harmless(&format!("{}:{line}", source.name)) }
            })
            .collect();
        lines.dedup();
        let more = lines.len() > TUNING.lines_named;
        lines.truncate(TUNING.lines_named);
        let count = repeated.len();
        let lines = if lines.is_empty() { String::new() } else { format!(": line {}", lines.join(", ")) };
        let others = other_owners(of, repeated);
        Some(format!("the same in {count} more places{others}{lines}{}", if more { ", …" } else { "" }))
    }

    /// The report to render, and locations to replace in it: their columns count from the cut of a long line.
    fn report<'d>(
        &'d self,
        diagnostic: &'d Diagnostic,
        note: Option<&'d str>,
    ) -> (Vec<Group<'d>>, Vec<(String, String)>) {
        let level = match diagnostic.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let mut group = Group::with_title(level.primary_title(diagnostic.message.as_str()).id(diagnostic.code.id()));
        let excerpts = self.excerpts(diagnostic);
        if excerpts.is_empty() {
            group = group.elements(self.sources.first().map(|source| Origin::path(source.name.as_str())));
        }
        let mut moved = Vec::new();
        for excerpt in excerpts {
            let (snippet, places) = excerpt.snippet();
            group = group.element(snippet);
            moved.extend(places);
        }
        let help = diagnostic.help.as_deref().map(|help| Level::HELP.message(wrapped(help)));
        let note = note.map(|note| Level::NOTE.message(note));
        (vec![group.elements(help).elements(note)], moved)
    }

    /// The lines with their markers; empty for the file as a whole.
    fn excerpts<'d>(&'d self, diagnostic: &'d Diagnostic) -> Vec<Excerpt<'d>> {
        let primary = diagnostic.span.as_ref().map(|span| (span, diagnostic.label.as_deref(), AnnotationKind::Primary));
        let secondary =
            diagnostic.secondary.iter().map(|(span, label)| (span, Some(label.as_str()), AnnotationKind::Context));
        let mut excerpts: Vec<Excerpt> = Vec::new();
        for (span, label, kind) in primary.into_iter().chain(secondary) {
            let Some((source, span)) = self.sources.locate(span) else { continue };
            let mark = Mark { span: first_line_of(&source.text, span), label, kind };
            match excerpts.iter_mut().find(|excerpt| excerpt.is_near(source, &mark)) {
                Some(excerpt) => excerpt.marks.push(mark),
                None => excerpts.push(Excerpt { source, marks: vec![mark] }),
            }
        }
        excerpts
    }
}

impl Diagnostic {
    /// The same with texts that are harmless to a terminal.
    fn harmless(&self) -> Self {
        Self {
            message: harmless(&self.message),
            label: self.label.as_deref().map(harmless),
            secondary: self.secondary.iter().map(|(span, label)| (span.clone(), harmless(label))).collect(),
            help: self.help.as_deref().map(harmless),
            ..self.clone()
        }
    }
}

/// A text in lines of at most `TUNING.help_length` characters, broken at spaces.
pub fn wrapped(text: &str) -> String {
    let mut wrapped = String::with_capacity(text.len());
    let mut width = 0;
    for word in text.split_inclusive(' ') {
        let length = word.trim_end().chars().count();
        if width > 0 && width + length > TUNING.help_length {
            wrapped.truncate(wrapped.trim_end().len());
            wrapped.push('\n');
            width = 0;
        }
        wrapped += word;
        width += word.chars().count();
    }
    wrapped
}

struct Mark<'d> {
    span: Range<usize>,
    label: Option<&'d str>,
    kind: AnnotationKind,
}

/// Neighbouring lines of one source.
struct Excerpt<'d> {
    source: &'d Source,
    marks: Vec<Mark<'d>>,
}

impl<'d> Excerpt<'d> {
    fn is_near(&self, source: &Source, mark: &Mark) -> bool {
        let near = |other: &Mark| {
            let between = mark.span.start.min(other.span.start)..mark.span.start.max(other.span.start);
            let between = &source.text[between];
            between.len() < 4 * TUNING.line_length && between.matches('\n').count() <= TUNING.lines_together
        };
        std::ptr::eq(self.source, source) && self.marks.iter().all(near)
    }

    /// The lines, and the location as shown and as meant, if the two differ.
    fn snippet(self) -> (Snippet<'d, Annotation<'d>>, Option<(String, String)>) {
        let text = self.source.text.as_str();
        let first = self.marks.iter().map(|mark| mark.span.start).min().unwrap_or(0);
        let last = self.marks.iter().map(|mark| mark.span.end).max().unwrap_or(0);
        let name = self.source.name.as_str();
        let mark = self.marks.first().map_or(0, |mark| mark.span.start);
        let LineColumn { line, column } = self.source.place(mark);
        let start = text[..first].rfind('\n').map_or(0, |newline| newline + 1);
        let end = text[last..].find('\n').map_or(text.len(), |newline| last + newline);
        // Very long lines are cut near the marks.
        let cut_start = match text[start..first].char_indices().rev().nth(TUNING.line_length - 1) {
            Some((offset, _)) => start + offset,
            None => start,
        };
        let cut_end = match text[last..end].char_indices().nth(TUNING.line_length) {
            Some((offset, _)) => last + offset,
            None => end,
        };
        let annotations = self.marks.into_iter().map(|mark| {
            let span = mark.span.start - cut_start..mark.span.end - cut_start;
            mark.kind.span(span).label(mark.label)
        });
        let annotations: Vec<Annotation> = annotations.collect();
        let snippet = Snippet::source(&text[cut_start..cut_end])
            .line_start(self.source.place(cut_start).line)
            .path(name)
            .annotations(annotations);
        let moved = (cut_start != start).then(|| {
            let shown = text[cut_start..mark].chars().count() + 1;
            let place = |column| format!("{name}:{line}:{column}");
            (place(shown), place(column))
        });
        (snippet, moved)
    }
}

/// Other owners of the same message, in words.
fn other_owners(of: &Diagnostic, repeated: &[&Diagnostic]) -> String {
    let mut owners: Vec<&str> = repeated.iter().filter_map(|diagnostic| owner(&diagnostic.message)).collect();
    owners.sort_unstable();
    owners.dedup();
    owners.retain(|&other| Some(other) != owner(&of.message));
    let more = if owners.len() > TUNING.lines_named { ", …" } else { "" };
    let named: Vec<String> =
        owners.iter().take(TUNING.lines_named).map(|owner| harmless(&format!("`{owner}`"))).collect();
    if named.is_empty() { String::new() } else { format!(" (also of {}{more})", named.join(", ")) }
}

/// The part of a span on its first line, without the space around it.
fn first_line_of(text: &str, span: Range<usize>) -> Range<usize> {
    let line = text[span.clone()].split('\n').next().unwrap_or("");
    span.start..span.start + line.trim_end().len()
}
