//! The handout's reference card has the same content as the tables of the language.

use std::path::Path;

use pinhole::schema::{BLOCKS, FUNCTIONS, METHODS, Preset};

use crate::snapshot::assert_file;

#[test]
fn the_card_is_that_of_the_schema() {
    let mut card = String::from(
        "# The card\n\n\
        Every block with its fields. Bold fields must be given; a value is what stands where nothing is given; of fields that \
        `or` joins one way is taken. Lengths are in metres, angles end in `deg` or `rad`, y points up.\n\n\
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
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/handout/card.md");
    assert_file(&path, &card);
}
