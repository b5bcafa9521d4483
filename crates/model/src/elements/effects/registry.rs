//! The registry: from a list of files and structs, the enum of all effects with its delegating methods.

/// `effects! { file::Struct, … }`
macro_rules! effects {
    ($($file:ident::$name:ident),* $(,)?) => {
        $(pub mod $file;)*
        $(#[doc(no_inline)] pub use self::$file::$name;)*

        /// An effect of any kind.
        #[derive(Clone, Debug)]
        #[allow(clippy::large_enum_variant, reason = "a model has few effects, and none is copied in a step")]
        pub enum EffectKind {
            $(#[doc = concat!("See `", stringify!($name), "`.")] $name($name),)*
        }

        $(impl From<$name> for EffectKind {
            fn from(effect: $name) -> Self {
                Self::$name(effect)
            }
        })*

        impl EffectKind {
            /// The words for effects in a model file.
            pub const KEYWORDS: &'static [&'static str] = &[$(<$name as $crate::grammar::Element>::KEYWORD),*];

            /// Reads an effect; `own` is its name, by which its formulas may refer to its sensors.
            pub fn read<S: $crate::grammar::SymbolTable>(
                reader: &mut $crate::grammar::Reader<'_, S>,
                own: &str,
                node: &$crate::grammar::Node,
                at: $crate::grammar::Span,
            ) -> Option<Self> {
                use $crate::grammar::Element;
                let entry = reader.kind_of_entry("an effect", Self::KEYWORDS, node, at)?;
                let (node, at) = (&entry.value, entry.key_span.clone());
                let kind = match entry.key.as_str() {
                    $(<$name as Element>::KEYWORD => {
                        reader.unread.push((own.to_owned(), <$name as ForceElement>::SENSORS.to_vec()));
                        <$name as Element>::read_node(reader, node, at).map(Self::$name)
                    })*
                    _ => None,
                };
                if kind.is_some() {
                    reader.unread.pop();
                }
                kind
            }

            /// The key of an effect that leaves the plane, by the text alone.
            pub fn leaves_plane(keyword: &str, mapping: &$crate::grammar::Node) -> Option<&'static str> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => <$name as $crate::grammar::Group>::leaves_plane(mapping),)*
                    _ => None,
                }
            }

            /// Dimension of the state that the name of an entry stands for, as far as it is known; `None` if the name
            /// does not stand for a state.
            pub fn value_ahead<S: $crate::grammar::SymbolTable>(
                reader: &mut $crate::grammar::Reader<'_, S>,
                entry: &$crate::grammar::Node,
            ) -> Option<Option<Dimension>> {
                $(if let Some(mapping) = entry.get(<$name as $crate::grammar::Element>::KEYWORD) {
                    return <$name as ForceElement>::value_ahead(reader, mapping);
                })*
                None
            }

            /// Documentation of every effect, in the order of the registry.
            pub fn docs() -> Vec<$crate::grammar::ElementDocs> {
                vec![$(with_sensors::<$name>()),*]
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
                    $(Self::$name(effect) => $crate::grammar::Group::formulas(effect, &mut found),)*
                }
                found
            }

            /// Every body, point and joint that it names, formulas aside.
            pub fn references(&mut self) -> Vec<$crate::grammar::Reference<'_>> {
                let mut found = Vec::new();
                match self {
                    $(Self::$name(effect) => $crate::grammar::Group::references(effect, &mut found),)*
                }
                found
            }

            /// Sensors for outputs.
            pub fn measures(&self) -> Vec<TypedSensor> {
                match self {
                    $(Self::$name(effect) => ForceElement::sensors(effect),)*
                }
            }

            /// Whether it only resists: it sets nothing at rest in motion.
            pub fn resists(&self) -> bool {
                match self {
                    $(Self::$name(_) => <$name as ForceElement>::RESISTS,)*
                }
            }

            /// Its symbol in drawings.
            pub fn glyph(&self) -> $crate::elements::Glyph {
                match self {
                    $(Self::$name(_) => <$name as ForceElement>::GLYPH,)*
                }
            }

            /// A direction that a drawing shows, in the ground's axes.
            pub fn direction(&self) -> Option<&[symdiff::Formula; 3]> {
                match self {
                    $(Self::$name(effect) => ForceElement::direction(effect),)*
                }
            }

            /// Surfaces that it has at points of bodies, for pictures.
            pub fn surfaces(&self, surroundings: $crate::elements::Surroundings) -> Vec<$crate::elements::SurfaceAt> {
                match self {
                    $(Self::$name(effect) => ForceElement::surfaces(effect, surroundings),)*
                }
            }

            /// Coordinates of joints that it acts on.
            pub fn coordinates(&self) -> Vec<$crate::grammar::OnJoint> {
                match self {
                    $(Self::$name(effect) => ForceElement::coordinates(effect),)*
                }
            }

            /// Images of the keys of a kind in an instance that is mirrored or turned; `None` if there is no such kind.
            pub fn images(keyword: &str) -> Option<Vec<$crate::grammar::KeyImage>> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => Some(<$name as $crate::grammar::Group>::images()),)*
                    _ => None,
                }
            }

            /// Adds its forces to a mechanism.
            ///
            /// # Errors
            /// A formula with a name that cannot stand in it; the reader of model files lets none through.
            pub fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), $crate::multibody::BuildError> {
                match self {
                    $(Self::$name(effect) => ForceElement::apply(effect, forces),)*
                }
            }

            /// Bodies and joints it acts on.
            pub fn scope(&self) -> Scope {
                match self {
                    $(Self::$name(_) => <$name as ForceElement>::SCOPE,)*
                }
            }

            /// Objects that a kind of effect acts on; `None` if there is no such kind.
            pub fn scope_of(keyword: &str) -> Option<Scope> {
                match keyword {
                    $(<$name as $crate::grammar::Element>::KEYWORD => Some(<$name as ForceElement>::SCOPE),)*
                    _ => None,
                }
            }

            /// The mass between two points that it adds to the mechanism.
            pub fn inertia(&self) -> Option<LineMass<'_>> {
                match self {
                    $(Self::$name(effect) => ForceElement::inertia(effect),)*
                }
            }

            /// The mass matrix by nodes and modes that it adds to the mechanism.
            pub fn reduced_inertia(&self) -> Option<ReducedInertia<'_>> {
                match self {
                    $(Self::$name(effect) => ForceElement::reduced_inertia(effect),)*
                }
            }

            /// The states that it brings.
            pub fn states(&self) -> Vec<StateVariable<'_>> {
                match self {
                    $(Self::$name(effect) => ForceElement::states(effect),)*
                }
            }

            /// The joint whose reaction its force grows with, and the factor.
            pub fn loading_joint(&self) -> Option<(usize, &symdiff::Formula)> {
                match self {
                    $(Self::$name(effect) => ForceElement::loading_joint(effect),)*
                }
            }
        }

        impl JsonSchema for EffectKind {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                "Effect".into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let kinds = vec![$($crate::grammar::kind_schema::<$name>(generator)),*];
                $crate::grammar::kinds_schema("An effect: one kind with its details.", kinds)
            }
        }
    };
}

pub(super) use effects;
