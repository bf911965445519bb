//! Tests of access: which clients the host of Studio admits, and what they can request.

use std::{
    io::{ErrorKind, Read, Write},
    net::{Shutdown, TcpStream},
    thread,
    time::{Duration, Instant},
};

use pinhole::scene::SMALLEST;
use serde_json::json;
use tungstenite::{Message, protocol::frame::coding::CloseCode};

use super::client::{Studio, studio};
use crate::lsp::client::PATIENCE;

fn status(response: &str) -> &str {
    let line = response.strip_prefix("HTTP/1.1 ").unwrap_or_default();
    line.get(..3).unwrap_or(response)
}

fn header<'a>(response: &'a str, name: &str) -> &'a str {
    let (head, _) = response.split_once("\r\n\r\n").unwrap();
    let values = head.lines().filter_map(|line| line.split_once(": "));
    let values: Vec<_> = values.filter(|(known, _)| *known == name).collect();
    assert_eq!(values.len(), 1, "{name} in {head}");
    values[0].1
}

/// Reads until the host closes the connection. Returns everything that the host sent.
fn until_closed(stream: &mut TcpStream) -> Vec<u8> {
    let mut said = Vec::new();
    match stream.read_to_end(&mut said) {
        Err(error) if error.kind() != ErrorKind::ConnectionReset => panic!("{error}"),
        _ => said,
    }
}

/// Returns the head of a request that opens a WebSocket. Its key is the example in RFC 6455.
fn upgrade(studio: &Studio) -> String {
    let host = studio.host();
    format!(
        "GET /socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: keep-alive, Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
}

/// Asserts that a page with the valid token still works, i.e. that it gets diagnostics for a text.
fn assert_page_works(studio: &Studio) {
    let (mut page, _) = studio.page();
    page.open(json!({}), SMALLEST);
    assert_eq!(page.diagnostics()["diagnostics"], json!([]));
    page.ask("pinhole/frame", json!({ "scale": 16, "samples": 1 }));
    for path in ["/", "/studio.js", "/studio.css"] {
        assert_eq!(status(&studio.get(path, "")), "200");
    }
}

#[test]
fn the_page_may_load_only_its_own_resources() {
    let (_folder, studio) = studio();
    let nonces = [0, 1].map(|_| {
        let response = studio.get("/", "");
        assert!(!response.contains("__NONCE__"));
        let policy = header(&response, "content-security-policy");
        let (_, nonce) = policy.split_once("'nonce-").unwrap();
        let nonce = nonce[..32].to_owned();
        assert_eq!(
            policy,
            format!(
                "default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{nonce}'; img-src 'self' blob: data:; connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
            )
        );
        nonce
    });
    assert_ne!(nonces[0], nonces[1]);
    for (path, kind) in [
        ("/", "text/html; charset=utf-8"),
        ("/studio.js", "text/javascript"),
        ("/studio.css", "text/css"),
        ("/x", "text/plain; charset=utf-8"),
    ] {
        // The host sets no cookies, and ignores cookies that other servers on this machine may have
        // set.
        let response = studio.get(path, &format!("Cookie: token={}\r\n", studio.token));
        for (name, value) in [
            ("content-type", kind),
            ("cache-control", "no-store"),
            ("referrer-policy", "no-referrer"),
            ("x-content-type-options", "nosniff"),
            ("connection", "close"),
        ] {
            assert_eq!(header(&response, name), value, "{path}");
        }
        assert!(!response.to_ascii_lowercase().contains("set-cookie"));
        assert!(!response.contains(&studio.token), "{path}");
    }
}

#[test]
fn requests_with_a_foreign_host_or_origin_are_refused() {
    let (_folder, studio) = studio();
    let port = studio.port;
    let ask = |path: &str, headers: &str| {
        studio.response(&format!("GET {path} HTTP/1.1\r\n{headers}\r\n\r\n"))
    };
    for host in ["127.0.0.1", "localhost"] {
        let host = format!("{host}:{port}");
        let response = ask("/", &format!("Host: {host}\r\nOrigin: http://{host}"));
        assert_eq!(status(&response), "200", "{host}");
    }
    let own = format!("Host: 127.0.0.1:{port}");
    for headers in [
        "Host: example.org",
        &format!("Host: example.org:{port}"),
        &format!("Host: 127.0.0.1.example.org:{port}"),
        "Host: 127.0.0.1",
        "Host: localhost:1",
        &format!("{own}\r\n{own}"),
        "Host:",
        "X: y",
        &format!("{own}\r\nOrigin: null"),
        &format!("{own}\r\nOrigin: http://example.org"),
        &format!("{own}\r\nOrigin: http://127.0.0.1"),
        &format!("{own}\r\nOrigin: http://127.0.0.1:1"),
        &format!("{own}\r\nOrigin: https://127.0.0.1:{port}"),
        &format!("{own}\r\nOrigin: http://localhost:{port}"),
        &format!("{own}\r\nOrigin: "),
        &format!("{own}\r\nOrigin: http://127.0.0.1:{port}\r\nOrigin: http://example.org"),
    ] {
        for path in ["/", "/studio.js", "/socket"] {
            assert_eq!(status(&ask(path, headers)), "403", "{path} {headers}");
        }
        // A request that opens a WebSocket is refused for the same reasons as other requests, even
        // if the rest of it is correct.
        let upgrade = upgrade(&studio);
        let socket = upgrade.lines().filter(|line| {
            let own = ["Connection", "Upgrade", "Sec-"];
            own.iter().any(|name| line.starts_with(name))
        });
        let socket = socket.collect::<Vec<_>>().join("\r\n");
        let response = ask("/socket", &format!("{headers}\r\n{socket}"));
        assert_eq!(status(&response), "403", "{headers}");
    }
}

#[test]
fn unknown_paths_and_methods_are_refused() {
    let (_folder, studio) = studio();
    let host = studio.host();
    let paths = r"/a.scn /index.html /studio.js/ // /.. /../a.scn /..%2fa.scn /%2e%2e/a.scn /..\a.scn
        /./studio.js //etc/passwd /%2Fetc%2Fpasswd";
    for path in paths.split_whitespace() {
        let response = studio.get(path, "");
        assert_eq!(status(&response), "404", "{path}");
        assert!(!response.contains("camera") && !response.contains("root:"));
    }
    // The target is an absolute address, as in a request to a proxy server.
    for target in ["http://127.0.0.1/studio.js", "http://example.org/"] {
        assert_eq!(status(&studio.get(target, "")), "403", "{target}");
    }
    for method in ["HEAD", "POST", "PUT", "DELETE", "OPTIONS", "get"] {
        let request = format!("{method} / HTTP/1.1\r\nHost: {host}\r\n");
        let body = "Content-Length: 4\r\n\r\nabcd";
        let response = studio.response(&format!("{request}{body}"));
        assert_eq!(status(&response), "405", "{method}");
        assert_eq!(header(&response, "allow"), "GET");
    }
}

#[test]
fn a_web_socket_request_needs_each_of_its_headers() {
    let (_folder, studio) = studio();
    let all = upgrade(&studio);
    for line in all.lines().skip(1).filter(|line| !line.is_empty()) {
        let without = all.replace(&format!("{line}\r\n"), "");
        let wanted = match line.split_once(':') {
            Some(("Host" | "Origin", _)) => "403",
            _ => "400",
        };
        assert_eq!(status(&studio.response(&without)), wanted, "{line}");
    }
    let mut stream = studio.stream();
    stream.write_all(all.as_bytes()).unwrap();
    let mut start = String::new();
    while !start.ends_with("\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        start.push(char::from(byte[0]));
    }
    assert_eq!(status(&start), "101");
    let accepted = header(&start, "sec-websocket-accept");
    assert_eq!(accepted, "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

#[test]
fn a_connection_without_the_token_is_closed() {
    let (_folder, studio) = studio();
    let token = &studio.token;
    assert_eq!(token.len(), 32);
    let unknown = CloseCode::from(4001);
    let asked =
        json!({ "jsonrpc": "2.0", "id": 1, "method": "studio/save", "params": { "text": "" } });
    for wrong in [
        "",
        "x",
        &token[1..],
        &format!("{token}0"),
        &format!(" {token}"),
        &token.to_ascii_uppercase(),
        &"0".repeat(32),
        &format!("token={token}"),
        &asked.to_string(),
    ] {
        assert_eq!(studio.admitted(wrong).err(), Some(unknown), "{wrong}");
    }
    // The host admits no client that sends a binary message or a close message instead of a token.
    for wrong in [
        Message::binary(token.clone().into_bytes()),
        Message::Close(None),
    ] {
        let mut socket = studio.socket();
        socket.send(wrong).unwrap();
        let said = socket.read();
        assert!(!matches!(said, Ok(Message::Text(_))), "{said:?}");
    }
    // A token of one running program is unknown to another one.
    let (_folder, other) = self::studio();
    assert_eq!(other.admitted(token).err(), Some(unknown));
    assert_page_works(&studio);
}

/// Each client sends the start of a request or message. Then it sends nothing more, or continues
/// very slowly.
#[test]
fn a_client_without_the_token_is_disconnected_after_five_seconds() {
    let (_folder, studio) = studio();
    let upgrade = upgrade(&studio);
    // `ping` ends with a ping frame, and `text` with the first bytes of a text frame that announces
    // 100 bytes.
    let ping = [upgrade.as_bytes(), &[0x89, 0x80, 0, 0, 0, 0]].concat();
    let text = [upgrade.as_bytes(), &[0x81, 0xe4, 0, 0, 0, 0, 1]].concat();
    thread::scope(|scope| {
        for (start, every, is_early) in [
            (&b""[..], None, false),
            (b"GET / HT", None, false),
            (b"GET / HTTP/1.1\r\nX: ", Some(b"y"), false),
            (upgrade.as_bytes(), None, false),
            (&ping, None, true),
            (&text, Some(b"y"), false),
            (b"GET / HT", None, true),
            (upgrade.as_bytes(), None, true),
        ] {
            let (mut stream, ping) = (studio.stream(), &ping);
            scope.spawn(move || {
                let begun = Instant::now();
                stream.write_all(start).unwrap();
                if is_early && start != ping.as_slice() {
                    stream.shutdown(Shutdown::Write).unwrap();
                }
                if let Some(more) = every {
                    let mut slow = stream.try_clone().unwrap();
                    thread::spawn(move || {
                        while slow.write_all(more).is_ok() {
                            thread::sleep(Duration::from_millis(100));
                        }
                    });
                }
                until_closed(&mut stream);
                let time = begun.elapsed();
                let start = String::from_utf8_lossy(start);
                assert!(time < Duration::from_secs(8), "{start}: {time:?}");
                // A client is disconnected at once, rather than after five seconds, if it has
                // closed its side or has sent something that is not a token.
                assert!(
                    is_early || time > Duration::from_secs(4),
                    "{start}: {time:?}"
                );
            });
        }
    });
    assert_page_works(&studio);
}

#[test]
fn idle_connections_without_the_token_do_not_block_pages() {
    let (_folder, studio) = studio();
    let (mut before, _) = studio.page();
    for count in [64, 200] {
        let idle: Vec<TcpStream> = (0..count).map(|_| studio.stream()).collect();
        assert_page_works(&studio);
        let sockets: Vec<_> = (0..count).map(|_| studio.socket()).collect();
        assert_page_works(&studio);
        drop((idle, sockets));
    }
    // The host allows at most 64 clients without the token. Pages have the token, so 80 of them
    // continue to work.
    let mut pages: Vec<_> = (0..80).map(|_| studio.page().0).collect();
    for page in pages.iter_mut().chain([&mut before]) {
        page.open(json!({}), SMALLEST);
        page.diagnostics();
    }
}

#[test]
fn malformed_requests_and_frames_do_no_harm() {
    let (_folder, studio) = studio();
    let start = format!("GET / HTTP/1.1\r\nHost: {}\r\n", studio.host());
    let upgrade = upgrade(&studio);
    // A text frame that announces 64 MiB and breaks off after the first MiB.
    let head = [&[0x81, 0xff][..], &(64_u64 << 20).to_be_bytes(), &[0; 4]].concat();
    let huge = [upgrade.as_bytes(), &head, &vec![b'y'; 1 << 20]].concat();
    for wrong in [
        format!("{start}X: {}\r\n\r\n", "y".repeat(40_000)).as_bytes(),
        format!("{start}{}\r\n", "X: y\r\n".repeat(200)).as_bytes(),
        b"\r\n\r\n\0\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET / HTTP/1.1\r\n\xe9\r\n\r\n",
        b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        // The frames are invalid: a reserved opcode, a frame without a mask, a continuation frame
        // without a first frame, and a text frame that is not UTF-8.
        &[upgrade.as_bytes(), &[0x8f, 0x80, 0, 0, 0, 0]].concat(),
        &[upgrade.as_bytes(), &[0x81, 0x01, b'y']].concat(),
        &[upgrade.as_bytes(), &[0x80, 0x81, 0, 0, 0, 0, b'y']].concat(),
        &[upgrade.as_bytes(), &[0x81, 0x81, 0, 0, 0, 0, 0xff]].concat(),
        &huge,
    ] {
        let begun = Instant::now();
        let mut stream = studio.stream();
        // The host may close the connection before everything is written, so errors are ignored.
        let _ = stream.write_all(wrong);
        let said = until_closed(&mut stream);
        let (said, wrong) = (
            String::from_utf8_lossy(&said),
            String::from_utf8_lossy(wrong),
        );
        assert!(begun.elapsed() < PATIENCE / 10, "{wrong:.60}");
        let is_refused = said.is_empty() || matches!(status(&said), "400" | "431" | "101");
        assert!(is_refused, "{wrong:.60}: {said}");
    }
    assert_page_works(&studio);
}

/// On Linux, all addresses 127.0.0.0/8 lead to this machine. A server that listened at every
/// address could therefore be reached at 127.0.0.2.
#[cfg(target_os = "linux")]
#[test]
fn studio_listens_only_at_127_0_0_1() {
    let (_folder, studio) = studio();
    assert!(TcpStream::connect(("127.0.0.1", studio.port)).is_ok());
    assert!(TcpStream::connect(("127.0.0.2", studio.port)).is_err());
    assert!(TcpStream::connect(("::1", studio.port)).is_err());
}
