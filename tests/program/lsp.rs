//! `mbint lsp` by plain messages: the end of a session, half-typed texts, and formatting, compared with another reader
//! of YAML. A client of the protocol tests the answers in `python/tests/test_language_server.py`.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

/// A session with the server.
struct Session {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    requests: u64,
}

impl Session {
    fn new() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mbint"));
        command.args(["lsp", "--stdio"]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = command.spawn().unwrap();
        let (input, output) = (process.stdin.take().unwrap(), BufReader::new(process.stdout.take().unwrap()));
        let mut session = Self { process, input, output, requests: 0 };
        let capabilities =
            json!({ "textDocument": { "completion": { "completionItem": { "snippetSupport": true } } } });
        let params = json!({ "processId": null, "rootUri": null, "capabilities": capabilities });
        assert!(session.ask("initialize", params)["result"]["capabilities"]["hoverProvider"].as_bool().unwrap());
        session.tell("initialized", json!({}));
        session
    }

    fn send(&mut self, mut message: Value) {
        message["jsonrpc"] = "2.0".into();
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.input.flush().unwrap();
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.send(json!({ "method": method, "params": params }));
    }

    /// Returns the answer to a request; skips messages that the server sends before by itself.
    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(json!({ "id": id, "method": method, "params": params }));
        loop {
            let message = self.receive();
            if message["id"] == id {
                return message;
            }
        }
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "the server has ended");
            match line.trim_end().split_once(": ") {
                Some(("Content-Length", value)) => length = value.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut text = vec![0; length];
        self.output.read_exact(&mut text).unwrap();
        serde_json::from_slice(&text).unwrap()
    }

    fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "yaml", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    fn change(&mut self, uri: &str, version: usize, text: &str) {
        let document = json!({ "uri": uri, "version": version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [{ "text": text }] }));
    }

    /// The exit code, after the editor has closed its end or has said so.
    fn code(self) -> i32 {
        let Self { mut process, input, .. } = self;
        drop(input);
        process.wait().unwrap().code().unwrap()
    }
}

fn models() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let files = [folder.clone(), folder.join("parts")].into_iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|own| own == "yaml"));
    files.sort();
    assert!(files.len() > 40);
    files
}

fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

#[test]
fn session_ends_on_request_of_the_editor() {
    let mut session = Session::new();
    assert_eq!(session.ask("nothing/known", json!({}))["error"]["code"], -32601);
    assert_eq!(session.ask("textDocument/hover", json!({ "position": 1 }))["error"]["code"], -32602);
    assert_eq!(session.ask("shutdown", Value::Null)["result"], Value::Null);
    session.tell("exit", Value::Null);
    assert_eq!(session.code(), 0);
    assert_eq!(Session::new().code(), 0, "an editor that is gone");
}

/// Texts that are cut, joined and changed at random are answered, and nothing in the server panics.
#[test]
fn requests_on_half_typed_texts_are_answered() {
    let mut session = Session::new();
    let mut state = 7_u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    let pieces = [
        "{", "}", "[", "]", ": ", "\n", "\n  ", "- ", "\"", "#", ",", "é", "𝛼", ".", "1e999", "{i}", "\t", "|", "&a",
        "\0",
    ];
    let files = models();
    let mut answers = 0;
    for round in 0..80 {
        let file = &files[random(files.len())];
        let text = fs::read_to_string(file).unwrap();
        let letters: Vec<char> = text.chars().collect();
        let index = random(letters.len());
        let piece = pieces[random(pieces.len())];
        let gone = random(30);
        let (before, behind) = (&letters[..index], &letters[(index + gone).min(letters.len())..]);
        let before: String = before.iter().collect();
        let behind: String = behind.iter().collect();
        let typed = match round % 3 {
            0 => before.clone(),
            1 => format!("{before}{piece}{behind}"),
            _ => format!("{before}{}", pieces[random(pieces.len())]),
        };
        let uri = format!("{}_{round}.yaml", uri(file).trim_end_matches(".yaml"));
        session.open(&uri, &text);
        session.change(&uri, 2, &typed);
        let line = before.matches('\n').count();
        let character = before.rsplit('\n').next().unwrap().encode_utf16().count();
        let document = json!({ "uri": uri });
        for (line, character) in [(line, character), (random(line + 2), random(60))] {
            let position = json!({ "line": line, "character": character });
            let range = json!({ "start": position, "end": position });
            for (method, more) in [
                ("textDocument/completion", json!({})),
                ("textDocument/hover", json!({})),
                ("textDocument/definition", json!({})),
                ("textDocument/references", json!({ "context": { "includeDeclaration": true } })),
                ("textDocument/documentHighlight", json!({})),
                ("textDocument/prepareRename", json!({})),
                ("textDocument/rename", json!({ "newName": "renamed" })),
                ("textDocument/documentSymbol", json!({})),
                ("textDocument/foldingRange", json!({})),
                ("textDocument/formatting", json!({ "options": { "tabSize": 2, "insertSpaces": true } })),
                ("textDocument/codeAction", json!({ "range": range, "context": { "diagnostics": [] } })),
            ] {
                let mut params = json!({ "textDocument": document, "position": position });
                more.as_object().unwrap().iter().for_each(|(key, value)| params[key] = value.clone());
                let answer = session.ask(method, params);
                // A name may be refused (-32803).
                let code = answer["error"]["code"].as_i64();
                assert!(
                    code.is_none() || code == Some(-32803),
                    "{method} at {line}:{character} of {typed:?}: {answer}"
                );
                answers += 1;
            }
        }
        session.tell("textDocument/didClose", json!({ "textDocument": document }));
    }
    assert_eq!(answers, 80 * 2 * 11);
    session.ask("shutdown", Value::Null);
    session.tell("exit", Value::Null);
    assert_eq!(session.code(), 0);
}

/// Every model here, indented by four columns and without its spaces, is formatted to a text of the same contents by
/// another reader of YAML, with the same comments, and a second time to itself.
#[test]
fn formatted_models_mean_the_same() {
    let mut session = Session::new();
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let comments = |text: &str| -> Vec<String> {
        let found = text.lines().filter_map(|line| line.find('#').map(|at| line[at..].trim_end().to_owned()));
        found.collect()
    };
    let mut changed = 0;
    for file in models() {
        let text = fs::read_to_string(&file).unwrap();
        let wide = |line: &str| {
            let indent = line.len() - line.trim_start().len();
            let line = line.replace(" }", "}").replace("{ ", "{");
            // Spaces at the ends of lines belong to texts of several lines, which have no keys.
            let end = if line.contains(':') { "  " } else { "" };
            format!("{}{line}{end}", " ".repeat(indent))
        };
        let untidy = text.lines().map(wide).collect::<Vec<_>>().join("\n");
        let uri = uri(&file);
        session.open(&uri, &untidy);
        let ask = |session: &mut Session| {
            session.ask("textDocument/formatting", json!({ "textDocument": { "uri": uri }, "options": options }))
        };
        let answer = ask(&mut session);
        let edits = answer["result"].as_array().unwrap_or_else(|| panic!("{}: {answer}", file.display()));
        let formatted = edits[0]["newText"].as_str().unwrap();
        let contents = |text: &str| serde_yaml::from_str::<serde_yaml::Value>(text).unwrap();
        assert_eq!(contents(formatted), contents(&text), "{}", file.display());
        assert_eq!(comments(formatted), comments(&text.replace(" }", "}").replace("{ ", "{")), "{}", file.display());
        assert!(formatted.lines().all(|line| line.trim_end() == line) && !formatted.contains("\n\n\n"));
        session.change(&uri, 2, formatted);
        assert_eq!(ask(&mut session)["result"], json!([]), "{}", file.display());
        session.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
        changed += 1;
    }
    assert!(changed > 40);
    session.ask("shutdown", Value::Null);
    session.tell("exit", Value::Null);
    assert_eq!(session.code(), 0);
}

/// A mistake of the text, and one of the mechanism as a whole, which comes when the keyboard rests.
#[test]
fn diagnostics_have_codes_with_links() {
    let folder = tempfile::tempdir().unwrap();
    let uri = uri(&folder.path().join("arm.yaml"));
    let good = "bodies: { a: { mass: 0, coordinates: [x] } }\noutputs: { x: a.x }\nsimulation: { duration: 1 }\n";
    let mut session = Session::new();
    session.open(&uri, &good.replace("outputs: { x: a.x", "outputs: { x: b.x"));
    for (code, changed) in [("E0401", good), ("E0913", "")] {
        let found = loop {
            let message = session.receive();
            let found = message["params"]["diagnostics"].as_array();
            if let Some(found) = found.filter(|found| !found.is_empty()) {
                break found[0].clone();
            }
        };
        assert_eq!(found["code"], code, "{found}");
        let href = found["codeDescription"]["href"].as_str().unwrap();
        assert!(href.ends_with(&format!("/docs/errors/{code}.md")), "{href}");
        session.change(&uri, 2, changed);
    }
}
