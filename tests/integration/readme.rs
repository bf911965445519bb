//! What the README shows is what happens: its commands are run, its outputs compared, its scenes checked.
//!
//! `PINHOLE_BLESS=1 cargo test readme` writes the real outputs into the README.

use std::{fs, path::Path, process::Command};

const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/README.md");

/// The blocks of the README fenced as `language`, each with the number of its first line.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<(usize, Vec<&'a str>)> {
    let mut blocks = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((_, line)) = lines.next() {
        let Some(fence) = line.strip_prefix("```") else {
            continue;
        };
        let mut body = Vec::new();
        let mut first = 0;
        for (number, line) in lines.by_ref() {
            if line == "```" {
                break;
            }
            if body.is_empty() {
                first = number;
            }
            body.push(line);
        }
        if fence == language {
            blocks.push((first, body));
        }
    }
    blocks
}

/// A folder like a fresh clone's, as far as the commands go, and the shell's answer to one of them there.
fn run(command: &str, folder: &Path) -> String {
    let binary = env!("CARGO_BIN_EXE_pinhole");
    let command = command.replace("cargo run --release -- ", "pinhole ");
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
    String::from_utf8(output.stdout).unwrap()
}

fn fresh_folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let to = folder.path().join("examples");
    fs::create_dir(&to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap();
        if path.extension().is_some_and(|ending| ending == "scn") || name == "figure_9_9.png" {
            fs::copy(&path, to.join(name)).unwrap();
        }
    }
    folder
}

/// Times are the only thing in an output that differs from run to run.
fn without_times(text: &str) -> String {
    let words = text.split_inclusive(char::is_whitespace);
    let mut result = String::new();
    let mut previous_was_number = false;
    for word in words {
        let is_unit = matches!(word.trim(), "s" | "s." | "ms" | "ms.");
        if is_unit && previous_was_number {
            let cut = result
                .trim_end()
                .rfind(char::is_whitespace)
                .map_or(0, |at| at + 1);
            result.truncate(cut);
            result.push_str("TIME ");
        }
        previous_was_number = word.trim().parse::<f64>().is_ok();
        result.push_str(word);
    }
    result
}

#[test]
fn the_commands_print_what_the_readme_says() {
    let text = fs::read_to_string(README).unwrap();
    let folder = fresh_folder();
    let mut real = text.clone();
    let mut commands = 0;
    for (_, block) in blocks(&text, "console") {
        let mut lines = block.iter().peekable();
        let (mut written, mut happened) = (String::new(), String::new());
        while let Some(line) = lines.next() {
            let command = line
                .strip_prefix("$ ")
                .expect("a console block starts with a command");
            let mut said = String::new();
            while let Some(line) = lines.next_if(|line| !line.starts_with("$ ")) {
                said += &format!("{line}\n");
            }
            let output = run(command, folder.path());
            let output = match output.is_empty() || output.ends_with('\n') {
                true => output,
                false => output + "\n",
            };
            let agrees = without_times(&said) == without_times(&output);
            written += &format!("{line}\n{said}");
            happened += &format!("{line}\n{}", if agrees { said } else { output });
            commands += 1;
        }
        real = real.replace(&written, &happened);
    }
    assert!(commands >= 5, "the README shows its commands");
    if std::env::var_os("PINHOLE_BLESS").is_some() {
        fs::write(README, real).unwrap();
    } else {
        assert!(real == text, "the README should read:\n{real}");
    }
}

#[test]
fn the_first_two_commands_stand_alone() {
    let text = fs::read_to_string(README).unwrap();
    for command in [
        "cargo run --release -- render examples/figure_9_9.scn",
        "cargo test",
    ] {
        assert!(text.lines().any(|line| line == command), "{command}");
    }
}

#[test]
fn the_scenes_of_the_readme_are_right() {
    let text = fs::read_to_string(README).unwrap();
    let folder = fresh_folder();
    let scenes = blocks(&text, "scn");
    assert!(!scenes.is_empty());
    for (line, scene) in scenes {
        let path = folder.path().join("scene.scn");
        fs::write(&path, scene.join("\n") + "\n").unwrap();
        assert_eq!(
            run("pinhole check scene.scn", folder.path()),
            "",
            "the scene in line {}",
            line + 1
        );
    }
    let figure = fs::read_to_string(folder.path().join("examples/figure_9_9.scn")).unwrap();
    assert!(
        text.contains(figure.trim()),
        "the README shows examples/figure_9_9.scn as it is"
    );
}
