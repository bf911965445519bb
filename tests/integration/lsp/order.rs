//! The order of things, with messages that all wait already.

use serde_json::{Value, json};

use super::talk::Talk;

/// Asks what the fifth character means.
fn hover(talk: &mut Talk) -> i32 {
    let position = json!({ "line": 0, "character": 4 });
    talk.request("textDocument/hover", json!({ "position": position }))
}

#[test]
fn what_was_cancelled_in_the_meantime_is_not_answered() {
    let mut talk = Talk::with("let a = 1");
    let [first, second] = [hover(&mut talk), hover(&mut talk)];
    talk.tell("$/cancelRequest", json!({ "id": first }));
    assert_eq!(talk.response(first)["error"]["code"], -32800);
    let range = &talk.response(second)["result"]["range"];
    assert_eq!(range["start"]["character"], 4);
}

#[test]
fn of_several_states_the_last_is_judged_and_each_request_is_about_its_own() {
    let mut talk = Talk::logged("let a = 1", |_| {});
    let mut asked = vec![(hover(&mut talk), "let a = 1")];
    for (version, text, about) in [
        (2, "let b = oops", "let b = oops"),
        (3, "let c = 3", "let c = 3"),
        // It comes too late to count.
        (2, "let d = oops", "let c = 3"),
    ] {
        talk.change(version, json!({ "text": text }));
        asked.push((hover(&mut talk), about));
    }
    let params = talk.diagnostics();
    assert_eq!(params["version"], 3);
    for (id, about) in asked {
        let answer = talk.response(id).to_string();
        assert!(answer.contains(about), "{answer}");
    }
    // No other state was judged.
    while talk.carrier.step() {}
    assert!(talk.heard.is_empty() && talk.carrier.said.is_empty());
    let found = params["diagnostics"].as_array().expect("a list");
    let codes: Vec<&Value> = found.iter().map(|found| &found["code"]).collect();
    assert_eq!(codes, ["missing_camera", "no_objects"]);
}

#[test]
fn a_change_that_is_none_changes_nothing() {
    let place = |[line, character]: [i64; 2]| json!({ "line": line, "character": character });
    for wrong in [[-1, 0], [0, -1], [0, 1 << 40], [1 << 32, 0], [99, 0]] {
        for [start, end] in [[[0, 0], wrong], [wrong, [0, 0]]] {
            let range = json!({ "start": place(start), "end": place(end) });
            let mut talk = Talk::logged("let a = 1", |_| {});
            talk.change(2, json!({ "range": range, "text": "oops" }));
            let asked = hover(&mut talk);
            let answer = talk.response(asked).to_string();
            assert!(answer.contains("let a = 1"), "{answer}");
        }
    }
}
