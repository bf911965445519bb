//! Whole conversations.

use serde_json::{Value, json};

use super::client::{Carrier, Client, Pipes};

const URI: &str = Pipes::URI;

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

fn place(line: u32, character: u32) -> Value {
    json!({ "line": line, "character": character })
}

fn range(line: u32, start: u32, end: u32) -> Value {
    json!({ "start": place(line, start), "end": place(line, end) })
}

/// A request's parameters about a place, besides others.
fn at(line: u32, character: u32, others: Value) -> Value {
    let mut params = others;
    params["position"] = place(line, character);
    params
}

/// The texts that the elements of a list have under a key.
fn each<'v>(list: &'v Value, key: &str) -> Vec<&'v str> {
    let list = list.as_array().expect("a list").iter();
    list.map(|one| one[key].as_str().expect("a text")).collect()
}

/// The request, and what some of the answer is, by its path.
#[rustfmt::skip]
#[test]
fn a_scene_is_written_with_every_answer() {
    let mut client = Client::start();
    client.open(editor(), SCENE);
    let diagnostics = client.diagnostics();
    assert_eq!(diagnostics, json!({ "uri": URI, "version": 1, "diagnostics": [] }));

    let uses = [range(1, 31, 35), range(2, 21, 25)];
    let [first, second] = uses.clone().map(|range| json!({ "uri": URI, "range": range }));
    let olive = range(2, 33, 38);
    let teal = json!({ "red": 0.0, "green": 0.5, "blue": 0.5, "alpha": 1.0 });
    // let ball = ( 0: a keyword, a variable that is defined, an operator, a number.
    let tokens = json!([0, 0, 3, 0, 0, 0, 4, 4, 2, 1, 0, 5, 1, 7, 0, 0, 3, 1, 6, 0]);
    for (method, params, path, expected) in [
        ("definition", at(1, 32, json!({})), "", json!({ "uri": URI, "range": range(0, 4, 8) })),
        ("references", at(0, 5, json!({ "context": { "includeDeclaration": false } })), "", json!([first, second])),
        ("documentHighlight", at(1, 31, json!({})), "/0", json!({ "range": range(0, 4, 8), "kind": 3 })),
        ("documentHighlight", at(1, 31, json!({})), "/1", json!({ "range": uses[0], "kind": 2 })),
        ("hover", at(2, 34, json!({})), "", json!({
            "contents": { "kind": "markdown", "value": "`olive` is a colour: `#808000`, `rgb(128, 128, 0)`; in linear light (0.215861, 0.215861, 0)" },
            "range": olive,
        })),
        ("prepareRename", at(0, 8, json!({})), "", json!({ "range": range(0, 4, 8), "placeholder": "ball" })),
        ("rename", at(0, 4, json!({ "newName": "middle" })), "/documentChanges/0/textDocument", json!({ "uri": URI, "version": 1 })),
        ("rename", at(0, 4, json!({ "newName": "middle" })), "/documentChanges/0/edits/2", json!({ "range": uses[1], "newText": "middle" })),
        ("documentSymbol", json!({}), "/2/name", json!("Ball")),
        ("documentSymbol", json!({}), "/2/children/1/name", json!("color")),
        ("foldingRange", json!({}), "", json!([])),
        ("inlayHint", json!({ "range": range(1, 0, 99) }), "/0/label", json!("= (0, 1, 0)")),
        ("inlayHint", json!({ "range": range(1, 0, 99) }), "/1/label", json!("fov 90deg")),
        ("formatting", json!({ "options": { "tabSize": 2, "insertSpaces": true } }), "", json!([])),
        ("documentColor", json!({}), "/0/range", olive.clone()),
        ("colorPresentation", json!({ "color": teal, "range": olive }), "/0/textEdit", json!({ "range": olive, "newText": "teal" })),
    ] {
        let answer = client.ask(&format!("textDocument/{method}"), params);
        assert_eq!(answer.pointer(path), Some(&expected), "{method}");
    }
    let found = client.ask("textDocument/semanticTokens/full", json!({}));
    assert_eq!(found["data"].as_array().expect("a list")[..20], tokens.as_array().expect("a list")[..]);
    let refused = client.respond("textDocument/rename", at(0, 4, json!({ "newName": "olive" })));
    let reason = json!({ "code": -32803, "message": "`olive` is a colour of the language" });
    assert_eq!(refused["error"], reason);
    client.leave();
}

/// What is found with a code among diagnostics.
fn found(diagnostics: &Value, code: &str) -> Value {
    let mut all = diagnostics["diagnostics"]
        .as_array()
        .expect("a list")
        .iter();
    let found = all.find(|found| found["code"] == code);
    found.expect("it is wrong").clone()
}

#[test]
fn texts_change_while_one_types() {
    let mut client = Client::start();
    client.open(editor(), SCENE);
    client.diagnostics();
    // A mistyped field is put in behind the colour, where the text has a character of four bytes before it.
    client.change(
        2,
        json!({ "range": range(2, 38, 38), "text": "  /* 🎱 */ radus 2  co" }),
    );
    let told = client.diagnostics();
    assert_eq!(told["version"], 2);
    let mut radus = found(&told, "unknown_field");
    let message = "a sphere has no field `radus`\nhelp: did you mean `radius`? A sphere takes center, radius and color.";
    // Columns are bytes here.
    for (key, expected) in [
        ("range", range(2, 51, 56)),
        ("severity", json!(1)),
        ("source", json!("pinhole")),
        ("message", json!(message)),
    ] {
        assert_eq!(radus[key].take(), expected);
    }

    let mut actions = |at: u32, context: Value| {
        let range = range(2, at, at);
        let params = json!({ "range": range, "context": context });
        client.ask("textDocument/codeAction", params)
    };
    let offered = actions(53, json!({ "diagnostics": [] }));
    let edits = |action: &Value| {
        action
            .pointer("/edit/documentChanges/0")
            .cloned()
            .expect("edits")
    };
    assert_eq!(offered[0]["title"], "write `radius`");
    assert_eq!(offered[0]["isPreferred"], true);
    assert_eq!(offered[0]["diagnostics"][0]["code"], "unknown_field");
    assert_eq!(edits(&offered[0])["textDocument"]["version"], 2);
    let expected = json!([{ "range": range(2, 51, 56), "newText": "radius" }]);
    assert_eq!(edits(&offered[0])["edits"], expected);
    let others = actions(53, json!({ "diagnostics": [], "only": ["refactor"] }));
    assert_eq!(others, json!([]));
    let all = actions(0, json!({ "diagnostics": [], "only": ["source.fixAll"] }));
    assert_eq!(all[0]["kind"], "source.fixAll");
    let expected = json!([{ "range": range(2, 54, 54), "newText": "i" }]);
    assert_eq!(edits(&all[0])["edits"], expected);

    let completions = client.ask("textDocument/completion", at(2, 50 + 11, json!({})));
    assert_eq!(each(&completions, "label"), ["radius"]);
    assert_eq!(completions[0]["textEdit"]["newText"], "radius ${1:1}");
    assert_eq!(completions[0]["insertTextFormat"], 2);

    client.close();
    let none = json!({ "uri": URI, "diagnostics": [] });
    assert_eq!(client.diagnostics(), none);
    let gone = client.respond("textDocument/hover", at(0, 0, json!({})));
    assert_eq!(gone["error"]["code"], -32602);
    client.leave();
}

/// Letter by letter, with what an editor asks after each.
#[test]
fn a_scene_is_typed_letter_by_letter() {
    let mut client = Client::start();
    client.open(editor(), "");
    let (mut line, mut character) = (0, 0);
    for (index, letter) in SCENE.chars().enumerate() {
        let place = range(line, character, character);
        client.change(index + 2, json!({ "range": place, "text": letter }));
        match letter {
            '\n' => (line, character) = (line + 1, 0),
            _ => character += 1,
        }
        client.ask("textDocument/completion", at(line, character, json!({})));
        client.ask("textDocument/semanticTokens/full", json!({}));
    }
    let mut told = client.diagnostics();
    while told["version"] != SCENE.chars().count() + 1 {
        told = client.diagnostics();
    }
    assert_eq!(told["diagnostics"], json!([]));
    client.leave();
}

#[test]
fn a_client_of_few_words_gets_plain_answers() {
    let mut client = Client::start();
    let text = "/* 🎱 */ sphere { radius 1  radius 2  center (0, 0, 0) }";
    client.open(json!({}), text);
    let diagnostics = client.diagnostics();
    let twice = found(&diagnostics, "duplicate_field");
    // Columns are units of UTF-16.
    assert_eq!(twice["range"], range(0, 28, 34));
    let first =
        json!([{ "location": { "uri": URI, "range": range(0, 18, 24) }, "message": "first here" }]);
    assert_eq!(twice["relatedInformation"], first);
    let completions = client.ask("textDocument/completion", at(0, 37, json!({})));
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
    let refused = |client: &mut Client<Pipes>, method: &str, params: Value| {
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
    for (method, params, code) in [
        ("initialize", json!({ "capabilities": {} }), -32600),
        ("workspace/symbol", json!({ "query": "" }), -32601),
        (hover, json!({}), -32602),
    ] {
        assert_eq!(refused(&mut client, method, params), code);
    }
    client.tell("$/setTrace", json!({ "value": "off" }));
    assert_eq!(client.ask("shutdown", Value::Null), Value::Null);
    assert_eq!(refused(&mut client, hover, json!({})), -32600);
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
    client.carrier.put("hello\r\n\r\n");
    // A response to nothing is not answered.
    client.send(&json!({ "jsonrpc": "2.0", "id": null, "error": { "code": 1, "message": "" } }));
    client.ask("initialize", json!({ "capabilities": {} }));
    client.change(2, json!({ "text": "" }));
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
    client.carrier.put("Content-Length: 9\r\n\r\nnot JSON!");
    assert_eq!(refused(client.read()), (Value::Null, json!(-32700)));
    // A header's name is known whatever its letters.
    client
        .carrier
        .put("content-length: 13\r\n\r\n{\"id\":1,\"a\":}");
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
    for (length, expected) in [
        ("99999999999999", "is announced"),
        ("2000000000", "is announced"),
        // It is as long as may be, and ends early.
        ("1000000000", "after 2 of 1000000000 bytes"),
    ] {
        let mut client = Client::start();
        client
            .carrier
            .put(&format!("Content-Length: {length}\r\n\r\n{{}}"));
        let (status, log) = client.end();
        assert_eq!(status, Some(1));
        assert!(log.contains(expected), "{log}");
    }
}
