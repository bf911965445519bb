//! What may stand in an address.

use std::{
    fmt::Write,
    path::{Component, Path, Prefix},
};

/// The `file:` address of an absolute path (RFC 8089); none of a relative one, or of one that has no such address.
pub fn file(path: &Path) -> Option<String> {
    let mut uri = String::from("file://");
    for component in path.components() {
        match component {
            Component::RootDir => {}
            Component::Normal(name) => {
                uri.push('/');
                uri.push_str(&escaped(name.as_encoded_bytes()));
            }
            Component::Prefix(prefix) => match prefix.kind() {
                Prefix::Disk(letter) => {
                    let _ = write!(uri, "/{}:", char::from(letter));
                }
                Prefix::UNC(server, share) => {
                    let [server, share] = [server, share].map(|name| name.as_encoded_bytes());
                    let _ = write!(uri, "{}/{}", escaped(server), escaped(share));
                }
                _ => return None,
            },
            Component::CurDir | Component::ParentDir => return None,
        }
    }
    path.is_absolute().then_some(uri)
}

/// Bytes as they stand in an address: but for letters, digits and a few signs, each as its hexadecimal code (RFC 3986).
pub fn escaped(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    for &byte in bytes {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' => text.push(char::from(byte)),
            b'-' | b'.' | b'_' | b'~' | b'/' | b':' | b'=' => text.push(char::from(byte)),
            other => {
                let _ = write!(text, "%{other:02X}");
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn an_absolute_path_has_an_address() {
        let uri = |path: &str| file(Path::new(path));
        assert_eq!(
            uri("/home/zoë/a b#c?/100%.md").as_deref(),
            Some("file:///home/zo%C3%AB/a%20b%23c%3F/100%25.md")
        );
        assert_eq!(uri("//a/./b_1.md").as_deref(), Some("file:///a/b_1.md"));
        assert_eq!(uri("a.md"), None);
        assert_eq!(uri("/a/../b.md"), None);
    }

    #[cfg(windows)]
    #[test]
    fn an_absolute_path_has_an_address() {
        let uri = |path: &str| file(Path::new(path));
        assert_eq!(
            uri(r"C:\Users\a b\c.md").as_deref(),
            Some("file:///C:/Users/a%20b/c.md")
        );
        assert_eq!(
            uri(r"\\server\share\c.md").as_deref(),
            Some("file://server/share/c.md")
        );
        assert_eq!(uri(r"\a.md"), None);
    }
}
