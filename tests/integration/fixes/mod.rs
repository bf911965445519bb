//! What diagnostics offer to do: each fix does away with its problem and makes no new error.

mod mistyped;
mod offers;
mod slips;

use std::collections::BTreeMap;

use pinhole::{
    diagnostic::{Diagnostic, Fix, apply},
    scene,
    source::{Source, SourceId, Sources},
};

use crate::{diagnostics::fixtures, scenes::sources};

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
fn counted<'d>(
    diagnostics: impl IntoIterator<Item = &'d Diagnostic>,
) -> BTreeMap<(&'d str, String), usize> {
    let mut counted = BTreeMap::new();
    for diagnostic in diagnostics {
        *counted.entry(said(diagnostic)).or_default() += 1;
    }
    counted
}

fn said(diagnostic: &Diagnostic) -> (&str, String) {
    (&diagnostic.code, diagnostic.message.replace(' ', ""))
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
            let this = said(diagnostic);
            if counted(&after).get(&this) >= said_before.get(&this) {
                let text = after_sources.file.text();
                complaints.push(format!("{name}: {} stays: {this:?}\n{text}", fix.title));
            }
            for (new, times) in counted(after.iter().filter(|d| d.is_error())) {
                if Some(&times) > said_before.get(&new) {
                    complaints.push(format!("{name}: `{}`: new {new:?}", fix.title));
                }
            }
        }
    }
    fixes
}

#[test]
fn every_fix_helps() {
    let (mut fixes, mut complaints) = (0, Vec::new());
    for (name, sources) in fixtures() {
        fixes += type_in_fixes(&name, &sources, |_| true, &mut complaints);
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(fixes > 100, "{fixes} fixes");
}

/// The titles of the fixes for the first problem of a text, each with what it makes of the text.
fn offered(text: &str) -> Vec<(String, String)> {
    let first = diagnostics(&sources(text)).swap_remove(0);
    let text = |fix: &Fix| apply(fix, SourceId::File, text);
    let fixes = first.fixes.into_iter();
    fixes.map(|fix| (fix.title.clone(), text(&fix))).collect()
}

/// Behind some text stands what makes a scene of it.
fn of_scene(text: &str) -> String {
    let camera = match text.contains("camera {") {
        true => "",
        false => "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n",
    };
    format!("{text}\ncheckerboard {{}}\n{camera}")
}
