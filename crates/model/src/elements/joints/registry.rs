//! The registry: from a list of files and structs, the closed enum of all joints with its delegating methods.

use serde::Serialize;

use super::RowDocs;
use crate::grammar::ElementDocs;

/// A joint of the language, for people.
#[derive(Debug, Serialize)]
pub struct JointDocs {
    /// Keyword, keys, equations, source, example.
    #[serde(flatten)]
    pub element: ElementDocs,
    /// Documentation of its constraints and their multipliers.
    pub rows: &'static [RowDocs],
}

/// `joints! { file::Struct, … }`
macro_rules! joints {
    ($($file:ident::$name:ident),* $(,)?) => {
        $(pub mod $file;)*
        $(#[doc(no_inline)] pub use self::$file::$name;)*

        /// A joint of any kind.
        #[derive(Clone, Debug)]
        pub enum JointKind {
            $(#[doc = concat!("See `", stringify!($name), "`.")] $name($name),)*
        }

        $(impl From<$name> for JointKind {
            fn from(joint: $name) -> Self {
                Self::$name(joint)
            }
        })*

        impl std::ops::Deref for JointKind {
            type Target = dyn Joint;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$name(joint) => joint,)*
                }
            }
        }

        impl JointKind {
            /// The words for joints in a model file.
            pub const KEYWORDS: &'static [&'static str] = &[$(<$name as $crate::grammar::Element>::KEYWORD),*];

            /// Whether joints of a keyword refer to other joints, so that they are read after them.
            pub fn couples(keyword: &str) -> bool {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => <$name as JointElement>::COUPLES,)*
                    _ => false,
                }
            }

            /// Whether effects and drives on joints of a keyword act on the angle unless they say `coordinate`.
            pub fn turns(keyword: &str) -> bool {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => <$name as JointElement>::TURNS,)*
                    _ => false,
                }
            }

            /// Reads a joint.
            pub fn read<S: $crate::grammar::SymbolTable>(
                reader: &mut $crate::grammar::Reader<'_, S>,
                node: &$crate::grammar::Node,
                at: $crate::grammar::Span,
            ) -> Option<Self> {
                use $crate::grammar::Element;
                let entry = reader.kind_of_entry("a joint", Self::KEYWORDS, node, at)?;
                let (node, at) = (&entry.value, entry.key_span.clone());
                match entry.key.as_str() {
                    $(<$name as Element>::KEYWORD => {
                        if <$name as JointElement>::SPATIAL && !reader.model.is_spatial() {
                            reader.leaves_the_plane(node);
                        }
                        <$name as Element>::read_node(reader, node, at).map(Self::$name)
                    })*
                    _ => None,
                }
            }

            /// Images of the keys of a kind in an instance that is mirrored or turned; `None` if there is no such kind.
            pub fn images(keyword: &str) -> Option<Vec<$crate::grammar::KeyImage>> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => Some(<$name as $crate::grammar::Group>::images()),)*
                    _ => None,
                }
            }

            /// The key of a joint that leaves the plane, by the text alone.
            pub fn leaves_plane(keyword: &str, mapping: &$crate::grammar::Node) -> Option<&'static str> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD if <$name as JointElement>::SPATIAL => Some("kind"),
                    <$name as $crate::grammar::Element>::KEYWORD => {
                        <$name as $crate::grammar::Group>::leaves_plane(mapping)
                    })*
                    _ => None,
                }
            }

            /// Documentation of every joint, in the order of the registry.
            pub fn docs() -> Vec<JointDocs> {
                vec![$(JointDocs {
                    element: $crate::grammar::ElementDocs::of::<$name>(),
                    rows: <$name as JointElement>::ROWS,
                }),*]
            }

            /// The word for it in a model file.
            pub fn keyword(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => <$name as $crate::grammar::Element>::KEYWORD,)*
                }
            }

            /// Every formula in it.
            pub fn formulas(&self) -> Vec<&symdiff::Formula> {
                let mut found = Vec::new();
                match self {
                    $(Self::$name(joint) => $crate::grammar::Group::formulas(joint, &mut found),)*
                }
                found
            }

            /// Every body, point and joint that it refers to, formulas aside.
            pub fn references(&mut self) -> Vec<$crate::grammar::Reference<'_>> {
                let mut found = Vec::new();
                match self {
                    $(Self::$name(joint) => $crate::grammar::Group::references(joint, &mut found),)*
                }
                found
            }
        }

        impl schemars::JsonSchema for JointKind {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                "Joint".into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let kinds = vec![$($crate::grammar::kind_schema::<$name>(generator)),*];
                $crate::grammar::kinds_schema("A joint: one kind with its details.", kinds)
            }
        }
    };
}

pub(super) use joints;
