//! Contents of the attributes `#[element(…)]`, `#[quantity(…)]` and `#[key(…)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Attribute, Expr, Field, Lit, LitStr, Meta, Result, Token};

/// Attributes of a struct.
#[derive(Default)]
pub struct Struct {
    pub doc: String,
    pub keyword: Option<LitStr>,
    pub what: Option<LitStr>,
    pub equations: Vec<LitStr>,
    pub source: Option<LitStr>,
    pub example: Option<LitStr>,
    pub short: Option<LitStr>,
    pub checked: bool,
}

impl Struct {
    pub fn read(attributes: &[Attribute]) -> Result<Self> {
        let mut found = Self { doc: doc(attributes), ..Self::default() };
        for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("element")) {
            attribute.parse_nested_meta(|meta| {
                let name = meta.path.get_ident().map(ToString::to_string).unwrap_or_default();
                match name.as_str() {
                    "checked" => found.checked = true,
                    "keyword" => found.keyword = Some(meta.value()?.parse()?),
                    "what" => found.what = Some(meta.value()?.parse()?),
                    "equation" => found.equations.push(meta.value()?.parse()?),
                    "source" => found.source = Some(meta.value()?.parse()?),
                    "example" => found.example = Some(meta.value()?.parse()?),
                    "short" => found.short = Some(meta.value()?.parse()?),
                    _ => {
                        return Err(
                            meta.error("an element has keyword, what, equation, source, example, short, checked")
                        );
                    }
                }
                Ok(())
            })?;
        }
        Ok(found)
    }
}

/// Value of a key that the file does not give.
pub enum Absent {
    /// An error.
    Required,
    /// Nothing: the field is an `Option`.
    Nothing,
    /// A value.
    Default(TokenStream),
    /// A value computed from the fields before it, and its description.
    Computed(LitStr, Expr),
}

/// Attributes of a key.
pub struct Key {
    pub doc: String,
    pub is_group: bool,
    /// Whether the field is no key: the reader fills in its type's default.
    pub is_derived: bool,
    /// Dimension computed from the fields before it, instead of that of the unit.
    pub dimension: Option<Expr>,
    pub unit: Option<LitStr>,
    pub absent: Absent,
    /// Default of an absent `Option` key, in words.
    pub otherwise: Option<LitStr>,
    /// An earlier key whose value must be smaller.
    pub above: Option<syn::Ident>,
    /// The name of a `grammar::Context`.
    pub context: &'static str,
    pub requirement: Option<TokenStream>,
    /// The `grammar::Image` that replaces the type's.
    pub image: Option<Expr>,
    /// Whether components are along the ground's axes.
    pub in_ground: bool,
}

impl Key {
    pub fn read(field: &Field) -> Result<Self> {
        let absent = if is_option(field) { Absent::Nothing } else { Absent::Required };
        let doc = doc(&field.attrs);
        let mut found = Self {
            doc,
            is_group: false,
            is_derived: false,
            dimension: None,
            unit: None,
            absent,
            otherwise: None,
            above: None,
            context: "Effect",
            requirement: None,
            image: None,
            in_ground: false,
        };
        for attribute in &field.attrs {
            if attribute.path().is_ident("group") {
                found.is_group = true;
            } else if attribute.path().is_ident("derived") {
                found.is_derived = true;
            } else if attribute.path().is_ident("quantity") || attribute.path().is_ident("key") {
                attribute.parse_nested_meta(|meta| found.set(&meta))?;
            }
        }
        if found.doc.is_empty() && !found.is_group {
            return Err(syn::Error::new_spanned(field, "a key needs a doc comment: it is what people read of it"));
        }
        Ok(found)
    }

    fn set(&mut self, meta: &syn::meta::ParseNestedMeta) -> Result<()> {
        let requirement = |name: &str| {
            let name = syn::Ident::new(name, proc_macro2::Span::call_site());
            Some(quote!(crate::grammar::Requirement::#name))
        };
        let name = meta.path.get_ident().map(ToString::to_string).unwrap_or_default();
        match name.as_str() {
            "unit" => self.unit = Some(meta.value()?.parse()?),
            "dimension" => self.dimension = Some(meta.value()?.parse()?),
            "otherwise" => self.otherwise = Some(meta.value()?.parse()?),
            "above" => self.above = Some(meta.value()?.parse()?),
            "image" => self.image = Some(meta.value()?.parse()?),
            "in_ground" => self.in_ground = true,
            "constant" => self.context = "Constant",
            "time" => self.context = "Time",
            "command" => self.context = "Command",
            "positive" => self.requirement = requirement("POSITIVE"),
            "nonnegative" => self.requirement = requirement("NONNEGATIVE"),
            "nonzero" => self.requirement = requirement("NONZERO"),
            "requires" => {
                let path: Expr = meta.value()?.parse()?;
                self.requirement = Some(quote!(#path));
            }
            "default" => {
                let value: Expr = meta.value()?.parse()?;
                self.absent = Absent::Default(match &value {
                    Expr::Lit(literal) if matches!(literal.lit, Lit::Int(_) | Lit::Float(_)) => {
                        quote!(crate::grammar::FromNumber::from_number(f64::from(#value)))
                    }
                    _ => quote!(#value),
                });
            }
            "default_with" => {
                let content;
                syn::parenthesized!(content in meta.input);
                let words: LitStr = content.parse()?;
                content.parse::<Token![,]>()?;
                self.absent = Absent::Computed(words, content.parse()?);
            }
            _ => {
                return Err(meta.error(
                    "a key has unit, dimension, above, otherwise, default, default_with, constant, time, command, positive, nonnegative, nonzero, requires",
                ));
            }
        }
        Ok(())
    }
}

/// Whether the field's type is an `Option`.
fn is_option(field: &Field) -> bool {
    match &field.ty {
        syn::Type::Path(path) => path.path.segments.last().is_some_and(|segment| segment.ident == "Option"),
        _ => false,
    }
}

/// The doc comment in one line.
pub fn doc(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value().trim().to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    });
    lines.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}
