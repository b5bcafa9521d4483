//! Something that may be typed at the cursor.

use lsp_types::CompletionItemKind;

/// Something that may be typed.
pub struct Proposal {
    /// Its text in the list.
    pub label: String,
    /// The inserted text, if it is not the label.
    pub insert: Option<String>,
    /// Whether `insert` has fields to be filled in.
    pub is_snippet: bool,
    /// Its kind.
    pub kind: CompletionItemKind,
    /// Text next to the label.
    pub detail: Option<String>,
    /// Text below the label.
    pub documentation: Option<String>,
}

impl Proposal {
    /// A proposal with only a label and a kind.
    pub fn new(label: impl Into<String>, kind: CompletionItemKind) -> Self {
        Self { label: label.into(), insert: None, is_snippet: false, kind, detail: None, documentation: None }
    }

    /// Adds text next to the label.
    #[must_use]
    pub fn detail(self, detail: impl Into<String>) -> Self {
        Self { detail: Some(detail.into()).filter(|detail| !detail.is_empty()), ..self }
    }

    /// Adds text below the label.
    #[must_use]
    pub fn documentation(self, text: impl Into<String>) -> Self {
        Self { documentation: Some(text.into()).filter(|text| !text.is_empty()), ..self }
    }
}
