//! Addresses of files: `file:///home/a%20b.yaml` and `/home/a b.yaml`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use lsp_types::Uri;

/// The path that an address names; `None` if it names no file on this machine.
pub fn path_of(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.as_str().strip_prefix("file://")?;
    let path = &rest[rest.find('/')?..];
    let host = &rest[..rest.len() - path.len()];
    if !(host.is_empty() || host == "localhost") {
        return None;
    }
    let text = decoded(path)?;
    // `/C:/models/a.yaml` on Windows.
    let drive = text.get(1..3).is_some_and(|drive| drive.ends_with(':') && drive.starts_with(char::is_alphabetic));
    Some(PathBuf::from(if cfg!(windows) && drive { &text[1..] } else { &text }))
}

/// The address of an absolute path.
pub fn uri_of(path: &Path) -> Option<Uri> {
    let text = path.to_str()?.replace(std::path::MAIN_SEPARATOR, "/");
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' => uri.push(byte.into()),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    Uri::from_str(&uri).ok()
}

fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, behind @ ..] = rest {
        match (first, behind) {
            (b'%', [high, low, behind @ ..]) => {
                let digits = [*high, *low];
                bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
                rest = behind;
            }
            _ => {
                bytes.push(*first);
                rest = behind;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_and_its_path() {
        let path = Path::new("/tmp/ä b/100%/[x].yaml");
        let uri = uri_of(path).unwrap();
        assert_eq!(uri.as_str(), "file:///tmp/%C3%A4%20b/100%25/%5Bx%5D.yaml");
        assert_eq!(path_of(&uri).unwrap(), path);
        let of = |text: &str| path_of(&Uri::from_str(text).unwrap());
        assert_eq!(of("file://localhost/a.yaml").unwrap(), Path::new("/a.yaml"));
        assert_eq!(of("file://elsewhere/a.yaml"), None);
        assert_eq!(of("untitled:Untitled-1"), None);
        assert_eq!(of("file:///%FF"), None);
    }
}
