//! The language's answers to one who is writing a scene.
//!
//! In: a text, and a place in it. Out: what could stand there, what a word means, where a name is
//! used, and so on, as plain data with byte spans. A file per answer. They know no editor and no
//! protocol: the language server converts them, and a page in a browser could as well. Everything
//! reads the one table of facts and the one lowering, which fill in what they can of a broken text.

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
pub use completion::{Completion, CompletionKind, Piece, completions};
pub use folding::{Fold, FoldKind, folds};
pub use hints::{Hint, hints};
pub use hover::{Hover, hover};
pub use limits::{Limits, Slider, limits, sliders};
pub use names::{Occurrence, definition, occurrences, renamable, rename};
pub use semantic::{SemanticKind, SemanticToken, semantic_tokens};
pub use signature::{Signature, signature};
pub use symbols::{Symbol, SymbolKind, symbols};
pub use tokens::{Role, Token};
