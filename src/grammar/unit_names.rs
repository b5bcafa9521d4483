//! Units that are called like a name of the model.

use super::names;
use super::own_names::OwnNames;
use super::reader::Reader;
use super::symbols::SymbolTable;
use super::unit::number_and_unit;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// What to do where a unit is called like something of the model.
    pub(super) fn unit_like_a_name(&self, node: &Node) -> Option<String> {
        let scalar = node.scalar()?;
        let text = &scalar.text;
        let own_names = OwnNames::of(scalar, self.variable);
        let (_, unit, _) = number_and_unit(text)?;
        let (factors, word) = unit.rsplit_once(['*', '·'])?;
        (!names::is_reserved(word.trim()) && self.is_name(word.trim(), own_names.as_ref())).then(|| {
            let start = text.len() - text.trim_start().len();
            let before = text[start..].split_once(unit).map_or("", |(before, _)| before);
            format!(
                "`{}` is read as a unit here; write `{before}{factors} * {}` with spaces for the model's own",
                word.trim(),
                word.trim()
            )
        })
    }
}
