//! What diagnostics offer to do: over every fixture of `tests/diagnostics`, each fix does away with its problem and makes no
//! new error.

mod meaning;
mod mistyped;
mod offers;
mod slips;

use std::{collections::BTreeMap, fs};

use pinhole::{
    diagnostic::{Diagnostic, Fix, apply},
    scene,
    source::{Source, SourceId, Sources},
};

use crate::scenes::scenes;

fn sources(text: &str, sets: &[String]) -> Sources {
    Sources::new(Source::from_text("a.scn", text)).with_sets(sets)
}

fn diagnostics(sources: &Sources) -> Vec<Diagnostic> {
    scene::read(sources).diagnostics
}

/// The texts with a fix.
fn fixed(sources: &Sources, fix: &Fix) -> Sources {
    let sets = sources.sets();
    let sets = sets.map(|(id, set)| apply(fix, id, set.text()));
    let file = apply(fix, SourceId::File, sources.file.text());
    Sources::new(Source::from_text("a.scn", file)).with_sets(sets)
}

/// How often each thing is said, whatever white space stands in what it quotes.
fn counted(diagnostics: &[Diagnostic]) -> BTreeMap<(String, String), usize> {
    let mut counted = BTreeMap::new();
    for diagnostic in diagnostics {
        *counted.entry(said(diagnostic)).or_default() += 1;
    }
    counted
}

fn said(diagnostic: &Diagnostic) -> (String, String) {
    (diagnostic.code.clone(), diagnostic.message.replace(' ', ""))
}

/// Every fixture that is a text, with its name and the arguments that it gives.
fn fixtures() -> Vec<(String, Sources)> {
    let mut fixtures = Vec::new();
    for path in scenes("tests/diagnostics") {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if let Ok(text) = fs::read_to_string(&path) {
            let sets = text.lines().filter_map(|l| l.strip_prefix("// --set "));
            let sets: Vec<String> = sets.map(str::to_owned).collect();
            fixtures.push((name, sources(&text, &sets)));
        }
    }
    fixtures
}

/// Types in every fix that is offered, and complains where its problem stays or another one comes; answers how many fixes
/// there were.
fn type_in_fixes(
    name: &str,
    before_sources: &Sources,
    is_meant: impl Fn(&Diagnostic) -> bool,
    complaints: &mut Vec<String>,
) -> usize {
    let mut fixes = 0;
    let before = diagnostics(before_sources);
    let said_before = counted(&before);
    for diagnostic in before.iter().filter(|diagnostic| is_meant(diagnostic)) {
        for fix in &diagnostic.fixes {
            fixes += 1;
            let after_sources = fixed(before_sources, fix);
            let after = diagnostics(&after_sources);
            let said_after = counted(&after);
            let this = said(diagnostic);
            let text = after_sources.file.text();
            if said_after.get(&this) >= said_before.get(&this) {
                complaints.push(format!("{name}: {} stays: {this:?}\n{text}", fix.title));
            }
            for new in after.iter().filter(|d| d.is_error()) {
                let new_said = said(new);
                if said_after.get(&new_said) <= said_before.get(&new_said) {
                    continue;
                }
                complaints.push(format!("{name}: `{}`: new {new_said:?}", fix.title));
            }
        }
    }
    fixes
}

#[test]
fn every_fix_helps() {
    let (mut fixes, mut complaints) = (0, Vec::new());
    for (name, before_sources) in fixtures() {
        fixes += type_in_fixes(&name, &before_sources, |_| true, &mut complaints);
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(fixes > 100, "{fixes} fixes");
}

/// The edits lie in the text, between characters, and do not overlap, whatever the text.
#[test]
fn edits_fit_into_any_text() {
    let mut edits = 0;
    for (_, whole) in fixtures() {
        let text = whole.file.text();
        for (end, _) in text.char_indices().step_by(11) {
            let sources = sources(&text[..end], &[]);
            for diagnostic in diagnostics(&sources) {
                for fix in &diagnostic.fixes {
                    let mut at = 0;
                    for edit in &fix.edits {
                        let range = edit.span.range();
                        assert!(range.start >= at, "{fix:?} in {:?}", &text[..end]);
                        assert!(text[..end].get(range.clone()).is_some(), "{fix:?}");
                        at = range.end;
                        edits += 1;
                    }
                }
            }
        }
    }
    assert!(edits > 500, "{edits} edits");
}

/// The titles of the fixes for the first problem of a text, each with what it makes of the text.
fn offered(text: &str) -> Vec<(String, String)> {
    let sources = sources(text, &[]);
    let first = diagnostics(&sources).into_iter().next().unwrap();
    let fixes = first.fixes.into_iter();
    fixes
        .map(|fix| {
            let text = apply(&fix, SourceId::File, text);
            (fix.title, text)
        })
        .collect()
}

/// Behind some text stands what makes a scene of it.
fn of_scene(text: &str) -> String {
    format!("{text}\ncheckerboard {{}}\ncamera {{ eye (0, 1, 5)  lookat (0, 1, 0) }}\n")
}
