//! Structs: groups of keys, mappings, elements.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Data, DeriveInput, Field, Fields, LitStr, Result};

use crate::attributes::{Absent, Key, Struct};

/// A field with its attributes.
struct Part<'a> {
    field: &'a Field,
    key: Key,
}

impl Part<'_> {
    fn name(&self) -> LitStr {
        let ident = self.field.ident.as_ref().map(ToString::to_string).unwrap_or_default();
        LitStr::new(ident.trim_start_matches("r#"), proc_macro2::Span::call_site())
    }
}

pub fn derive(input: &DeriveInput) -> Result<TokenStream> {
    let Data::Struct(data) = &input.data else {
        return Err(syn::Error::new_spanned(input, "an element is a struct; a word of several is a `Choice`"));
    };
    let Fields::Named(fields) = &data.fields else {
        return Err(syn::Error::new_spanned(input, "the fields of an element are its keys, and need names"));
    };
    let about = Struct::read(&input.attrs)?;
    let parts: Vec<Part> =
        fields.named.iter().map(|field| Ok(Part { field, key: Key::read(field)? })).collect::<Result<_>>()?;
    let ident = &input.ident;
    let read = read(&about, &parts);
    let (derived, parts): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|part| part.key.is_derived);
    let derived = derived.iter().map(|part| &part.field.ident);
    let (names, keys, images) = (key_names(&parts), keys(&parts), images(&parts));
    let (formulas, references) = (visit(&parts, "formulas"), visit(&parts, "references"));
    let leaves = leaves_plane(&parts);
    let role = match (&about.keyword, &about.what) {
        (Some(keyword), Some(what)) => element(ident, &about, keyword, what)?,
        (Some(keyword), None) => {
            return Err(syn::Error::new_spanned(keyword, "describe it for messages: `what = \"a …\"`"));
        }
        (None, Some(what)) => mapping(ident, &about, what),
        (None, None) => TokenStream::new(),
    };
    Ok(quote! {
        impl crate::grammar::Group for #ident {
            fn key_names() -> Vec<&'static str> {
                let mut names = Vec::new();
                #names
                names
            }

            fn keys(generator: &mut schemars::SchemaGenerator) -> Vec<crate::grammar::Key> {
                let mut keys = Vec::new();
                #keys
                keys
            }

            fn images() -> Vec<crate::grammar::KeyImage> {
                let mut images = Vec::new();
                #images
                images
            }

            fn read<S: crate::grammar::SymbolTable>(
                reader: &mut crate::grammar::Reader<'_, S>,
                fields: &crate::grammar::Fields<'_>,
                units: usize,
            ) -> Option<Self> {
                #read
            }

            fn formulas<'a>(&'a self, found: &mut Vec<&'a symdiff::Formula>) {
                #formulas
                #(self.#derived.iter().for_each(|derived| found.extend(derived.formulas()));)*
            }

            fn references<'a>(&'a mut self, found: &mut Vec<crate::grammar::Reference<'a>>) {
                #references
            }

            fn leaves_plane(mapping: &crate::grammar::Node) -> Option<&'static str> {
                #leaves
                None
            }
        }
        #role
    })
}

fn key_names(parts: &[Part]) -> TokenStream {
    let each = parts.iter().map(|part| {
        let (name, ty) = (part.name(), &part.field.ty);
        if part.key.is_group {
            quote!(names.extend(<#ty as crate::grammar::Group>::key_names());)
        } else {
            quote!(names.push(#name);)
        }
    });
    each.collect()
}

fn keys(parts: &[Part]) -> TokenStream {
    let each = parts.iter().map(|part| {
        let (name, ty, key) = (part.name(), &part.field.ty, &part.key);
        if key.is_group {
            return quote!(keys.extend(<#ty as crate::grammar::Group>::keys(generator)););
        }
        let (doc, unit) = (&key.doc, key.unit.as_ref().map_or(String::new(), LitStr::value));
        let required = matches!(key.absent, Absent::Required);
        let requirement = requirement(part);
        let (default, words) = match &key.absent {
            Absent::Default(value) => (quote!(<#ty as crate::grammar::Value>::to_json(&#value)), quote!(None)),
            Absent::Computed(words, _) => (quote!(None), quote!(Some(#words))),
            Absent::Required | Absent::Nothing => match &key.otherwise {
                Some(words) => (quote!(None), quote!(Some(#words))),
                None => (quote!(None), quote!(None)),
            },
        };
        quote! {
            keys.push(crate::grammar::Key {
                name: #name,
                doc: #doc,
                unit: #unit,
                required: #required,
                default: #default,
                default_in_words: #words,
                schema: <#ty as crate::grammar::Value>::schema(generator),
                requirement: #requirement,
                keys: <#ty as crate::grammar::Value>::keys(),
            });
        }
    });
    each.collect()
}

/// Generates the image of each key in a mirrored or turned instance.
fn images(parts: &[Part]) -> TokenStream {
    let each = parts.iter().map(|part| {
        let (name, ty, key) = (part.name(), &part.field.ty, &part.key);
        if key.is_group {
            return quote!(images.extend(<#ty as crate::grammar::Group>::images()););
        }
        let image = match &key.image {
            Some(image) => quote!(crate::grammar::Image::#image),
            None => quote!(<#ty as crate::grammar::Value>::IMAGE),
        };
        let default = match &key.absent {
            Absent::Default(value) => quote!(<#ty as crate::grammar::Value>::to_json(&#value)),
            _ => quote!(None),
        };
        let in_ground = key.in_ground;
        quote! {
            images.push(crate::grammar::KeyImage {
                name: #name,
                image: #image,
                in_ground: #in_ground,
                default: #default,
            });
        }
    });
    each.collect()
}

fn read(about: &Struct, parts: &[Part]) -> TokenStream {
    let fields = parts.iter().map(read_field);
    let ordered = parts.iter().filter_map(|part| {
        let (ident, high, low) = (&part.field.ident, part.name(), part.key.above.as_ref()?);
        let low_name = LitStr::new(&low.to_string(), low.span());
        Some(quote!(crate::grammar::ordered(reader, fields, #low_name, #low.as_ref(), #high, #ident.as_ref());))
    });
    // Computed defaults may use earlier fields, which have their values by then.
    let there = parts.iter().map(|part| {
        let ident = &part.field.ident;
        match &part.key.absent {
            Absent::Computed(_, value) => quote!(let #ident = #ident?.unwrap_or_else(|| #value);),
            _ => quote!(let #ident = #ident?;),
        }
    });
    let idents = parts.iter().map(|part| &part.field.ident);
    let (before, after) = if about.checked {
        (
            quote!(<Self as crate::grammar::Checked>::check_keys(reader, fields);),
            quote!(crate::grammar::Checked::check(&found, reader, fields);),
        )
    } else {
        (TokenStream::new(), TokenStream::new())
    };
    quote! {
        #before
        #(#fields)*
        #(#ordered)*
        #(#there)*
        let found = Self { #(#idents),* };
        #after
        Some(found)
    }
}

/// Generates the requirement on a key's number.
fn requirement(part: &Part) -> TokenStream {
    match &part.key.requirement {
        Some(requirement) => quote!(Some(#requirement)),
        None => quote!(None),
    }
}

fn read_field(part: &Part) -> TokenStream {
    let (ident, name, ty, key) = (&part.field.ident, part.name(), &part.field.ty, &part.key);
    if key.is_derived {
        return quote!(let #ident: Option<#ty> = Some(Default::default()););
    }
    if key.is_group {
        return quote! {
            let #ident = <#ty as crate::grammar::Group>::read(reader, fields, units);
            let units = <#ty as crate::grammar::Group>::units(#ident.as_ref()).unwrap_or(units);
        };
    }
    let unit = key.unit.as_ref().map_or(String::new(), LitStr::value);
    let context = format_ident!("{}", key.context);
    let requirement = requirement(part);
    let dimension = match &key.dimension {
        Some(dimension) => quote!(Some(#dimension)),
        None => quote!(None),
    };
    let quantity = quote! {
        &crate::grammar::Quantity {
            unit: #unit,
            choice: units,
            context: crate::grammar::Context::#context,
            requirement: #requirement,
            dimension: #dimension,
        }
    };
    let value = quote!(crate::grammar::Value::read(reader, node, fields.key_span(#name), #quantity));
    match &key.absent {
        Absent::Required => quote! {
            let #ident: Option<#ty> = match reader.required(fields, #name) {
                Some(node) => #value,
                None => None,
            };
        },
        Absent::Nothing => quote! {
            let #ident: Option<#ty> = match fields.get(#name) {
                Some(node) => #value,
                None => Some(None),
            };
        },
        Absent::Default(default) => quote! {
            let #ident: Option<#ty> = match fields.get(#name) {
                Some(node) => #value,
                None => Some(#default),
            };
        },
        Absent::Computed(..) => quote! {
            let #ident: Option<Option<#ty>> = match fields.get(#name) {
                Some(node) => #value,
                None => Some(None),
            };
        },
    }
}

/// Generates the calls of `formulas` or `references` for every field.
fn visit(parts: &[Part], method: &str) -> TokenStream {
    let method = format_ident!("{method}");
    let each = parts.iter().map(|part| {
        let (ident, ty) = (&part.field.ident, &part.field.ty);
        let role = role(part);
        let reference = if method == "formulas" { quote!(&self.#ident) } else { quote!(&mut self.#ident) };
        quote!(<#ty as crate::grammar::#role>::#method(#reference, found);)
    });
    each.collect()
}

fn leaves_plane(parts: &[Part]) -> TokenStream {
    let each = parts.iter().map(|part| {
        let (name, ty) = (part.name(), &part.field.ty);
        if part.key.is_group {
            return quote! {
                if let Some(key) = <#ty as crate::grammar::Group>::leaves_plane(mapping) {
                    return Some(key);
                }
            };
        }
        quote! {
            if mapping.get(#name).is_some_and(<#ty as crate::grammar::Value>::leaves_plane) {
                return Some(#name);
            }
        }
    });
    each.collect()
}

fn role(part: &Part) -> syn::Ident {
    if part.key.is_group { format_ident!("Group") } else { format_ident!("Value") }
}

fn element(ident: &syn::Ident, about: &Struct, keyword: &LitStr, what: &LitStr) -> Result<TokenStream> {
    let missing = |what: &str| syn::Error::new_spanned(keyword, format!("an element needs `{what} = \"…\"`"));
    let source = about.source.as_ref().ok_or_else(|| missing("source"))?;
    let example = about.example.as_ref().ok_or_else(|| missing("example"))?;
    if about.equations.is_empty() {
        return Err(missing("equation"));
    }
    let (doc, equations) = (&about.doc, &about.equations);
    let short = about.short.as_ref().map_or(quote!(None), |key| quote!(Some(#key)));
    let schema = json_schema(ident, &quote!(<Self as crate::grammar::Element>::object(generator)));
    let constrain = about.checked.then(|| {
        quote! {
            fn constrain(schema: &mut schemars::Schema) {
                <Self as crate::grammar::Checked>::constrain(schema);
            }
        }
    });
    Ok(quote! {
        #schema

        impl crate::grammar::Element for #ident {
            const KEYWORD: &'static str = #keyword;
            const WHAT: &'static str = #what;
            const DESCRIPTION: &'static str = #doc;
            const EQUATIONS: &'static [&'static str] = &[#(#equations),*];
            const SOURCE: &'static str = #source;
            const EXAMPLE: &'static str = #example;
            const SHORT: Option<&'static str> = #short;

            #constrain
        }
    })
}

/// `JsonSchema`: the struct's mapping under its own name.
fn json_schema(ident: &syn::Ident, schema: &TokenStream) -> TokenStream {
    let name = ident.to_string();
    quote! {
        impl schemars::JsonSchema for #ident {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                #name.into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                #schema
            }
        }
    }
}

fn mapping(ident: &syn::Ident, about: &Struct, what: &LitStr) -> TokenStream {
    let doc = &about.doc;
    let schema = json_schema(
        ident,
        &quote! {
            let keys = <Self as crate::grammar::Group>::keys(generator);
            crate::grammar::object_schema(#doc, keys)
        },
    );
    quote! {
        #schema

        impl crate::grammar::Value for #ident {
            const IMAGE: crate::grammar::Image =
                crate::grammar::Image::Keys(<Self as crate::grammar::Group>::images);

            fn read<S: crate::grammar::SymbolTable>(
                reader: &mut crate::grammar::Reader<'_, S>,
                node: &crate::grammar::Node,
                at: crate::grammar::Span,
                quantity: &crate::grammar::Quantity,
            ) -> Option<Self> {
                let fields = reader.mapping(#what, <Self as crate::grammar::Group>::key_names(), node, at)?;
                <Self as crate::grammar::Group>::read(reader, &fields, quantity.choice)
            }

            fn schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                generator.subschema_for::<Self>()
            }

            fn keys() -> Vec<crate::grammar::Key> {
                <Self as crate::grammar::Group>::keys(&mut schemars::SchemaGenerator::default())
            }

            fn formulas<'a>(&'a self, found: &mut Vec<&'a symdiff::Formula>) {
                crate::grammar::Group::formulas(self, found);
            }

            fn references<'a>(&'a mut self, found: &mut Vec<crate::grammar::Reference<'a>>) {
                crate::grammar::Group::references(self, found);
            }

            fn leaves_plane(node: &crate::grammar::Node) -> bool {
                <Self as crate::grammar::Group>::leaves_plane(node).is_some()
            }
        }
    }
}
