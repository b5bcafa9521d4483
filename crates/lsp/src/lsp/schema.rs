//! The JSON Schema of model files, walked along the keys of a text: the keys and words allowed there, with their
//! documentation.

use serde_json::Value;

use super::context::Step;
use super::tuning::TUNING;

/// The schema.
pub struct Schema(Value);

/// A key that is allowed in a mapping.
#[derive(Clone, Debug)]
pub struct KeyInfo<'s> {
    /// As it is written.
    pub name: &'s str,
    /// Description with unit and default.
    pub description: &'s str,
    /// Whether it is required.
    pub is_required: bool,
    /// Schema of its value.
    pub value: &'s Value,
}

/// A word that may be a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordInfo<'s> {
    /// As it is written.
    pub word: &'s str,
    /// Description.
    pub description: &'s str,
}

impl Schema {
    /// The schema of this version of the language.
    pub fn new() -> Self {
        // The schema is written as JSON: reading it again cannot fail.
        Self(serde_json::from_str(&crate::model::schema()).unwrap_or_default())
    }

    /// All schemas of the value at a path.
    pub fn at(&self, path: &[Step]) -> Vec<&Value> {
        let mut found = self.choices(&self.0);
        for step in path {
            let next = found.iter().flat_map(|schema| match step {
                Step::Item => schema.get("items").into_iter().collect::<Vec<_>>(),
                Step::Key(key) => {
                    let known = schema.get("properties").and_then(|keys| keys.get(key));
                    known
                        .or_else(|| schema.get("additionalProperties").filter(|own| own.is_object()))
                        .into_iter()
                        .collect()
                }
            });
            found = next.flat_map(|schema| self.choices(schema)).collect();
        }
        found
    }

    /// A schema with all schemas that it refers to or chooses from.
    fn choices<'s>(&'s self, schema: &'s Value) -> Vec<&'s Value> {
        let mut found = Vec::new();
        self.add_choices(schema, TUNING.depth_of_schema, &mut found);
        found
    }

    fn add_choices<'s>(&'s self, schema: &'s Value, depth: usize, found: &mut Vec<&'s Value>) {
        if depth == 0 {
            return;
        }
        found.push(schema);
        let target = schema.get("$ref").and_then(Value::as_str).and_then(|target| target.strip_prefix('#'));
        if let Some(target) = target.and_then(|target| self.0.pointer(target)) {
            self.add_choices(target, depth - 1, found);
        }
        for choice in ["anyOf", "oneOf"].iter().filter_map(|word| schema.get(word)?.as_array()).flatten() {
            self.add_choices(choice, depth - 1, found);
        }
    }

    /// Keys of the mapping at a path.
    pub fn keys(&self, path: &[Step]) -> Vec<KeyInfo<'_>> {
        let mut keys: Vec<KeyInfo> = Vec::new();
        for schema in self.at(path) {
            let required = schema.get("required").and_then(Value::as_array);
            let Some(properties) = schema.get("properties").and_then(Value::as_object) else { continue };
            for (name, value) in properties {
                let is_required = required.is_some_and(|all| all.iter().any(|own| own.as_str() == Some(name)));
                if !keys.iter().any(|known| known.name == name) {
                    keys.push(KeyInfo { name, description: description(value), is_required, value });
                }
            }
        }
        keys
    }

    /// Words that the value at a path may be.
    pub fn words(&self, path: &[Step]) -> Vec<WordInfo<'_>> {
        let mut words: Vec<WordInfo> = Vec::new();
        for schema in self.at(path) {
            let all = schema.get("enum").and_then(Value::as_array).into_iter().flatten().chain(schema.get("const"));
            for word in all.filter_map(Value::as_str) {
                if !words.iter().any(|known| known.word == word) {
                    words.push(WordInfo { word, description: description(schema) });
                }
            }
        }
        words
    }

    /// Whether the value at a path may be a number or a formula.
    pub fn is_number(&self, path: &[Step]) -> bool {
        self.at(path).iter().any(|schema| schema.get("type").and_then(Value::as_str) == Some("number"))
    }

    /// Whether the value at a path may be any text, such as a name.
    pub fn is_text(&self, path: &[Step]) -> bool {
        let is_text = |schema: &&Value| {
            let is_string = schema.get("type").and_then(Value::as_str) == Some("string");
            is_string && schema.get("enum").is_none() && schema.get("const").is_none()
        };
        self.at(path).iter().any(is_text)
    }

    /// Whether keys of the mapping at a path may be any names.
    pub fn has_free_keys(&self, path: &[Step]) -> bool {
        self.at(path).iter().any(|schema| schema.get("additionalProperties").is_some_and(Value::is_object))
    }

    /// Kinds of which the value at a path is one: elements, with their descriptions and schemas.
    pub fn kinds(&self, path: &[Step]) -> Vec<KeyInfo<'_>> {
        // One kind, and perhaps its repetition.
        let is_choice = |schema: &&&Value| {
            let is_one = schema.get("minProperties").and_then(Value::as_u64) == Some(1);
            is_one && schema.get("maxProperties").is_some()
        };
        let schemas = self.at(path);
        let Some(schema) = schemas.iter().find(is_choice) else { return Vec::new() };
        let properties = schema.get("properties").and_then(Value::as_object).into_iter().flatten();
        properties
            .map(|(name, value)| KeyInfo { name, description: description(value), is_required: false, value })
            .collect()
    }

    /// Description of the key at a path.
    pub fn description(&self, path: &[Step]) -> Option<&str> {
        let [before @ .., Step::Key(key)] = path else { return None };
        self.keys(before).into_iter().find(|own| own.name == key).map(|own| own.description)
    }

    /// The first example in the schemas of a value.
    pub fn example<'s>(&'s self, value: &'s Value) -> Option<&'s Value> {
        let choices = self.choices(value);
        choices.iter().find_map(|schema| schema.get("examples")?.get(0))
    }

    /// Whether a value is a mapping and nothing else.
    pub fn is_mapping(&self, value: &Value) -> bool {
        let choices = self.choices(value);
        let kinds = || choices.iter().filter_map(|schema| schema.get("type"));
        let is_object = |kind: &Value| match kind {
            Value::Array(all) => all.iter().all(|own| own == "object" || own == "null"),
            one => one == "object" || one == "null",
        };
        kinds().next().is_some() && kinds().all(is_object)
    }
}

fn description(schema: &Value) -> &str {
    schema.get("description").and_then(Value::as_str).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> Vec<Step> {
        let steps = text.split('/').filter(|step| !step.is_empty());
        steps.map(|step| if step == "-" { Step::Item } else { Step::Key(step.to_owned()) }).collect()
    }

    #[test]
    fn keys_words_and_kinds_along_a_path() {
        let schema = Schema::new();
        let keys = |text: &str| schema.keys(&path(text)).iter().map(|own| own.name.to_owned()).collect::<Vec<_>>();
        assert!(keys("").contains(&"bodies".to_owned()));
        assert!(keys("bodies/crank").contains(&"mass".to_owned()));
        assert!(keys("effects/spring/spring_damper").contains(&"stiffness".to_owned()));
        assert!(keys("bodies/ground").contains(&"points".to_owned()));
        assert!(schema.kinds(&path("joints/pin")).iter().any(|kind| kind.name == "revolute"));
        assert!(schema.words(&path("analysis")).iter().any(|own| own.word == "statics"));
        assert!(schema.is_number(&path("bodies/crank/mass")) && !schema.is_number(&path("analysis")));
        assert!(schema.is_text(&path("joints/pin/revolute/-")));
        assert!(schema.has_free_keys(&path("bodies")) && !schema.has_free_keys(&path("bodies/crank")));
        assert!(schema.description(&path("bodies/crank/mass")).unwrap().contains("kg"));
    }
}
