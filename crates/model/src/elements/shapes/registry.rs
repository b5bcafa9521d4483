//! The registry: from a list of files and structs, the enum of all shapes with its delegating methods.

/// `shapes! { file::Struct, … }`
macro_rules! shapes {
    ($($file:ident::$name:ident),* $(,)?) => {
        $(mod $file;)*
        $(#[doc(no_inline)] pub use self::$file::$name;)*

        /// A shape of any kind.
        #[derive(Clone, Debug)]
        pub enum ShapeKind {
            $(#[doc = concat!("See `", stringify!($name), "`.")] $name($name),)*
        }

        impl ShapeKind {
            /// The words for shapes in a model file.
            pub const KEYWORDS: &'static [&'static str] = &[$(<$name as $crate::grammar::Element>::KEYWORD),*];

            /// Reads a shape.
            pub fn read<S: $crate::grammar::SymbolTable>(
                reader: &mut $crate::grammar::Reader<'_, S>,
                node: &$crate::grammar::Node,
                at: $crate::grammar::Span,
            ) -> Option<Self> {
                use $crate::grammar::Element;
                let entry = reader.kind_of_entry("a shape", Self::KEYWORDS, node, at)?;
                let (node, at) = (&entry.value, entry.key_span.clone());
                match entry.key.as_str() {
                    $(<$name as Element>::KEYWORD => <$name as Element>::read_node(reader, node, at).map(Self::$name),)*
                    _ => None,
                }
            }

            /// Images of the keys of a kind in an instance that is mirrored; `None` if there is no such kind.
            pub fn images(keyword: &str) -> Option<Vec<$crate::grammar::KeyImage>> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => Some(<$name as $crate::grammar::Group>::images()),)*
                    _ => None,
                }
            }

            /// The key whose list may stand for the mapping of a kind.
            pub fn short(keyword: &str) -> Option<&'static str> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => <$name as $crate::grammar::Element>::SHORT,)*
                    _ => None,
                }
            }

            /// Its form in the body's frame.
            pub fn shape(&self) -> Shape {
                let (place, form) = match self {
                    $(Self::$name(shape) => (&shape.place, ShapeElement::form(shape)),)*
                };
                Shape { position: place.position.0.clone(), rotation: place.rotation.clone(), form }
            }
        }

        impl schemars::JsonSchema for ShapeKind {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                "Shape".into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let kinds = vec![$($crate::grammar::kind_schema::<$name>(generator)),*];
                $crate::grammar::kinds_schema("A shape: one kind with its details.", kinds)
            }
        }
    };
}

pub(super) use shapes;
