//! Answers over HTTP, with the headers that isolate a page.

use std::io::{self, Write};

use serde_json::{Value, json};

/// Policy of the studio's page: its own scripts, and requests to its own address.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src data:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Policy of a report, whose page has a policy of its own.
const REPORT: &str = "frame-ancestors 'none'";

/// An answer.
#[derive(Debug)]
pub struct Answer {
    status: u16,
    kind: &'static str,
    policy: &'static str,
    body: Vec<u8>,
}

impl Answer {
    /// A part of the page.
    pub fn part(kind: &'static str, body: impl Into<Vec<u8>>) -> Self {
        Self { status: 200, kind, policy: POLICY, body: body.into() }
    }

    /// A report.
    pub fn report(page: Vec<u8>) -> Self {
        Self { policy: REPORT, ..Self::part("text/html; charset=utf-8", page) }
    }

    /// Data.
    pub fn json(value: &Value) -> Self {
        Self::part("application/json", value.to_string())
    }

    /// An error: its status and its message.
    pub fn error(status: u16, why: &str) -> Self {
        Self { status, ..Self::json(&json!({ "error": why })) }
    }

    /// Writes it; the connection has no further answer.
    ///
    /// # Errors
    /// If the other end has closed.
    pub fn write(&self, to: &mut impl Write) -> io::Result<()> {
        let reason = match self.status {
            200 => "OK",
            status if status < 500 => "Refused",
            _ => "Failed",
        };
        let (kind, policy, length) = (self.kind, self.policy, self.body.len());
        let head = format!(
            "HTTP/1.1 {} {reason}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n\
             Content-Security-Policy: {policy}\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n\
             Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
             Cross-Origin-Opener-Policy: same-origin\r\nConnection: close\r\n\r\n",
            self.status
        );
        to.write_all(head.as_bytes())?;
        to.write_all(&self.body)?;
        to.flush()
    }
}
