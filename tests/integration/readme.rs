//! Tests that the documents are correct: their commands print the outputs shown, their scenes have
//! no mistakes, and their links lead to files.
//!
//! `PINHOLE_BLESS=1 cargo test readme` writes the current outputs into the documents.

use std::{fs, path::Path};

use crate::{
    diagnostics::diagnose,
    format::formatted,
    program::{Folder, names},
    scenes::{examples, fenced},
    snapshot::assert_file,
};

/// Documents whose `console` blocks are run and whose `scn` blocks are checked.
const DOCUMENTS: [&str; 12] = [
    "README.md",
    "docs/accuracy.md",
    "docs/commands.md",
    "docs/handout/answers.md",
    "docs/handout/camera.md",
    "docs/handout/error.md",
    "docs/handout/pixel.md",
    "docs/handout/questions.md",
    "docs/handout/right.md",
    "docs/speed.md",
    "docs/teaching.md",
    "examples/README.md",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(document: &str) -> String {
    fs::read_to_string(root().join(document)).unwrap()
}

/// Returns what a shell prints, to standard output and standard error, when it runs `command` in a
/// folder.
fn run(command: &str, folder: &Folder) -> String {
    let said = folder.shell(&format!("{{ {command}; }} 2>&1"));
    match said.text() {
        output if output.is_empty() || output.ends_with('\n') => output.to_owned(),
        output => format!("{output}\n"),
    }
}

/// Returns a folder with the example files that a fresh clone of the repository contains.
fn fresh_folder() -> Folder {
    let folder = Folder::with([]);
    for part in ["examples", "examples/lessons"] {
        for name in names(&root().join(part)) {
            let is_text = name.ends_with(".scn") || name.ends_with(".md");
            if is_text || name == "figure_9_9.png" {
                let path = format!("{part}/{name}");
                folder.write(&path, fs::read(root().join(&path)).unwrap());
            }
        }
    }
    folder
}

/// Returns the text of a document with the current outputs of its commands, which run in `folder`.
fn with_real_outputs(text: &str, folder: &Folder) -> String {
    let mut real = text.to_owned();
    let blocks = fenced(text, "console");
    assert!(!blocks.is_empty(), "a document shows commands");
    for block in blocks {
        assert!(block.starts_with("$ "), "{block}");
        let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
        let happened = commands.map(|command| format!("$ {command}\n{}", run(command, folder)));
        real = real.replace(block, &happened.collect::<String>());
    }
    real
}

#[test]
fn the_commands_print_what_the_documents_say() {
    for document in DOCUMENTS {
        let (text, folder) = (read(document), fresh_folder());
        assert_file(&root().join(document), &with_real_outputs(&text, &folder));
        if document.starts_with("docs/handout/") {
            let pictures = root().join(document);
            assert_pictures(pictures.parent().unwrap(), &text, &folder);
        }
    }
}

/// Asserts that the commands in a document make exactly the pictures that the document shows.
/// Ignores a shown picture that no command makes, such as a picture of another document.
fn assert_pictures(beside: &Path, text: &str, folder: &Folder) {
    let shown = text.split("![").skip(1).filter_map(|image| {
        let (_, rest) = image.split_once("](")?;
        rest.split(')').next()
    });
    for name in shown.filter(|name| folder.path(name).exists()) {
        let (made, kept) = (folder.read(name), beside.join(name));
        if std::env::var_os("PINHOLE_BLESS").is_some() {
            fs::write(&kept, &made).unwrap();
        }
        let kept = fs::read(&kept).unwrap_or_default();
        assert!(made == kept, "{name} is not what its command makes");
    }
}

#[test]
fn scenes_in_documents_and_examples_are_valid_and_formatted() {
    let mut texts: Vec<String> = DOCUMENTS.map(read).into();
    texts.push(read("grammar/language.md"));
    texts.push(read("grammar/left_handed.md"));
    let mut scenes: Vec<&str> = texts.iter().flat_map(|text| fenced(text, "scn")).collect();
    assert!(scenes.len() > 5, "{} scenes", scenes.len());
    for scene in &scenes {
        assert_eq!(diagnose(scene, &[]), [], "{scene}");
    }
    let examples = examples();
    scenes.extend(examples.iter().map(String::as_str));
    for scene in scenes {
        assert_eq!(formatted(scene).as_deref(), Ok(scene));
    }
}

#[test]
fn the_readme_has_the_two_set_up_commands_and_the_first_scene() {
    let text = read("README.md");
    for command in [
        "cargo run --release -- render examples/figure_9_9.scn",
        "cargo test",
    ] {
        assert!(text.lines().any(|line| line == command), "{command}");
    }
    assert!(text.contains(read("examples/figure_9_9.scn").trim()));
}

#[test]
fn every_command_is_in_the_readme_and_has_examples() {
    let (folder, readme) = (Folder::with([]), read("README.md"));
    let reference = read("docs/commands.md");
    let help = folder.done("--help").text().to_owned();
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let list = list.lines().take_while(|line| !line.is_empty());
    let commands = list.map(|line| line.split_whitespace().next().unwrap());
    for command in commands.filter(|name| *name != "help") {
        let call = format!("pinhole {command}");
        for (document, text) in [("README.md", &readme), ("docs/commands.md", &reference)] {
            assert!(
                text.contains(&format!("`{call}")),
                "no {call} in {document}"
            );
        }
        // The command `lsp` has no examples, because editors start it and nobody types its
        // messages.
        let help = folder.done(&format!("{command} --help"));
        let examples = help.text().split_once("Examples:");
        let is_shown = examples.is_some_and(|(_, examples)| examples.contains(&call));
        let is_shown = is_shown || command == "lsp";
        assert!(is_shown, "{command} --help has no examples");
    }
}

#[test]
fn relative_links_lead_to_files() {
    let mut paths = [
        "README.md",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "docs",
        "examples",
        "benches",
        "grammar",
        "python/README.md",
        "studio/page/README.md",
    ]
    .map(|name| root().join(name))
    .to_vec();
    let (mut followed, mut missing) = (0, Vec::new());
    while let Some(path) = paths.pop() {
        // Folders of installed packages and of built files are skipped.
        let is_made = ["node_modules", "dist"]
            .iter()
            .any(|name| path.ends_with(name));
        if path.is_dir() && !is_made {
            paths.extend(names(&path).into_iter().map(|name| path.join(name)));
        } else if path.extension().is_some_and(|ending| ending == "md") {
            let text = fs::read_to_string(&path).unwrap();
            // Fenced blocks contain code and no links. They are every second part of the text, and
            // are skipped.
            let parts = text.split("```").step_by(2);
            let links = parts.flat_map(|part| part.split("](").skip(1));
            for link in links {
                let (link, _) = link.split_once(')').expect("a link has an end");
                let file = link.split('#').next().unwrap();
                if !link.contains("://") {
                    followed += 1;
                    if !path.with_file_name(file).exists() {
                        missing.push(format!("{}: {link}", path.display()));
                    }
                }
            }
        }
    }
    assert!(followed > 50, "only {followed} links were found");
    assert!(missing.is_empty(), "{missing:#?}");
}
