//! Meshes: files of triangles that a model names.

use std::path::Path;
use std::sync::Arc;

use schemars::{Schema, SchemaGenerator, json_schema};

use super::element::Value;
use super::reader::Reader;
use super::requirement::Quantity;
use super::symbols::SymbolTable;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::mesh_file::{Triangle, triangles};
use crate::syntax::regular;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::tuning::TUNING;
use crate::syntax::yaml::Node;

/// A mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Name of its file, as written.
    pub file: String,
    /// Its triangles, in the file's unit; empty if the file has not been read.
    pub triangles: Arc<[Triangle]>,
}

impl Mesh {
    /// A mesh whose file is read later, or never.
    pub fn unread(file: &str) -> Self {
        Self { file: file.to_owned(), triangles: Arc::new([]) }
    }
}

impl Value for Mesh {
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _at: Span, _quantity: &Quantity) -> Option<Self> {
        let name = &reader.scalar(node, "the name of an STL or OBJ file")?.text;
        let path = match reader.files.find(Path::new(""), name) {
            Ok(path) => reader.files.full(&path),
            Err(error) => {
                let help = error.help.clone();
                reader.diagnostics.push(Diagnostic::error(error.code, node.span.clone(), error.message).help(help));
                return None;
            }
        };
        let found = regular(&path, TUNING.mesh_bytes).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
            _ => error.to_string(),
        });
        match found.and_then(|bytes| triangles(&bytes)) {
            Ok(found) => Some(Self { file: name.clone(), triangles: found.into() }),
            Err(reason) => {
                let help = "an STL or OBJ file in the model's folder belongs here".to_owned();
                reader.error(Code::BadMesh, node.span.clone(), format!("`{}` is no mesh: {reason}", clip(name)), help);
                None
            }
        }
    }

    fn schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string" })
    }
}
