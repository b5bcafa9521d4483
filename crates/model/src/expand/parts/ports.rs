//! `ports:`, bodies and points by which others hold an instance.

use super::{Writer, mirror};
use crate::grammar::mentions::NameKind;
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::mirrors::Mirrors;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// A port of an instance.
#[derive(Clone)]
pub struct Port {
    /// Its full name.
    pub name: String,
    /// The body or the point that it is.
    pub target: String,
    /// Location of its entry.
    pub span: Span,
}

impl Writer<'_, '_> {
    /// Notes the ports of an instance; one with a position of its own becomes a point of its body.
    pub(super) fn ports(&mut self, prefix: &str, entries: Vec<Entry>, mirrors: Mirrors) {
        for mut entry in entries {
            if matches!(entry.value.value, Value::Mapping(_)) {
                mirrors.axes().for_each(|axis| mirror::point(&mut entry.value, axis));
            }
            if !self.report.is_name(&entry.key, &entry.key_span, "a port") || !self.is_free(&entry, true) {
                continue;
            }
            let name = format!("{prefix}{}", entry.key);
            self.report.defines(NameKind::Port, &name, &entry);
            let span = entry.value.span.clone();
            let target = match &entry.value.value {
                Value::Mapping(_) => self.point(prefix, &entry),
                _ => self
                    .report
                    .scalar(&entry.value, "a body or a point of one")
                    .map(|scalar| scalar.name().into_owned()),
            };
            self.report.mentions_node(Some(NameKind::Body), &entry.value);
            self.parts.ports.extend(target.map(|target| Port { name, target, span }));
        }
    }

    /// Gives the body of a port a point.
    fn point(&mut self, prefix: &str, entry: &Entry) -> Option<String> {
        let fields = self.report.fields::<keys::PointPort>(&entry.value, entry.key_span.clone())?;
        let on = self.report.required(&fields, "on")?;
        let body = self.report.scalar(on, "the name of a body")?.name().into_owned();
        self.report.mentions_node(Some(NameKind::Body), on);
        let keys = |key: &str| {
            let value = fields.get(key)?.clone();
            Some(Entry { key: key.to_owned(), key_span: fields.key_span(key), value })
        };
        let frame: Vec<Entry> = ["position", "rotation"].into_iter().filter_map(keys).collect();
        let value = Node { span: entry.value.span.clone(), value: Value::Mapping(frame) };
        let point = Entry { key: entry.key.clone(), key_span: entry.key_span.clone(), value };
        let bodies = self.section("bodies", &entry.key_span)?;
        let Some(found) = bodies.iter_mut().find(|known| known.key == body) else {
            let known: Vec<String> =
                bodies.iter().filter_map(|body| Some(body.key.strip_prefix(prefix)?.to_owned())).collect();
            let short = body.strip_prefix(prefix).unwrap_or(&body);
            let help = suggest::help(short, "bodies", known.iter().map(String::as_str));
            self.report.error(Code::UnknownName, on.span.clone(), format!("unknown body `{}`", clip(&body)), help);
            return None;
        };
        let Value::Mapping(keys) = &mut found.value.value else { return None };
        let at = entry.key_span.clone();
        let index = keys.iter().position(|key| key.key == "points").unwrap_or_else(|| {
            let value = Node { span: at.clone(), value: Value::Mapping(Vec::new()) };
            keys.push(Entry { key: "points".to_owned(), key_span: at.clone(), value });
            keys.len() - 1
        });
        let Value::Mapping(points) = &mut keys[index].value.value else { return None };
        if let Some(first) = points.iter().find(|known| known.key == point.key).map(|known| known.key_span.clone()) {
            self.twice(&point.key, &point.key_span, &first);
            return None;
        }
        points.push(point);
        Some(format!("{body}.{}", entry.key))
    }
}
