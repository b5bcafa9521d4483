//! Admission of requests: to this machine's own address, from the studio's own page, with its token.

use data_encoding::HEXLOWER;

/// Bytes of a token: nobody guesses 128 bits.
const BYTES: usize = 16;

/// Reasons to refuse a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The name of another host: it may resolve to this machine for a page elsewhere.
    #[error("the studio answers at 127.0.0.1, localhost and [::1] only")]
    Host,
    /// Another page.
    #[error("the studio answers its own page only")]
    Origin,
    /// Without the token, or with another.
    #[error("the address has no token, or that of another session: use the one that `mbint studio` printed")]
    Token,
}

/// The parts of a request that identify its caller.
#[derive(Clone, Copy, Debug)]
pub struct Caller<'r> {
    /// Path and query.
    pub url: &'r str,
    /// Header `Host`.
    pub host: Option<&'r str>,
    /// Header `Origin`.
    pub origin: Option<&'r str>,
    /// Header `Sec-Fetch-Site`.
    pub site: Option<&'r str>,
}

/// The rules of a session.
#[derive(Clone, Debug)]
pub struct Guard {
    token: String,
    hosts: [String; 3],
}

impl Guard {
    /// A guard with a new token, at a port.
    ///
    /// # Errors
    /// If the system has no random numbers.
    pub fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; BYTES];
        getrandom::fill(&mut bytes)?;
        let hosts = ["127.0.0.1", "localhost", "[::1]"].map(|name| format!("{name}:{port}"));
        Ok(Self { token: HEXLOWER.encode(&bytes), hosts })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://{}/{}/", self.hosts[0], self.token)
    }

    /// The part of an admitted request's address behind the token: path, and query or nothing.
    ///
    /// # Errors
    /// If the request is refused.
    pub fn admit<'r>(&self, caller: Caller<'r>) -> Result<(&'r str, &'r str), Refusal> {
        let is_own = |host: &str| self.hosts.iter().any(|own| own.eq_ignore_ascii_case(host));
        if !caller.host.is_some_and(is_own) {
            return Err(Refusal::Host);
        }
        let is_elsewhere = |origin: &str| !origin.strip_prefix("http://").is_some_and(is_own);
        if caller.origin.is_some_and(is_elsewhere)
            || caller.site.is_some_and(|site| site != "same-origin" && site != "none")
        {
            return Err(Refusal::Origin);
        }
        let (path, query) = caller.url.split_once('?').unwrap_or((caller.url, ""));
        let (token, rest) = path.strip_prefix('/').and_then(|path| path.split_once('/')).ok_or(Refusal::Token)?;
        if is_same(token.as_bytes(), self.token.as_bytes()) { Ok((rest, query)) } else { Err(Refusal::Token) }
    }
}

/// Whether two texts are equal, in a time that does not reveal where they differ.
fn is_same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differences, (a, b)| differences | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_studios_own_page_with_token_is_admitted() {
        let guard = Guard::new(4711).unwrap();
        let token = guard.token.clone();
        assert_eq!((token.len(), guard.address()), (32, format!("http://127.0.0.1:4711/{token}/")));
        assert_ne!(Guard::new(4711).unwrap().token, token);
        let url = format!("/{token}/file?path=a");
        let own = Caller { url: &url, host: Some("127.0.0.1:4711"), origin: None, site: None };
        assert_eq!(guard.admit(own), Ok(("file", "path=a")));
        assert_eq!(guard.admit(Caller { host: Some("LOCALHOST:4711"), ..own }), Ok(("file", "path=a")));
        let origin = Some("http://[::1]:4711");
        assert!(guard.admit(Caller { origin, site: Some("same-origin"), ..own }).is_ok());
        for host in [None, Some("evil.example:4711"), Some("127.0.0.1"), Some("127.0.0.1:4712"), Some("")] {
            assert_eq!(guard.admit(Caller { host, ..own }), Err(Refusal::Host), "{host:?}");
        }
        for origin in ["null", "http://evil.example", "https://127.0.0.1:4711", "http://127.0.0.1:4712", ""] {
            assert_eq!(guard.admit(Caller { origin: Some(origin), ..own }), Err(Refusal::Origin), "{origin}");
        }
        assert_eq!(guard.admit(Caller { site: Some("cross-site"), ..own }), Err(Refusal::Origin));
        let other = format!("/{}/", token.replace(|c| c != 'x', "0"));
        let short = format!("/{}/file", &token[1..]);
        for url in ["/", "", "/file", &format!("/{token}"), &short, &other, "//file"] {
            assert_eq!(guard.admit(Caller { url, ..own }), Err(Refusal::Token), "{url}");
        }
    }
}
