//! Values of a model that is built in Rust.

use std::fmt::Write;

/// A number, a text (a name, a formula, a quantity with its unit), a list, or fields by their keys.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number in the key's SI unit.
    Number(f64),
    /// A text as in a YAML file.
    Text(String),
    /// A list, in square brackets in a YAML file.
    List(Vec<Value>),
    /// Fields, in braces in a YAML file; see [`fields!`](crate::fields).
    Fields(Vec<(String, Value)>),
}

/// Fields of a model that is built in Rust: `fields! { mass: 1.2, points: fields! { tip: ["length/2", "0"] } }`.
#[macro_export]
macro_rules! fields {
    ($($key:ident: $value:expr),* $(,)?) => {
        $crate::Value::Fields(vec![$((stringify!($key).to_owned(), $crate::Value::from($value))),*])
    };
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<i32> for Value {
    fn from(number: i32) -> Self {
        Self::Number(number.into())
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl<T: Into<Value>, const N: usize> From<[T; N]> for Value {
    fn from(items: [T; N]) -> Self {
        Self::List(items.into_iter().map(Into::into).collect())
    }
}

impl<T: Into<Value>> From<Vec<T>> for Value {
    fn from(items: Vec<T>) -> Self {
        Self::List(items.into_iter().map(Into::into).collect())
    }
}

impl Value {
    /// Appends it to a YAML text, on one line.
    pub(super) fn write(&self, text: &mut String) {
        match self {
            // `write!` to a string does not fail. Integers stay integers, for keys that count.
            Self::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => {
                let _ = write!(text, "{number:.0}");
            }
            Self::Number(number) => {
                let _ = write!(text, "{number:?}");
            }
            Self::Text(words) => quote(words, text),
            Self::List(items) => {
                text.push('[');
                for (index, item) in items.iter().enumerate() {
                    text.push_str(if index > 0 { ", " } else { "" });
                    item.write(text);
                }
                text.push(']');
            }
            Self::Fields(fields) => {
                text.push('{');
                for (index, (key, value)) in fields.iter().enumerate() {
                    text.push_str(if index > 0 { ", " } else { " " });
                    quote(key, text);
                    text.push_str(": ");
                    value.write(text);
                }
                text.push_str(" }");
            }
        }
    }
}

/// Appends a text as a YAML scalar that reads back as the same text.
pub(super) fn quote(words: &str, text: &mut String) {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | ' ' | '/' | '^' | '(' | ')' | '+' | '%');
    let begins = words.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '(');
    if begins && words.chars().all(plain) && !words.ends_with(' ') && !matches!(words, "null" | "Null" | "NULL") {
        text.push_str(words);
    } else {
        // JSON's strings are valid in YAML; every string has a JSON form.
        text.push_str(&serde_json::Value::from(words).to_string());
    }
}
