//! Texts in the studio: errors, saving, and files that are not the model's.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{CRANK, Session, session};
use crate::place::Place;

fn open(session: &Session, path: &Path) -> Value {
    session.post("open", &json!({ "path": path })).json()
}

fn change(session: &Session, path: &Path, text: &str) {
    assert_eq!(session.post("text", &json!({ "path": path, "text": text })).status, 200);
}

/// Errors have their locations and fixes, and the page continues.
#[test]
fn errors_are_reported_and_corrected_texts_bounded() {
    let (place, mut session) = session(CRANK);
    let path = place.path().canonicalize().unwrap().join("m.yaml");
    assert_eq!(open(&session, &path), json!({ "text": CRANK, "unsaved": false }));
    let number = session.model(0)["number"].as_u64().unwrap();
    change(&session, &path, &CRANK.replace("[ground, crank.A]", "[ground, crnk.A]"));
    session.until("model", |model| model["state"] == "wrong");
    let uri = format!("file://{}", path.display());
    let diagnostics = session.until("diagnostics", |all| all[&uri].as_array().is_some_and(|own| !own.is_empty()));
    let problem = &diagnostics[&uri][0];
    assert_eq!(problem["range"]["start"], json!({ "line": 7, "character": 26 }));
    assert!(problem["message"].as_str().unwrap().contains("unknown body `crnk`"), "{problem}");
    let params = json!({ "textDocument": { "uri": uri }, "range": problem["range"], "context": { "diagnostics": [] } });
    let fixes = session.post("language", &json!({ "method": "textDocument/codeAction", "params": params })).json();
    assert_eq!(fixes[0]["title"], "Replace `crnk` by `crank`");
    // Where the mechanism as a whole is wrong.
    change(&session, &path, &CRANK.replace("C: [0.5, 0]", "C: [0.05, 0]"));
    session.until("bounds", |bounds| bounds["error"].as_str().is_some_and(|error| error.contains("cannot be closed")));
    session.until("mechanism", |mechanism| mechanism["absent"].as_str().is_some());
    let texts =
        ["", "a", "model: [", "\u{feff}\t\0{}", "bodies: {a: {}}\noutputs: {}\n", "? <script>alert(1)</script>"];
    for text in texts {
        change(&session, &path, text);
        session.until("model", |model| model["state"] == "wrong");
    }
    change(&session, &path, CRANK);
    let bounds =
        session.until("bounds", |bounds| bounds["stage"] == "asked" && bounds["number"].as_u64() > Some(number));
    assert!(bounds["html"].as_str().is_some());
    assert_eq!(fs::read_to_string(&path).unwrap(), CRANK, "nothing is saved that nobody asked to");
}

#[test]
fn files_are_saved_on_request_unless_changed_elsewhere() {
    let (place, session) = session(CRANK);
    let path = place.path().canonicalize().unwrap().join("m.yaml");
    open(&session, &path);
    let changed = CRANK.replace("duration: 0.2", "duration: 0.1");
    let unsaved = session.post("text", &json!({ "path": path, "text": changed })).json();
    assert_eq!(unsaved["unsaved"], true);
    assert_eq!(session.post("save", &json!({ "path": path })).status, 200);
    assert_eq!(fs::read_to_string(&path).unwrap(), changed);
    fs::write(&path, format!("# by another program\n{CRANK}")).unwrap();
    change(&session, &path, CRANK);
    let refused = session.post("save", &json!({ "path": path }));
    assert_eq!(refused.status, 409);
    assert!(refused.body.contains("has changed on the disk since it was read"), "{}", refused.body);
    assert!(fs::read_to_string(&path).unwrap().starts_with("# by another program"));
    let loaded = session.post("load", &json!({ "path": path })).json();
    assert!(loaded["text"].as_str().unwrap().starts_with("# by another program"));
    assert_eq!(session.post("save", &json!({ "path": path })).status, 200);
}

/// A change by another program is followed, where the page has not changed the text.
#[test]
fn a_change_on_the_disk_is_followed() {
    let (place, mut session) = session(CRANK);
    let path = place.path().canonicalize().unwrap().join("m.yaml");
    let key = path.to_str().unwrap();
    open(&session, &path);
    session.until("bounds", |bounds| bounds["stage"] == "asked");
    let other = CRANK.replace("model: crank", "model: other");
    fs::write(&path, &other).unwrap();
    let disk = session.until("disk", |disk| disk[key]["text"].as_str().is_some());
    assert_eq!(disk[key]["text"], other);
    session.until("model", |model| model["name"] == "other");
    change(&session, &path, &other.replace("model: other", "model: mine"));
    fs::write(&path, format!("# by another program\n{CRANK}")).unwrap();
    session.until("disk", |disk| disk[key]["text"].is_null());
    session.until("model", |model| model["name"] == "mine");
    assert!(open(&session, &path)["text"].as_str().unwrap().contains("model: mine"));
}

/// Files of the model alone are read and written, and none that it may not name.
#[test]
fn only_files_of_the_model_are_accessible() {
    let place = Place::new();
    let inside = place.path().canonicalize().unwrap().join("inside");
    fs::create_dir(&inside).unwrap();
    let secret = place.path().canonicalize().unwrap().join("secret.yaml");
    fs::write(&secret, "assemblies: { hidden: { bodies: {} } }\n").unwrap();
    let part = "assemblies: { empty: { bodies: { b: { mass: 1, coordinates: [x] } } } }\n";
    fs::write(inside.join("part.yaml"), part).unwrap();
    fs::write(inside.join("beside.yaml"), "mine").unwrap();
    let model = inside.join("m.yaml");
    fs::write(&model, format!("include: part.yaml\n{CRANK}")).unwrap();
    let mut session = Session::new(&place, "inside/m.yaml");
    let files = session.model(0)["files"].clone();
    let names: Vec<&str> = files.as_array().unwrap().iter().map(|file| file["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["m.yaml", "part.yaml"]);
    assert_eq!(open(&session, &inside.join("part.yaml"))["text"], part);
    for path in [&secret, &inside.join("beside.yaml"), &inside.join("../secret.yaml"), Path::new("/etc/passwd")] {
        for request in ["open", "load", "save"] {
            let refused = session.post(request, &json!({ "path": path }));
            assert!([403].contains(&refused.status) && !refused.body.contains("root:"), "{request} {}", path.display());
        }
        assert_eq!(session.post("text", &json!({ "path": path, "text": "" })).status, 403);
        let document = json!({ "textDocument": { "uri": format!("file://{}", path.display()) } });
        let asked = json!({ "method": "textDocument/documentSymbol", "params": document });
        assert_eq!(session.post("language", &asked).status, 403, "{}", path.display());
    }
    // Messages that change something are not passed on.
    let document = json!({ "uri": files[0]["uri"], "languageId": "yaml", "version": 9, "text": "" });
    for method in ["textDocument/didOpen", "textDocument/rename", "shutdown", "exit"] {
        let asked = json!({ "method": method, "params": { "textDocument": document } });
        assert_eq!(session.post("language", &asked).status, 403, "{method}");
    }
    open(&session, &model);
    change(&session, &model, &format!("include: ../secret.yaml\n{CRANK}"));
    let uri = files[0]["uri"].as_str().unwrap().to_owned();
    let all = session.until("diagnostics", |all| all[&uri].to_string().contains("is not within"));
    assert!(!all.to_string().contains("hidden"), "{all}");
}

/// Texts that hold tags are texts, in the page's data and in the report.
#[test]
fn hostile_texts_are_texts() {
    let hostile = "</title></script><script>alert(1)</script><img src=x onerror=alert(2)>";
    let text = CRANK.replace("model: crank", &format!("model: crank\ndescription: \"{hostile}\""));
    let (place, mut session) = session(&text);
    session.until("bounds", |bounds| bounds["stage"] == "asked");
    let report = session.get("report").body;
    assert!(!report.contains("<script>alert") && !report.contains("<img src=x"));
    assert!(report.contains("&lt;script&gt;alert(1)"), "the description is there");
    let path = place.path().canonicalize().unwrap().join("m.yaml");
    open(&session, &path);
    change(&session, &path, &text.replace("model: crank\n", &format!("model: \"{hostile}\"\n")));
    let uri = format!("file://{}", path.display());
    let all = session.until("diagnostics", |all| all[&uri].to_string().contains("cannot be the name of a model"));
    assert!(all.to_string().contains("<script>"), "as it is written: the page makes a text of it");
    let events = session.get("events?after=0");
    assert!(events.head.contains("Content-Type: application/json") && events.head.contains("nosniff"));
}
