//! Answers the requests of editors while an author writes a scene.
//!
//! In: a text, and an offset in it. Out: completions, the meaning of a word, the uses of a name and
//! so on, as plain data with byte spans. Each kind of answer has a file. The files know no editor
//! and no protocol: the language server converts the answers, and a page in a browser could do so,
//! too. All files use the language's tables in `schema`, and the tree and the scene from
//! `analysis`. If the text has errors, the tree and the scene contain the parts without errors.

mod actions;
mod analysis;
mod colors;
mod completion;
mod cursor;
mod folding;
mod hints;
mod hover;
mod limits;
mod names;
mod semantic;
mod signature;
mod symbols;
mod tokens;
pub mod viewport;

pub use actions::{fix_all, fixes, formatting, made_up_values};
pub use analysis::Analysis;
pub use colors::{Swatch, presentations, swatches};
pub use completion::{Completion, CompletionKind, SnippetPart, completions};
pub use folding::{Fold, FoldKind, folds};
pub use hints::{Hint, hints};
pub use hover::{Hover, hover};
pub use limits::{Limits, Slider, limits, sliders};
pub use names::{Occurrence, definition, occurrences, renamable, rename};
pub use semantic::{SemanticKind, SemanticToken, semantic_tokens};
pub use signature::{Signature, signature};
pub use symbols::{Symbol, SymbolKind, symbols};
pub use tokens::{Role, RoleToken};
