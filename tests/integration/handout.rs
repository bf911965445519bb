//! Compares the handout with its sources. The card, a short reference, must agree with the tables
//! of the scene language in the program. The HTML page must contain the files of the handout.

use std::{
    fs,
    path::{Path, PathBuf},
};

use pinhole::schema::{BLOCKS, FUNCTIONS, METHODS, Preset};
use pulldown_cmark::{Event, Options, Parser, Tag, html};

use crate::snapshot::assert_file;

/// Files of the handout in the order in which they should be read. The file with the answers to the
/// questions is left out, since it is for teachers only.
const PAGES: [&str; 7] = [
    "README",
    "camera",
    "pixel",
    "error",
    "right",
    "questions",
    "card",
];

fn path(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/handout");
    folder.join(name)
}

/// The page contains all files of the handout, so that it can be printed as a booklet. Links
/// between the files become links within the page; links to other documents stay as they are.
#[test]
fn the_page_is_that_of_the_files() {
    let mut page = String::from(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
        <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
        <title>Pinhole: a handout</title>\n<link rel=\"stylesheet\" href=\"handout.css\">\n</head>\n<body>\n<main>\n",
    );
    let folder = fs::read_dir(path("")).unwrap();
    let names = folder.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut pages: Vec<_> = names
        .filter_map(|name| name.strip_suffix(".md").map(str::to_owned))
        .filter(|name| name != "answers")
        .collect();
    pages.sort();
    let mut expected = PAGES;
    expected.sort();
    assert_eq!(pages, expected, "files of the handout");
    for name in PAGES {
        let text = fs::read_to_string(path(&format!("{name}.md"))).unwrap();
        let events = Parser::new_ext(&text, Options::ENABLE_TABLES).map(|event| match event {
            Event::Start(Tag::Link {
                link_type,
                dest_url,
                title,
                id,
            }) => {
                let target = dest_url.strip_suffix(".md").unwrap_or_default();
                let dest_url = if PAGES.contains(&target) {
                    format!("#{target}").into()
                } else {
                    dest_url
                };
                Event::Start(Tag::Link {
                    link_type,
                    dest_url,
                    title,
                    id,
                })
            }
            event => event,
        });
        page += &format!("<section id=\"{name}\">\n");
        html::push_html(&mut page, events);
        page += "</section>\n";
    }
    page += "</main>\n</body>\n</html>\n";
    assert_file(&path("handout.html"), &page);
}

#[test]
fn the_card_is_that_of_the_schema() {
    let mut card = String::from(
        "# The card\n\n\
        Every block with its fields. Bold fields must be given. Italic fields belong to ways of saying one thing: of the ways that \
        `or` joins, exactly one must be given; if none is italic, at most one. A value is what stands where nothing is given. Lengths are in metres, angles end in `deg` or `rad`, y points up.\n\n\
        | block | fields |\n| --- | --- |\n",
    );
    for block in BLOCKS {
        let shown = |name: &str| {
            let field = block.field(name).expect("a field of the block");
            match field.preset {
                Preset::Required => format!("**{name}**"),
                Preset::Alternative => format!("*{name}*"),
                Preset::Nothing => name.to_owned(),
                Preset::Value(value) => format!("{name} `{value}`"),
            }
        };
        let mut fields = Vec::new();
        for name in block.field_names() {
            let ways = block.choices.iter().map(|choice| choice.ways);
            let ways = ways.into_iter().find(|ways| ways.concat().contains(&name));
            match ways {
                None => fields.push(shown(name)),
                Some(ways) if ways[0][0] == name => {
                    let way = |way: &&[&str]| {
                        way.iter()
                            .map(|it| shown(it))
                            .collect::<Vec<_>>()
                            .join(", ")
                    };
                    let ways: Vec<_> = ways.iter().map(way).collect();
                    fields.push(ways.join(" or "));
                }
                Some(_) => {}
            }
        }
        card += &format!("| {} | {} |\n", block.name, fields.join("; "));
    }
    let methods: Vec<_> = METHODS.iter().map(|(method, _)| method.name()).collect();
    let functions: Vec<_> = FUNCTIONS.iter().map(|function| function.name).collect();
    card += &format!("\nMethods: {}.\n\n", methods.join(", "));
    card += &format!("Functions: {}.\n\n", functions.join(", "));
    card += "A file is a list of blocks and of `let NAME = VALUE`. An object may have a name (`sphere Ball { … }`), and may be repeated: \
        `sphere Bead for i < 8 { center (i, 0, 0) }`. Vectors are `(x, y, z)`, colours CSS names, `#rrggbb` or `rgb(255, 165, 0)`. \
        Operators are `+ - * /`. \
        Comments are `// …` and `/* … */`. [The reference](../../grammar/language.md) has the rest.\n";
    assert_file(&path("card.md"), &card);
}
