//! `mbint studio` by plain HTTP: admission of requests, and answers. A browser tests the page (`tests/browser`).

mod answers;
mod texts;

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, ChildStdout, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::place::Place;

/// Longest time of any answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// A crank of length l and a rod of length 0.5 m with a slider on the x axis.
const CRANK: &str = "\
model: crank
parameters: { l: { value: 0.2, unit: m, tolerance: 1% }, torque: { value: 0.3, unit: N*m, tolerance: 5% } }
bodies:
  crank: { mass: 1, inertia: 0.01, points: { A: [0, 0], B: [l, 0] } }
  rod: { mass: 1, inertia: 0.02, points: { B: [0, 0], C: [0.5, 0] } }
  slider: { mass: 1, coordinates: [x] }
joints:
  A: { revolute: [ground, crank.A] }
  B: { revolute: [crank.B, rod.B] }
  C: { revolute: [rod.C, slider] }
effects: { drive: { torque: { on: crank, value: torque } } }
initial: { crank.angle: 60 deg, crank.angular_velocity: 0 }
outputs: { x: slider.x, angle: crank.angle }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.01 }
bounds: { chebyshev: { order: 2 } }
";

/// A session of the studio.
struct Session {
    process: Child,
    output: BufReader<ChildStdout>,
    address: SocketAddr,
    /// `/TOKEN/`.
    base: String,
    /// Number of the latest note, and the latest of each topic.
    latest: u64,
    topics: Value,
}

/// An answer: its status, its head and its body.
struct Answer {
    status: u16,
    head: String,
    body: String,
}

impl Answer {
    fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|_| panic!("{} {}", self.status, self.body))
    }
}

impl Session {
    /// Starts the studio with a model's file in a folder.
    fn new(place: &Place, model: &str) -> Self {
        let mut command = place.command(&format!("studio {model} --no-open"));
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut output = BufReader::new(process.stdout.take().unwrap());
        let mut line = String::new();
        output.read_line(&mut line).unwrap();
        let rest = line.trim_end().strip_prefix("http://").unwrap_or_else(|| panic!("{line}"));
        let (address, path) = rest.split_once('/').unwrap();
        let (address, base) = (address.parse().unwrap(), format!("/{path}"));
        Self { process, output, address, base, latest: 0, topics: json!({}) }
    }

    /// Sends bytes, and reads the answer to its end.
    fn send(&self, request: &str) -> Answer {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut text = Vec::new();
        stream.read_to_end(&mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let (head, body) = text.split_once("\r\n\r\n").unwrap_or_else(|| panic!("{text}"));
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        Answer { status, head: head.to_owned(), body: body.to_owned() }
    }

    fn request(&self, method: &str, path: &str, headers: &str, body: &str) -> Answer {
        let length = body.len();
        self.send(&format!("{method} {path} HTTP/1.1\r\n{headers}Content-Length: {length}\r\n\r\n{body}"))
    }

    fn get(&self, path: &str) -> Answer {
        self.request("GET", &format!("{}{path}", self.base), &format!("Host: {}\r\n", self.address), "")
    }

    fn post(&self, path: &str, body: &Value) -> Answer {
        let (path, headers) = (format!("{}{path}", self.base), format!("Host: {}\r\n", self.address));
        self.request("POST", &path, &headers, &body.to_string())
    }

    /// Waits until a topic is as it is wanted.
    fn until(&mut self, topic: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            if let Some(note) = self.topics.get(topic).filter(|note| is_wanted(note)) {
                return note.clone();
            }
            assert!(begun.elapsed() < PATIENCE, "{topic}: {:.300}", self.topics[topic].to_string());
            let mut answer = self.get(&format!("events?after={}", self.latest)).json();
            self.latest = answer["latest"].as_u64().unwrap();
            for (topic, note) in answer["topics"].as_object_mut().unwrap() {
                self.topics[topic] = note.take();
            }
        }
    }

    /// The model, behind a change of this number.
    fn model(&mut self, after: u64) -> Value {
        self.until("model", |model| model["state"] == "valid" && model["number"].as_u64().unwrap() > after)
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn session(text: &str) -> (Place, Session) {
    let place = Place::new();
    fs::write(place.path().join("m.yaml"), text).unwrap();
    let session = Session::new(&place, "m.yaml");
    (place, session)
}

#[test]
fn only_the_studios_own_page_with_token_is_answered() {
    let (_place, session) = session(CRANK);
    let (base, host) = (session.base.clone(), format!("Host: {}\r\n", session.address));
    assert!(base.len() > 32, "{base}");
    let status = |method: &str, path: &str, headers: &str| session.request(method, path, headers, "{}").status;
    let own = session.get("");
    assert_eq!(own.status, 200);
    for wanted in [
        "Content-Security-Policy: default-src 'none'; script-src 'self';",
        "frame-ancestors 'none'",
        "X-Content-Type-Options: nosniff",
        "Referrer-Policy: no-referrer",
        "Cache-Control: no-store",
    ] {
        assert!(own.head.contains(wanted), "{wanted}: {}", own.head);
    }
    assert!(!own.body.contains("https:"), "nothing from elsewhere");
    // The token: none, a part of it, another.
    let other = format!("/{}/", "0".repeat(32));
    for path in ["/", "/index.html", "//", &base[..base.len() - 2], &other] {
        for method in ["GET", "POST"] {
            assert_eq!(status(method, path, &host), 403, "{method} {path}");
        }
    }
    // A name that points here, and the other names of this machine.
    let port = session.address.port();
    for (name, wanted) in [("evil.example", 403), ("127.0.0.1", 200), ("localhost", 200), ("[::1]", 200)] {
        assert_eq!(status("GET", &base, &format!("Host: {name}:{port}\r\n")), wanted, "{name}");
    }
    assert_eq!(status("GET", &base, "Host: 127.0.0.1\r\n"), 403, "another port");
    assert_eq!(status("GET", &base, ""), 403, "no host");
    // Other pages.
    for origin in ["null", "http://evil.example", &format!("https://localhost:{port}")] {
        let headers = format!("{host}Origin: {origin}\r\n");
        assert_eq!(status("POST", &format!("{base}allow"), &headers), 403, "{origin}");
    }
    assert_eq!(status("GET", &base, &format!("{host}Sec-Fetch-Site: cross-site\r\n")), 403);
    let headers = format!("{host}Origin: http://localhost:{port}\r\nSec-Fetch-Site: same-origin\r\n");
    assert_eq!(status("GET", &format!("{base}events?after=0"), &headers), 200);
    // Missing parts.
    for path in ["nothing", "../../../etc/passwd", "..%2f..%2fetc/passwd", "studio.js/", "/etc/passwd"] {
        assert_eq!(session.get(path).status, 404, "{path}");
    }
    assert_eq!(status("PUT", &base, &host), 405);
    assert_eq!(session.send("rubbish\r\n\r\n").status, 400);
    assert_eq!(session.send(&format!("GET {base} HTTP/1.1\r\nA: {}\r\n\r\n", "a".repeat(20_000))).status, 400);
    let chunked = format!("POST {base}text HTTP/1.1\r\n{host}Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n");
    assert_eq!(session.send(&chunked).status, 411);
    // And it is still there.
    assert_eq!(session.get("style.css").status, 200);
}

/// Requests that mean nothing are refused, and nothing in the program panics.
#[test]
fn meaningless_requests_are_refused() {
    let (_place, mut session) = session(CRANK);
    let number = session.model(0)["number"].clone();
    session.until("mechanism", |_| true);
    let deep = "[".repeat(100_000);
    let drag = |place: &str, from: &str| {
        format!("{{\"number\":{number},\"values\":[0.2,0.3],\"body\":1,\"point\":1,\"place\":{place},\"from\":{from}}}")
    };
    let bodies = [
        "",
        "null",
        "[]",
        "{}",
        "{\"path\":1}",
        "{\"path\":\"\"}",
        "{\"path\":\"\\u0000\",\"text\":\"\"}",
        "{\"method\":\"textDocument/hover\",\"params\":[]}",
        "{\"method\":\"textDocument/hover\",\"params\":{\"textDocument\":{\"uri\":\"file://\"}}}",
        "{\"number\":-1,\"values\":[]}",
        "{\"number\":18446744073709551616,\"values\":[]}",
        "{\"number\":1,\"values\":[1e999,0]}",
        &deep,
    ];
    let headers = format!("Host: {}\r\n", session.address);
    for route in ["open", "text", "load", "save", "language", "sample", "motion", "drag", "scene", "none"] {
        for body in bodies {
            let answer = session.request("POST", &format!("{}{route}", session.base), &headers, body);
            assert!((400..500).contains(&answer.status), "{route} {body:.60}: {} {}", answer.status, answer.body);
        }
    }
    // Places and poses of any size and number.
    for (place, from) in [
        ("[1e308,-1e308,0]", "null"),
        ("[0,0,0]", "[]"),
        ("[0.1,0,0]", "[1,2]"),
        ("[0,0,1e9]", "[1e300,1e300,1e300,1e300,1e300,1e300,1e300,1e300,1e300]"),
        ("[0.1,0.1,0]", "null"),
    ] {
        let answer = session.request("POST", &format!("{}drag", session.base), &headers, &drag(place, from));
        assert_eq!(answer.status, 200, "{place} {from}: {}", answer.body);
        assert!(answer.json()["residual"].as_f64().unwrap() < 1e-10, "{}", answer.body);
    }
    let known = json!({ "scene": "there is none" });
    assert_eq!(session.post("scene", &known).status, 200, "the first is shown");
    session.process.kill().unwrap();
    let mut errors = String::new();
    session.process.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
    assert_eq!(errors, "");
}

#[test]
fn unusable_files_are_refused() {
    let place = Place::new();
    let failed = |arguments: &str| place.run(&format!("studio --no-open {arguments}"), 2).1;
    assert!(failed("missing.yaml").contains("missing.yaml cannot be read: "));
    assert!(failed(".").contains("this is a directory"));
    assert!(failed("-").contains("standard input cannot be saved"));
    fs::write(place.path().join("a.urdf"), "<robot name='a'/>").unwrap();
    assert!(failed("a.urdf").contains("name it in a model"));
    fs::write(place.path().join("m.yaml"), CRANK).unwrap();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    assert!(failed(&format!("m.yaml --port {port}")).contains("Choose another by --port"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_session_with_a_message() {
    let (_place, mut session) = session(CRANK);
    session.until("bounds", |_| true);
    let id = session.process.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let mut output = String::new();
    session.output.read_to_string(&mut output).unwrap();
    assert!(output.contains("Ctrl-C ends it") && output.ends_with("the studio has ended\n"), "{output}");
    assert_eq!(session.process.wait().unwrap().code(), Some(0));
    let mut errors = String::new();
    session.process.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
    assert_eq!(errors, "");
}
