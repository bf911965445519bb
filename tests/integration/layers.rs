//! Tests that the modules of the library import each other only in one direction, namely in the
//! order of `src/lib.rs`. Also tests that no file is too long to be read in one sitting.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// Returns the groups of modules in `src/lib.rs`. Blank lines separate the groups.
fn groups(source: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(source.join("lib.rs")).unwrap();
    let module = |line: &str| {
        let (_, name) = line.split_once("mod ")?;
        Some(name.strip_suffix(';')?.to_owned())
    };
    let groups = text.split("\n\n");
    let groups = groups.map(|group| group.lines().filter_map(module).collect());
    groups.filter(|group: &Vec<_>| !group.is_empty()).collect()
}

/// Returns the code of a file, or of all files of a folder, without comments and unit tests.
/// Returns an empty text if the path does not exist, because a module may be a file, a folder or
/// both.
fn code(path: &Path) -> String {
    if path.is_dir() {
        let entries = fs::read_dir(path).unwrap();
        return entries.map(|entry| code(&entry.unwrap().path())).collect();
    }
    let is_code = path.extension().is_some_and(|ending| ending == "rs");
    if !is_code || !path.exists() || path.file_stem().is_some_and(|name| name == "tests") {
        return String::new();
    }
    let text = fs::read_to_string(path).unwrap();
    let own = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let lines = own.lines().filter(|line| !line.trim().starts_with("//"));
    lines.map(|line| line.to_owned() + "\n").collect()
}

/// Returns the first name after each `crate::` in `code`. If a list in braces follows, returns the
/// first name of each of its elements.
fn imports(code: &str) -> BTreeSet<String> {
    let name = |text: &str| -> String {
        let signs = text.trim_start().chars();
        signs
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect()
    };
    let mut found = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        let Some(list) = rest.strip_prefix('{') else {
            found.insert(name(rest));
            continue;
        };
        let (mut depth, mut own) = (1, String::new());
        for sign in list.chars() {
            match sign {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ if depth == 1 => own.push(sign),
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
        found.extend(own.split(',').map(name));
    }
    found
}

#[test]
fn modules_import_one_way_in_the_order_of_the_library() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let groups = groups(&source);
    assert!(groups.len() > 5, "{groups:?}");
    let mut before: BTreeSet<&String> = BTreeSet::new();
    for group in &groups {
        before.extend(group);
        let mut rest: BTreeMap<&String, BTreeSet<String>> = group
            .iter()
            .map(|module| {
                let text = code(&source.join(format!("{module}.rs"))) + &code(&source.join(module));
                (module, imports(&text))
            })
            .collect();
        let all = groups.iter().flatten();
        for (module, imported) in &rest {
            let after = all.clone().filter(|it| !before.contains(it));
            let wrong: Vec<_> = after.filter(|it| imported.contains(*it)).collect();
            assert!(
                wrong.is_empty(),
                "{module} imports {wrong:?}, which come after it"
            );
        }
        // A module that imports none of the remaining modules belongs to no circle of imports, so
        // it is removed.
        while !rest.is_empty() {
            let is_free = |module: &&String| {
                let mut others = rest.keys().filter(|it| *it != module);
                !others.any(|other| rest[*module].contains(*other))
            };
            let free = rest.keys().copied().find(is_free);
            let free = free.unwrap_or_else(|| panic!("a circle among {:?}", rest.keys()));
            rest.remove(free);
        }
    }
}

#[test]
fn no_file_of_the_library_or_its_tests_is_longer_than_500_lines() {
    let mut folders = ["src", "tests"]
        .map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder))
        .to_vec();
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                files += 1;
                let lines = fs::read_to_string(&path).unwrap().lines().count();
                assert!(lines <= 500, "{}: {lines} lines", path.display());
            }
        }
    }
    assert!(files > 100, "{files}");
}
