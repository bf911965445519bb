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

/// A request's parameters about a place in the document, besides others.
fn at(line: u32, character: u32, others: Value) -> Value {
    let mut params = others;
    params["position"] = json!({ "line": line, "character": character });
    params["textDocument"] = json!({ "uri": URI });
    params
}

/// The texts that the elements of a list have under a key.
fn each<'v>(list: &'v Value, key: &str) -> Vec<&'v str> {
    let list = list.as_array().expect("a list").iter();
    list.map(|one| one[key].as_str().expect("a text")).collect()
}

#[test]
fn a_scene_is_written_with_every_answer() {
    let (mut client, diagnostics) = Client::open(editor(), SCENE);
    let none = json!({ "uri": URI, "version": 1, "diagnostics": [] });
    assert_eq!(diagnostics, none);

    let definition = json!({ "uri": URI, "range": range(0, 4, 8) });
    assert_eq!(client.at("definition", 1, 32), definition);
    let context = json!({ "context": { "includeDeclaration": false } });
    let references = client.about("references", at(0, 5, context));
    let uses = [range(1, 31, 35), range(2, 21, 25)];
    let places = uses
        .clone()
        .map(|range| json!({ "uri": URI, "range": range }));
    assert_eq!(references, json!(places));
    let highlights = client.at("documentHighlight", 1, 31);
    assert_eq!(highlights[0], json!({ "range": range(0, 4, 8), "kind": 3 }));
    assert_eq!(highlights[1], json!({ "range": uses[0], "kind": 2 }));

    let hover = client.at("hover", 2, 34);
    let markdown = hover["contents"]["value"].as_str().expect("markdown");
    let end = "in linear light (0.215861, 0.215861, 0)";
    assert!(markdown.ends_with(end), "{markdown}");
    assert_eq!(hover["range"], range(2, 33, 38));

    let prepared = json!({ "range": range(0, 4, 8), "placeholder": "ball" });
    assert_eq!(client.at("prepareRename", 0, 8), prepared);
    let renamed = client.about("rename", at(0, 4, json!({ "newName": "middle" })));
    let change = &renamed["documentChanges"][0];
    assert_eq!(change["textDocument"], json!({ "uri": URI, "version": 1 }));
    let edit = json!({ "range": uses[1], "newText": "middle" });
    assert_eq!(change["edits"][2], edit);
    let name = at(0, 4, json!({ "newName": "olive" }));
    let refused = client.respond("textDocument/rename", name);
    let reason = json!({ "code": -32803, "message": "`olive` is a colour of the language" });
    assert_eq!(refused["error"], reason);

    let symbols = client.about("documentSymbol", json!({}));
    assert_eq!(symbols[2]["name"], "Ball");
    assert_eq!(symbols[2]["children"][1]["name"], "color");
    assert_eq!(client.about("foldingRange", json!({})), json!([]));
    let hints = client.about("inlayHint", json!({ "range": range(1, 0, 99) }));
    assert_eq!(each(&hints, "label"), ["= (0, 1, 0)", "fov 90deg"]);

    let options = json!({ "options": { "tabSize": 2, "insertSpaces": true } });
    assert_eq!(client.about("formatting", options), json!([]));
    let colors = client.about("documentColor", json!({}));
    assert_eq!(colors[0]["range"], range(2, 33, 38));
    let teal = json!({ "red": 0.0, "green": 0.5, "blue": 0.5, "alpha": 1.0 });
    let color = json!({ "color": teal, "range": range(2, 33, 38) });
    let presentations = client.about("colorPresentation", color);
    let edit = json!({ "range": range(2, 33, 38), "newText": "teal" });
    assert_eq!(presentations[0]["textEdit"], edit);

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
    client.change(2, range(2, 38, 38), "  /* 🎱 */ radus 2  co");
    let told = client.read();
    assert_eq!(told["params"]["version"], 2);
    let found = told["params"]["diagnostics"].as_array().expect("a list");
    let mut found = found.iter();
    let radus = found.find(|found| found["code"] == "unknown_field");
    let radus = radus.expect("it is wrong");
    // Columns are bytes here.
    assert_eq!(radus["range"], range(2, 51, 56));
    assert_eq!(radus["severity"], 1);
    assert_eq!(radus["source"], "pinhole");
    assert_eq!(
        radus["message"],
        "a sphere has no field `radus`\nhelp: did you mean `radius`? A sphere takes center, radius and color."
    );

    let mut actions = |range: Value, only: Value| {
        let mut context = json!({ "diagnostics": [] });
        if only != Value::Null {
            context["only"] = only;
        }
        client.about("codeAction", json!({ "range": range, "context": context }))
    };
    let offered = actions(range(2, 53, 53), Value::Null);
    assert_eq!(offered[0]["title"], "write `radius`");
    assert_eq!(offered[0]["isPreferred"], true);
    assert_eq!(offered[0]["diagnostics"][0]["code"], "unknown_field");
    let edit = &offered[0]["edit"]["documentChanges"][0];
    assert_eq!(edit["textDocument"]["version"], 2);
    let expected = json!([{ "range": range(2, 51, 56), "newText": "radius" }]);
    assert_eq!(edit["edits"], expected);
    let others = actions(range(2, 53, 53), json!(["refactor"]));
    assert_eq!(others, json!([]));
    let all = actions(range(0, 0, 0), json!(["source.fixAll"]));
    assert_eq!(all[0]["kind"], "source.fixAll");
    let edit = &all[0]["edit"]["documentChanges"][0]["edits"];
    let expected = json!([{ "range": range(2, 54, 54), "newText": "i" }]);
    assert_eq!(*edit, expected);

    let completions = client.at("completion", 2, 50 + 11);
    assert_eq!(each(&completions, "label"), ["radius"]);
    assert_eq!(completions[0]["textEdit"]["newText"], "radius ${1:1}");
    assert_eq!(completions[0]["insertTextFormat"], 2);

    let close = json!({ "textDocument": { "uri": URI } });
    client.tell("textDocument/didClose", close);
    let none = json!({ "uri": URI, "diagnostics": [] });
    assert_eq!(client.read()["params"], none);
    let gone = client.respond("textDocument/hover", at(0, 0, json!({})));
    assert_eq!(gone["error"]["code"], -32602);
    client.leave();
}

/// Letter by letter, with what an editor asks after each.
#[test]
fn a_scene_is_typed_letter_by_letter() {
    let (mut client, _) = Client::open(editor(), "");
    let (mut line, mut character) = (0, 0);
    for (index, letter) in SCENE.chars().enumerate() {
        let place = range(line, character, character);
        client.change(index + 2, place, &letter.to_string());
        match letter {
            '\n' => (line, character) = (line + 1, 0),
            _ => character += 1,
        }
        client.at("completion", line, character);
        client.about("semanticTokens/full", json!({}));
    }
    assert_eq!(client.diagnostics(SCENE.chars().count() + 1), json!([]));
    client.leave();
}

#[test]
fn a_client_of_few_words_gets_plain_answers() {
    let (mut client, diagnostics) = Client::open(
        json!({}),
        "/* 🎱 */ sphere { radius 1  radius 2  center (0, 0, 0) }",
    );
    let found = diagnostics["diagnostics"].as_array().expect("a list");
    let mut found = found.iter();
    let twice = found.find(|found| found["code"] == "duplicate_field");
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
    let name = at(0, 19, json!({ "newName": "x" }));
    let refused = client.respond("textDocument/rename", name);
    let reason = "`radius` is a word of the language";
    assert_eq!(refused["error"]["message"], reason);
    client.leave();
}

#[test]
fn a_conversation_begins_and_ends_as_it_should() {
    let mut client = Client::start();
    let refused = |client: &mut Client, method: &str, params: Value| {
        client.respond(method, params)["error"]["code"].clone()
    };
    let hover = "textDocument/hover";
    assert_eq!(refused(&mut client, hover, json!({})), -32002);
    client.tell("textDocument/didOpen", json!({ "nonsense": true }));
    let hello = client.ask("initialize", json!({ "capabilities": {} }));
    assert_eq!(hello["serverInfo"]["name"], "pinhole");
    let capabilities = &hello["capabilities"];
    assert_eq!(capabilities["positionEncoding"], "utf-16");
    assert_eq!(capabilities["experimental"], json!({ "pinhole": 1 }));
    let legend = &capabilities["semanticTokensProvider"]["legend"];
    let kinds =
        "keyword property variable class function enumMember number operator comment".split(' ');
    assert_eq!(legend["tokenTypes"], json!(kinds.collect::<Vec<_>>()));
    let document = json!({ "textDocument": { "uri": URI } });
    for (method, params, code) in [
        ("initialize", json!({ "capabilities": {} }), -32600),
        ("workspace/symbol", json!({ "query": "" }), -32601),
        (hover, document.clone(), -32602),
    ] {
        assert_eq!(refused(&mut client, method, params), code);
    }
    client.tell("$/setTrace", json!({ "value": "off" }));
    assert_eq!(client.ask("shutdown", Value::Null), Value::Null);
    assert_eq!(refused(&mut client, hover, document), -32600);
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
    ] {
        client.send(&message);
        assert_eq!(refused(client.read()), (id, json!(-32600)), "{message}");
    }
    for [id, method] in [
        [json!("a"), json!(5)],
        [json!(1.5), json!("shutdown")],
        // Beyond the protocol's whole numbers.
        [json!(99_999_999_999_u64), json!("shutdown")],
        [json!(-2_147_483_649_i64), json!("shutdown")],
        [json!({}), json!([])],
    ] {
        client.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method }));
        let id = if id.is_object() { Value::Null } else { id };
        assert_eq!(refused(client.read()), (id, json!(-32600)), "{method}");
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
