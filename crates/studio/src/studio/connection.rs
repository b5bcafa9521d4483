//! A connection of HTTP/1.1 with one request: head, then body, then the answer.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};

use super::answer::Answer;
use super::guard::Caller;
use super::tuning::TUNING;

/// The head of a request.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// `GET` or `POST`.
    pub method: String,
    /// Path and query.
    pub url: String,
    /// Names in lower case, and values.
    headers: Vec<(String, String)>,
    /// Bytes of the head.
    length: usize,
}

impl Head {
    /// The head at the beginning of some bytes; `None` if it does not end in them.
    ///
    /// # Errors
    /// If they are not a head.
    fn parse(bytes: &[u8]) -> Result<Option<Self>, httparse::Error> {
        let mut headers = [httparse::EMPTY_HEADER; TUNING.headers];
        let mut request = httparse::Request::new(&mut headers);
        let httparse::Status::Complete(length) = request.parse(bytes)? else { return Ok(None) };
        let text = |own: Option<&str>| own.unwrap_or_default().to_owned();
        let header = |own: &httparse::Header| {
            (own.name.to_ascii_lowercase(), String::from_utf8_lossy(own.value).trim().to_owned())
        };
        let (method, url) = (text(request.method), text(request.path));
        Ok(Some(Self { method, url, headers: request.headers.iter().map(header).collect(), length }))
    }

    /// A header by its name in lower case; the first one, so that a second one has no effect.
    fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The parts that identify the caller.
    pub fn caller(&self) -> Caller<'_> {
        Caller {
            url: &self.url,
            host: self.header("host"),
            origin: self.header("origin"),
            site: self.header("sec-fetch-site"),
        }
    }
}

/// A connection whose head was read.
pub struct Connection {
    stream: TcpStream,
    /// The head of its request.
    pub head: Head,
    /// The beginning of the body.
    begun: Vec<u8>,
}

impl Connection {
    /// Reads a head.
    ///
    /// # Errors
    /// If there is none, it is too long, or the other end is silent.
    pub fn open(mut stream: TcpStream) -> io::Result<Self> {
        stream.set_read_timeout(Some(TUNING.silence))?;
        stream.set_write_timeout(Some(TUNING.silence))?;
        stream.set_nodelay(true)?;
        let mut bytes = Vec::new();
        let mut piece = [0; 4096];
        loop {
            let count = stream.read(&mut piece)?;
            bytes.extend_from_slice(&piece[..count]);
            match Head::parse(&bytes) {
                Ok(Some(head)) => {
                    let begun = bytes.split_off(head.length);
                    return Ok(Self { stream, head, begun });
                }
                Ok(None) if count > 0 && bytes.len() < TUNING.head_bytes => {}
                _ => {
                    let answer = Answer::error(400, "this is no request of HTTP");
                    close(&mut stream, &answer);
                    return Err(io::ErrorKind::InvalidData.into());
                }
            }
        }
    }

    /// Reads the body, a text.
    ///
    /// # Errors
    /// An answer with the reason.
    pub fn body(&mut self) -> Result<String, Answer> {
        let head = &self.head;
        if head.header("transfer-encoding").is_some() {
            return Err(Answer::error(411, "a body needs its length"));
        }
        let length = head.header("content-length").map_or(Ok(0), str::parse::<usize>);
        let length = length.map_err(|_| Answer::error(400, "the length is no number"))?;
        if length > TUNING.body_bytes {
            return Err(Answer::error(413, "the request is too long"));
        }
        let broken = |_| Answer::error(400, "the request breaks off");
        if head.header("expect").is_some() {
            self.stream.write_all(b"HTTP/1.1 100 Continue\r\n\r\n").map_err(broken)?;
        }
        let mut body = std::mem::take(&mut self.begun);
        body.truncate(length);
        let mut rest = (&mut self.stream).take((length - body.len()) as u64);
        rest.read_to_end(&mut body).map_err(broken)?;
        if body.len() < length {
            return Err(Answer::error(400, "the request breaks off"));
        }
        String::from_utf8(body).map_err(|_| Answer::error(400, "the request is no text"))
    }

    /// Answers, and closes.
    pub fn answer(mut self, answer: &Answer) {
        close(&mut self.stream, answer);
    }
}

/// Writes an answer and closes. Closing with unread bytes would discard the answer, so they are read first.
fn close(stream: &mut TcpStream, answer: &Answer) {
    // Nothing to do if the other end has closed.
    if answer.write(stream).is_ok() && stream.shutdown(Shutdown::Write).is_ok() {
        let _ = stream.set_read_timeout(Some(TUNING.linger));
        let _ = io::copy(&mut stream.take(TUNING.dropped_bytes), &mut io::sink());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_of_requests() {
        let text = b"POST /a?b HTTP/1.1\r\nHost: localhost:1\r\nORIGIN:  http://x \r\nHost: evil\r\n\r\nbody";
        for end in 0..text.len() - 5 {
            assert_eq!(Head::parse(&text[..end]), Ok(None), "{end}");
        }
        let head = Head::parse(text).unwrap().unwrap();
        assert_eq!((head.method.as_str(), head.url.as_str(), head.length), ("POST", "/a?b", text.len() - 4));
        let caller = head.caller();
        assert_eq!((caller.host, caller.origin, caller.site), (Some("localhost:1"), Some("http://x"), None));
        for wrong in [&b"GET / HTTP/2.0\r\n\r\n"[..], b"\x16\x03\x01", b"GET / HTTP/1.1\r\nno colon\r\n\r\n"] {
            assert!(Head::parse(wrong).is_err(), "{wrong:?}");
        }
        let many = format!("GET / HTTP/1.1\r\n{}\r\n", "a: b\r\n".repeat(TUNING.headers + 1));
        assert!(Head::parse(many.as_bytes()).is_err());
    }
}
