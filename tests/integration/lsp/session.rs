//! Whole conversations.

use serde_json::{Value, json};

use super::client::{Client, URI};

const SCENE: &str = "let ball = (0, 1, 0)
camera { eye (0, 1, 5)  lookat ball  d 1 }
sphere Ball { center ball  color olive }
";

/// What an editor of today says of itself, as far as it matters.
fn editor() -> Value {
    json!({
        "general": { "positionEncodings": ["utf-8", "utf-16"], "markdown": { "parser": "marked" } },
        "workspace": { "workspaceEdit": { "documentChanges": true } },
        "textDocument": {
            "completion": { "completionItem": { "snippetSupport": true } },
            "hover": { "contentFormat": ["markdown", "plaintext"] },
            "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
            "publishDiagnostics": { "relatedInformation": true, "versionSupport": true, "codeDescriptionSupport": true },
        },
    })
}

fn range(line: u32, start: u32, end: u32) -> Value {
    json!({ "start": { "line": line, "character": start }, "end": { "line": line, "character": end } })
}

#[test]
fn a_scene_is_written_with_every_answer() {
    let (mut client, diagnostics) = Client::open(editor(), SCENE);
    assert_eq!(
        diagnostics,
        json!({ "uri": URI, "version": 1, "diagnostics": [] })
    );

    let definition = json!({ "uri": URI, "range": range(0, 4, 8) });
    assert_eq!(client.at("definition", 1, 32), definition);
    let references = client.about(
        "references",
        json!({ "position": { "line": 0, "character": 5 }, "context": { "includeDeclaration": false } }),
    );
    let uses = [range(1, 31, 35), range(2, 21, 25)];
    assert_eq!(
        references,
        json!(
            uses.clone()
                .map(|range| json!({ "uri": URI, "range": range }))
        )
    );
    let highlights = client.at("documentHighlight", 1, 31);
    assert_eq!(highlights[0], json!({ "range": range(0, 4, 8), "kind": 3 }));
    assert_eq!(highlights[1], json!({ "range": uses[0], "kind": 2 }));

    let hover = client.at("hover", 2, 34);
    let markdown = hover["contents"]["value"].as_str().expect("markdown");
    assert!(
        markdown.ends_with("in linear light (0.215861, 0.215861, 0)"),
        "{markdown}"
    );
    assert_eq!(hover["range"], range(2, 33, 38));

    let prepared = client.at("prepareRename", 0, 8);
    assert_eq!(
        prepared,
        json!({ "range": range(0, 4, 8), "placeholder": "ball" })
    );
    let renamed = client.about(
        "rename",
        json!({ "position": { "line": 0, "character": 4 }, "newName": "middle" }),
    );
    let change = &renamed["documentChanges"][0];
    assert_eq!(change["textDocument"], json!({ "uri": URI, "version": 1 }));
    assert_eq!(
        change["edits"][2],
        json!({ "range": uses[1], "newText": "middle" })
    );
    let refused = client.respond(
        "textDocument/rename",
        json!({ "textDocument": { "uri": URI }, "position": { "line": 0, "character": 4 }, "newName": "olive" }),
    );
    assert_eq!(
        refused["error"],
        json!({ "code": -32803, "message": "`olive` is a colour of the language" })
    );

    let symbols = client.about("documentSymbol", json!({}));
    assert_eq!(symbols[2]["name"], "Ball");
    assert_eq!(symbols[2]["children"][1]["name"], "color");
    let folds = client.about("foldingRange", json!({}));
    assert_eq!(folds, json!([]));
    let hints = client.about("inlayHint", json!({ "range": range(1, 0, 99) }));
    let hints: Vec<&Value> = hints
        .as_array()
        .expect("a list")
        .iter()
        .map(|hint| &hint["label"])
        .collect();
    assert_eq!(hints, ["= (0, 1, 0)", "fov 90deg"]);

    let options = json!({ "options": { "tabSize": 2, "insertSpaces": true } });
    assert_eq!(client.about("formatting", options), json!([]));
    let colors = client.about("documentColor", json!({}));
    assert_eq!(colors[0]["range"], range(2, 33, 38));
    let teal = json!({ "red": 0.0, "green": 0.5, "blue": 0.5, "alpha": 1.0 });
    let presentations = client.about(
        "colorPresentation",
        json!({ "color": teal, "range": range(2, 33, 38) }),
    );
    assert_eq!(
        presentations[0]["textEdit"],
        json!({ "range": range(2, 33, 38), "newText": "teal" })
    );

    let tokens = client.about("semanticTokens/full", json!({}));
    // let ball = ( 0: a keyword, a variable that is defined, an operator, a number.
    let start = [0, 0, 3, 0, 0, 0, 4, 4, 2, 1, 0, 5, 1, 7, 0, 0, 3, 1, 6, 0];
    assert_eq!(
        tokens["data"].as_array().expect("a list")[..20],
        start.map(Value::from)
    );
    client.leave();
}

#[test]
fn texts_change_while_one_types() {
    let (mut client, _) = Client::open(editor(), SCENE);
    // A mistyped field is put in behind the colour, where the text has a character of four bytes before it.
    let changes = json!([
        { "range": range(2, 38, 38), "text": "  /* 🎱 */ radus 2  co" },
    ]);
    let document = json!({ "uri": URI, "version": 2 });
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": document, "contentChanges": changes }),
    );
    let told = client.read();
    assert_eq!(told["params"]["version"], 2);
    let diagnostics = told["params"]["diagnostics"]
        .as_array()
        .expect("a list")
        .clone();
    let radus = diagnostics
        .iter()
        .find(|found| found["code"] == "unknown_field")
        .expect("it is wrong");
    // Columns are bytes here.
    assert_eq!(radus["range"], range(2, 51, 56));
    assert_eq!(radus["severity"], 1);
    assert_eq!(radus["source"], "pinhole");
    assert_eq!(
        radus["message"],
        "a sphere has no field `radus`\nhelp: did you mean `radius`? A sphere takes center, radius and color."
    );

    let actions = client.about(
        "codeAction",
        json!({ "range": range(2, 53, 53), "context": { "diagnostics": [] } }),
    );
    assert_eq!(actions[0]["title"], "write `radius`");
    assert_eq!(actions[0]["isPreferred"], true);
    assert_eq!(actions[0]["diagnostics"][0]["code"], "unknown_field");
    let edit = &actions[0]["edit"]["documentChanges"][0];
    assert_eq!(edit["textDocument"]["version"], 2);
    assert_eq!(
        edit["edits"],
        json!([{ "range": range(2, 51, 56), "newText": "radius" }])
    );
    let others = client.about(
        "codeAction",
        json!({ "range": range(2, 53, 53), "context": { "diagnostics": [], "only": ["refactor"] } }),
    );
    assert_eq!(others, json!([]));

    let all = client.about(
        "codeAction",
        json!({ "range": range(0, 0, 0), "context": { "diagnostics": [], "only": ["source.fixAll"] } }),
    );
    assert_eq!(all[0]["kind"], "source.fixAll");
    let edit = &all[0]["edit"]["documentChanges"][0]["edits"];
    assert_eq!(
        edit,
        &json!([{ "range": range(2, 54, 54), "newText": "i" }])
    );

    let completions = client.at("completion", 2, 50 + 11);
    let labels: Vec<&str> = completions
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|item| item["label"].as_str())
        .collect();
    assert_eq!(labels, ["radius"]);
    assert_eq!(completions[0]["textEdit"]["newText"], "radius ${1:1}");
    assert_eq!(completions[0]["insertTextFormat"], 2);

    let close = json!({ "textDocument": { "uri": URI } });
    client.tell("textDocument/didClose", close);
    assert_eq!(
        client.read()["params"],
        json!({ "uri": URI, "diagnostics": [] })
    );
    let gone = client.respond(
        "textDocument/hover",
        json!({ "textDocument": { "uri": URI }, "position": { "line": 0, "character": 0 } }),
    );
    assert_eq!(gone["error"]["code"], -32602);
    client.leave();
}

/// Letter by letter, with what an editor asks after each.
#[test]
fn an_example_is_typed_letter_by_letter() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/figure_9_9.scn");
    let example = std::fs::read_to_string(path).expect("the example is there");
    let (mut client, _) = Client::open(editor(), "");
    let (mut line, mut character) = (0, 0);
    for (index, letter) in example.chars().enumerate() {
        let document = json!({ "uri": URI, "version": index + 2 });
        let change = json!({ "range": { "start": { "line": line, "character": character }, "end": { "line": line, "character": character } }, "text": letter.to_string() });
        client.tell(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": [change] }),
        );
        match letter {
            '\n' => (line, character) = (line + 1, 0),
            _ => character += 1,
        }
        client.at("completion", line, character);
        client.about("semanticTokens/full", json!({}));
    }
    assert_eq!(client.diagnostics(example.chars().count() + 1), json!([]));
    client.leave();
}

#[test]
fn a_client_of_few_words_gets_plain_answers() {
    let (mut client, diagnostics) = Client::open(
        json!({}),
        "/* 🎱 */ sphere { radius 1  radius 2  center (0, 0, 0) }",
    );
    let twice = diagnostics["diagnostics"]
        .as_array()
        .expect("a list")
        .iter()
        .find(|found| found["code"] == "duplicate_field");
    let twice = twice.expect("it is given twice");
    // Columns are units of UTF-16.
    assert_eq!(twice["range"], range(0, 28, 34));
    let first =
        json!([{ "location": { "uri": URI, "range": range(0, 18, 24) }, "message": "first here" }]);
    assert_eq!(twice["relatedInformation"], first);
    let completions = client.at("completion", 0, 37);
    assert_eq!(completions[0]["label"], "color");
    assert_eq!(completions[0]["textEdit"]["newText"], "color olive");
    assert_eq!(completions[0]["insertTextFormat"], 1);
    let renamed = client.respond("textDocument/rename", json!({ "textDocument": { "uri": URI }, "position": { "line": 0, "character": 19 }, "newName": "x" }));
    assert_eq!(
        renamed["error"]["message"],
        "`radius` is a word of the language"
    );
    client.leave();
}

#[test]
fn a_conversation_begins_and_ends_as_it_should() {
    let mut client = Client::start();
    let early = client.respond("textDocument/hover", json!({}));
    assert_eq!(early["error"]["code"], -32002);
    client.tell("textDocument/didOpen", json!({ "nonsense": true }));
    let hello = client.ask("initialize", json!({ "capabilities": {} }));
    assert_eq!(hello["serverInfo"]["name"], "pinhole");
    assert_eq!(hello["capabilities"]["positionEncoding"], "utf-16");
    assert_eq!(
        hello["capabilities"]["experimental"],
        json!({ "pinhole": 1 })
    );
    let legend = &hello["capabilities"]["semanticTokensProvider"]["legend"];
    assert_eq!(
        legend["tokenTypes"],
        json!([
            "keyword",
            "property",
            "variable",
            "class",
            "function",
            "enumMember",
            "number",
            "operator",
            "comment"
        ])
    );
    let again = client.respond("initialize", json!({ "capabilities": {} }));
    assert_eq!(again["error"]["code"], -32600);
    let unknown = client.respond("workspace/symbol", json!({ "query": "" }));
    assert_eq!(unknown["error"]["code"], -32601);
    let wrong = client.respond(
        "textDocument/hover",
        json!({ "textDocument": { "uri": URI } }),
    );
    assert_eq!(wrong["error"]["code"], -32602);
    client.tell("$/setTrace", json!({ "value": "off" }));
    assert_eq!(client.ask("shutdown", Value::Null), Value::Null);
    let late = client.respond(
        "textDocument/hover",
        json!({ "textDocument": { "uri": URI } }),
    );
    assert_eq!(late["error"]["code"], -32600);
    client.tell("exit", Value::Null);
    assert_eq!(client.end(), (Some(0), String::new()));
}

#[test]
fn who_leaves_without_a_word_is_remembered() {
    assert_eq!(Client::start().end().0, Some(1));
    let mut client = Client::start();
    client.ask("initialize", json!({ "capabilities": {} }));
    client.tell("exit", Value::Null);
    assert_eq!(client.end(), (Some(1), String::new()));
}

#[test]
fn nonsense_is_passed_over() {
    let mut client = Client::start();
    client.write("hello\r\n\r\n");
    // A response to nothing is not answered.
    client.send(&json!({ "jsonrpc": "2.0", "id": null, "error": { "code": 1, "message": "" } }));
    client.ask("initialize", json!({ "capabilities": {} }));
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": URI, "version": 2 }, "contentChanges": [] }),
    );
    client.tell("textDocument/didOpen", json!([]));
    client.ask("shutdown", Value::Null);
    client.tell("exit", Value::Null);
    let (status, log) = client.end();
    assert_eq!(status, Some(0));
    assert!(log.contains("malformed"), "{log}");
    assert!(log.contains("is not open"), "{log}");
}

#[test]
fn what_is_no_request_is_refused() {
    let mut client = Client::start();
    let refused = |answer: Value| {
        assert_eq!(answer["jsonrpc"], "2.0");
        assert!(answer.get("result").is_none(), "{answer}");
        (answer["id"].clone(), answer["error"]["code"].clone())
    };
    client.write("Content-Length: 9\r\n\r\nnot JSON!");
    assert_eq!(refused(client.read()), (Value::Null, json!(-32700)));
    // A header's name is known whatever its letters.
    client.write("content-length: 13\r\n\r\n{\"id\":1,\"a\":}");
    assert_eq!(refused(client.read()), (Value::Null, json!(-32700)));
    let shutdown = json!({ "jsonrpc": "2.0", "id": 7, "method": "shutdown" });
    for (message, id) in [
        (json!({}), Value::Null),
        (json!([]), Value::Null),
        (json!([shutdown]), Value::Null),
        (json!({ "jsonrpc": "2.0", "id": 8 }), json!(8)),
        (
            json!({ "jsonrpc": "2.0", "id": "a", "method": 5 }),
            json!("a"),
        ),
        (
            json!({ "jsonrpc": "2.0", "id": 1.5, "method": "shutdown" }),
            json!(1.5),
        ),
        // Beyond the protocol's whole numbers.
        (
            json!({ "jsonrpc": "2.0", "id": 99_999_999_999_u64, "method": "shutdown" }),
            json!(99_999_999_999_u64),
        ),
        (
            json!({ "jsonrpc": "2.0", "id": -2_147_483_649_i64, "method": "shutdown" }),
            json!(-2_147_483_649_i64),
        ),
        (
            json!({ "jsonrpc": "2.0", "id": {}, "method": [] }),
            Value::Null,
        ),
    ] {
        client.send(&message);
        assert_eq!(refused(client.read()), (id, json!(-32600)), "{message}");
    }
    client.ask("initialize", json!({ "capabilities": {} }));
    client.leave();
}

#[test]
fn memory_is_not_taken_for_what_is_only_announced() {
    for length in ["99999999999999", "2000000000"] {
        let mut client = Client::start();
        client.write(&format!("Content-Length: {length}\r\n\r\n{{}}"));
        let (status, log) = client.end();
        assert_eq!(status, Some(1));
        assert!(log.contains("is announced"), "{log}");
    }
    // It is as long as may be, and ends early.
    let mut client = Client::start();
    client.write("Content-Length: 1000000000\r\n\r\n{}");
    let (status, log) = client.end();
    assert_eq!(status, Some(1));
    assert!(log.contains("after 2 of 1000000000 bytes"), "{log}");
}
