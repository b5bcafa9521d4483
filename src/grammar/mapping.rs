//! Mappings of the file whose keys are fixed: one declaration serves the reader and the JSON Schema.

/// A mapping of the file whose keys are fixed.
pub trait Grammar {
    /// What the mapping is, for messages: `a body`.
    const WHAT: &'static str;
    /// Its keys, in the order in which they are suggested.
    const KEYS: &'static [&'static str];
}

macro_rules! grammar {
    ($(
        $(#[doc = $doc:literal])*
        $name:ident is $what:literal $(with $extension:literal = $value:literal)* {
            $($(#[doc = $field_doc:literal])* $field:ident: $type:ty,)*
        }
    )*) => {$(
        $(#[doc = $doc])*
        #[derive(JsonSchema)]
        #[schemars(deny_unknown_fields $(, extend($extension = $value))*)]
        pub struct $name {
            $($(#[doc = $field_doc])* $field: $type,)*
        }

        impl $crate::grammar::mapping::Grammar for $name {
            const WHAT: &'static str = $what;
            const KEYS: &'static [&'static str] = &[$(stringify!($field)),*];
        }
    )*};
}

pub(crate) use grammar;
