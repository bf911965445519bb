//! The documents say what happens: their commands are run and the outputs compared, their scenes are checked, and their links
//! lead to files.
//!
//! `PINHOLE_BLESS=1 cargo test readme` writes the real outputs into the documents.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The documents whose `console` blocks are run and whose `scn` blocks are checked.
const DOCUMENTS: [&str; 4] = [
    "README.md",
    "docs/accuracy.md",
    "docs/speed.md",
    "examples/README.md",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(document: &str) -> String {
    fs::read_to_string(root().join(document)).unwrap()
}

/// The blocks of a document that are fenced as `language`, each with the number of its first line.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<(usize, Vec<&'a str>)> {
    let mut blocks = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(fence) = line.strip_prefix("```") else {
            continue;
        };
        let body = lines.by_ref().map(|(_, line)| line);
        let body = body.take_while(|line| *line != "```").collect();
        if fence == language {
            blocks.push((number + 2, body));
        }
    }
    blocks
}

/// What a shell prints when it runs `command` in `folder`.
fn run(command: &str, folder: &Path) -> String {
    let binary = env!("CARGO_BIN_EXE_pinhole");
    let path = format!(
        "{}:{}",
        Path::new(binary).parent().unwrap().display(),
        std::env::var("PATH").unwrap()
    );
    let output = Command::new("sh")
        .args(["-c", &format!("{{ {command}; }} 2>&1")])
        .current_dir(folder)
        .env("PATH", path)
        .env("NO_COLOR", "1")
        .env("LC_ALL", "C.UTF-8")
        .env_remove("NO_GRAPHICS")
        .output()
        .unwrap();
    let mut output = String::from_utf8(output.stdout).unwrap();
    if !output.is_empty() && !output.ends_with('\n') {
        output.push('\n');
    }
    output
}

/// A folder with the examples of a fresh clone.
fn fresh_folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("examples");
    fs::create_dir(&to).unwrap();
    for entry in fs::read_dir(root().join("examples")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap();
        if path.extension().is_some_and(|ending| ending == "scn") || name == "figure_9_9.png" {
            fs::copy(&path, to.join(name)).unwrap();
        }
    }
    folder
}

/// The document with the real outputs of its commands.
fn with_real_outputs(document: &str, text: &str) -> String {
    let folder = fresh_folder();
    let mut real = text.to_owned();
    let mut commands = 0;
    for (_, block) in blocks(text, "console") {
        let mut happened = String::new();
        let mut lines = block.iter().peekable();
        while let Some(line) = lines.next() {
            let command = line
                .strip_prefix("$ ")
                .expect("a console block starts with a command");
            while lines.next_if(|line| !line.starts_with("$ ")).is_some() {}
            happened += &format!("{line}\n{}", run(command, folder.path()));
            commands += 1;
        }
        let written = block.join("\n") + "\n";
        real = real.replace(&written, &happened);
    }
    assert!(commands > 0, "{document} shows commands");
    real
}

#[test]
fn the_commands_print_what_the_documents_say() {
    let bless = std::env::var_os("PINHOLE_BLESS").is_some();
    for document in DOCUMENTS {
        let text = read(document);
        let real = with_real_outputs(document, &text);
        if bless {
            fs::write(root().join(document), real).unwrap();
            continue;
        }
        for (number, (said, printed)) in text.lines().zip(real.lines()).enumerate() {
            assert_eq!(said, printed, "line {} of {document}", number + 1);
        }
        assert_eq!(text.len(), real.len(), "{document} says all and no more");
    }
}

#[test]
fn the_scenes_of_the_documents_are_right() {
    let folder = fresh_folder();
    for document in DOCUMENTS {
        let text = read(document);
        for (line, scene) in blocks(&text, "scn") {
            fs::write(folder.path().join("scene.scn"), scene.join("\n") + "\n").unwrap();
            let found = run("pinhole check scene.scn", folder.path());
            assert_eq!(found, "", "the scene in line {line} of {document}");
        }
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

/// All Markdown files in `folder` and below it.
fn markdown(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("node_modules") {
            markdown(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
}

/// The targets of a document's links and pictures, `[text](target)`. A fenced block is code and has none.
fn links(text: &str) -> Vec<&str> {
    let mut links = Vec::new();
    let mut fenced = false;
    for line in text.lines() {
        fenced ^= line.starts_with("```");
        if fenced {
            continue;
        }
        let mut rest = line;
        while let Some((_, after)) = rest.split_once("](") {
            let (target, after) = after.split_once(')').expect("a link has an end");
            links.push(target);
            rest = after;
        }
    }
    links
}

#[test]
fn relative_links_lead_to_files() {
    let mut documents = vec![root().join("README.md"), root().join("CHANGELOG.md")];
    for folder in ["docs", "examples", "benches", "grammar"] {
        markdown(&root().join(folder), &mut documents);
    }
    let (mut followed, mut missing) = (0, Vec::new());
    for document in documents {
        let text = fs::read_to_string(&document).unwrap();
        let relative = links(&text)
            .into_iter()
            .filter(|link| !link.contains("://"));
        for link in relative {
            let file = link.split('#').next().unwrap();
            followed += 1;
            if !document.with_file_name("").join(file).exists() {
                missing.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(followed > 50, "only {followed} links were found");
    assert!(missing.is_empty(), "{missing:#?}");
}
