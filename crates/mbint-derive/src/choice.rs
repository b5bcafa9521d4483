//! Enums: one of a few words.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Data, DeriveInput, Result};

use crate::attributes::doc;

pub fn derive(input: &DeriveInput) -> Result<TokenStream> {
    let Data::Enum(data) = &input.data else {
        return Err(syn::Error::new_spanned(input, "a choice is an enum"));
    };
    let ident = &input.ident;
    let variants: Vec<_> = data.variants.iter().map(|variant| &variant.ident).collect();
    let words: Vec<String> = variants.iter().map(|variant| snake_case(&variant.to_string())).collect();
    let docs: Vec<String> = data.variants.iter().map(|variant| doc(&variant.attrs)).collect();
    Ok(quote! {
        impl crate::grammar::Value for #ident {
            fn read<S: crate::grammar::SymbolTable>(
                reader: &mut crate::grammar::Reader<'_, S>,
                node: &crate::grammar::Node,
                _at: crate::grammar::Span,
                _quantity: &crate::grammar::Quantity,
            ) -> Option<Self> {
                reader.choice(node, &[#((#words, Self::#variants)),*])
            }

            fn schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!({
                    "oneOf": [#({ "description": #docs, "type": "string", "const": #words }),*]
                })
            }

            fn to_json(&self) -> Option<serde_json::Value> {
                Some(match self {
                    #(Self::#variants => #words.into()),*
                })
            }
        }
    })
}

/// `HuntCrossley` → `hunt_crossley`.
fn snake_case(name: &str) -> String {
    let mut word = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !word.is_empty() {
            word.push('_');
        }
        word.extend(letter.to_lowercase());
    }
    word
}
