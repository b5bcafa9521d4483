//! Mappings of the file whose keys are fixed: one declaration serves the reader, the JSON Schema and mirrors.

use super::image::{Image, KeyImage};

/// A mapping of the file whose keys are fixed.
pub trait Grammar {
    /// Noun of the mapping, for messages: `a body`.
    const WHAT: &'static str;
    /// Its keys, in the order in which they are suggested.
    const KEYS: &'static [&'static str];
    /// Keys that have another image in a mirror.
    const IMAGES: &'static [(&'static str, Image)];

    /// The keys with their images.
    fn images() -> Vec<KeyImage> {
        let of = |&(name, image): &(&'static str, Image)| KeyImage { name, image, in_ground: false, default: None };
        Self::IMAGES.iter().map(of).collect()
    }
}

/// The key of a field; one that is a keyword of Rust is written `r#final`.
pub const fn key(field: &'static str) -> &'static str {
    match field.as_bytes() {
        [b'r', b'#', ..] => field.split_at(2).1,
        _ => field,
    }
}

/// Declares mappings: a type for the schema, and its keys for the reader, some of them `as` an [`Image`].
#[doc(hidden)]
#[macro_export]
macro_rules! __grammar {
    ($(
        $(#[doc = $doc:literal])*
        $name:ident is $what:literal $(with $extension:literal = $value:literal)* {
            $($(#[doc = $field_doc:literal])* $field:ident: $type:ty $(as $image:expr)?,)*
        }
    )*) => {$(
        $(#[doc = $doc])*
        #[derive(JsonSchema)]
        #[allow(dead_code)] // the schema is derived from the fields, which the reader does not fill
        #[schemars(deny_unknown_fields $(, extend($extension = $value))*)]
        pub struct $name {
            $($(#[doc = $field_doc])* $field: $type,)*
        }

        impl $crate::grammar::mapping::Grammar for $name {
            const WHAT: &'static str = $what;
            const KEYS: &'static [&'static str] = &[$($crate::grammar::mapping::key(stringify!($field))),*];
            const IMAGES: &'static [(&'static str, $crate::grammar::Image)] =
                &[$($(($crate::grammar::mapping::key(stringify!($field)), $image),)?)*];
        }
    )*};
}

/// Types used only for their schema: values that a key may have.
#[doc(hidden)]
#[macro_export]
macro_rules! __schema_only {
    ($($item:item)*) => {$(
        #[derive(JsonSchema)]
        // The schema is derived from the variants, which the reader does not make; those that need words have them.
        #[allow(dead_code, missing_docs)]
        $item
    )*};
}

pub use {__grammar as grammar, __schema_only as schema_only};
