//! Who is let in, and to what.

use std::{
    io::{Read, Write},
    net::TcpStream,
    time::{Duration, Instant},
};

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

/// The line of the head that lets a browser in.
fn cookie(studio: &Studio) -> String {
    format!("Cookie: {}\r\n", studio.cookie())
}

#[test]
fn the_token_is_exchanged_for_a_cookie() {
    let (_folder, first) = studio();
    let exchange = |token: &str| first.get(&format!("/?token={token}"), "");
    assert_eq!(first.token.len(), 32);
    let response = exchange(&first.token);
    assert_eq!(status(&response), "303");
    assert_eq!(header(&response, "Location"), "/");
    let attributes = "Path=/; HttpOnly; SameSite=Strict";
    let cookie = format!("{}; {attributes}", first.cookie());
    assert_eq!(header(&response, "Set-Cookie"), cookie);
    // What browsers send to other servers of this machine, too, opens nothing in an address.
    assert_ne!(first.token, first.secret);
    let longer = format!("{}0", first.token);
    let zeros = "0".repeat(32);
    for token in ["", "x", &first.token[1..], &longer, &zeros, &first.secret] {
        let response = exchange(token);
        assert_eq!(status(&response), "403", "{token}");
        assert!(!response.contains(&first.secret));
    }
    // Another run has another token.
    let (_folder, other) = studio();
    assert!(first.token != other.token && first.secret != other.secret);
}

#[test]
fn nothing_is_given_out_without_the_cookie() {
    let (_folder, studio) = studio();
    let (cookie, secret) = (studio.cookie(), &studio.secret);
    let (name, _) = cookie.split_once('=').unwrap();
    let origin = format!("Origin: http://{}", studio.host());
    for path in ["/", "/studio.js", "/studio.css", "/socket", "/a.scn", "/x"] {
        for wrong in [
            String::new(),
            format!("{name}="),
            format!("{name}={}", "0".repeat(32)),
            format!("{name}={}", &secret[1..]),
            format!("pinhole-1={secret}"),
            format!("x={cookie}"),
            // Two headers: a browser sends one.
            format!("{cookie}\r\nCookie: {cookie}"),
        ] {
            let response = studio.get(path, &format!("{origin}\r\nCookie: {wrong}\r\n"));
            assert_eq!(status(&response), "403", "{path} {wrong}");
        }
    }
    let others = [format!("a=b; {cookie}; c"), format!("{name}=x;{cookie}")];
    for right in others.iter().chain([&cookie]) {
        let response = studio.get("/", &format!("Cookie: {right}\r\n"));
        assert_eq!(status(&response), "200", "{right}");
    }
}

#[test]
fn other_hosts_and_pages_are_refused() {
    let (_folder, studio) = studio();
    let (port, cookie, token) = (studio.port, cookie(&studio), &studio.token);
    let ask = |path: &str, headers: &str| {
        studio.response(&format!("GET {path} HTTP/1.1\r\n{cookie}{headers}\r\n\r\n"))
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
        &format!("{own}\r\nOrigin: https://127.0.0.1:{port}"),
        &format!("{own}\r\nOrigin: http://localhost:{port}"),
        &format!("{own}\r\nOrigin: "),
    ] {
        for path in ["/", "/studio.js", "/socket", &format!("/?token={token}")] {
            let response = ask(path, headers);
            assert_eq!(status(&response), "403", "{path} {headers}");
            assert!(!response.contains(&studio.secret));
        }
    }
}

#[test]
fn there_is_no_other_path_and_no_other_method() {
    let (_folder, studio) = studio();
    let (host, cookie) = (studio.host(), cookie(&studio));
    let paths = r"/a.scn /index.html /studio.js/ /studio.js?x /?x // /.. /../a.scn /..%2fa.scn /%2e%2e/a.scn /..\a.scn
        /./studio.js //etc/passwd /%2Fetc%2Fpasswd file:///etc/passwd http://127.0.0.1/studio.js *";
    for path in paths.split_whitespace() {
        let response = studio.get(path, &cookie);
        assert_eq!(status(&response), "404", "{path}");
        assert!(!response.contains("camera") && !response.contains("root:"));
    }
    for method in ["HEAD", "POST", "PUT", "DELETE", "OPTIONS", "CONNECT", "get"] {
        let request = format!("{method} / HTTP/1.1\r\nHost: {host}\r\n{cookie}");
        let body = "Content-Length: 4\r\n\r\nabcd";
        let response = studio.response(&format!("{request}{body}"));
        assert_eq!(status(&response), "405", "{method}");
        assert_eq!(header(&response, "Allow"), "GET");
    }
}

#[test]
fn the_page_may_use_what_is_its_own_and_nothing_else() {
    let (_folder, studio) = studio();
    let cookie = cookie(&studio);
    let nonces = [0, 1].map(|_| {
        let response = studio.get("/", &cookie);
        assert!(!response.contains("__NONCE__"));
        let policy = header(&response, "Content-Security-Policy");
        let (_, nonce) = policy.split_once("'nonce-").unwrap();
        let nonce = nonce[..32].to_owned();
        assert_eq!(
            policy,
            format!(
                "default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{nonce}'; img-src 'self' blob: data:; connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
            )
        );
        assert_ne!(nonce, studio.secret);
        nonce
    });
    assert_ne!(nonces[0], nonces[1]);
    for (path, kind) in [
        ("/", "text/html; charset=utf-8"),
        ("/studio.js", "text/javascript"),
        ("/studio.css", "text/css"),
        ("/x", "text/plain; charset=utf-8"),
    ] {
        let response = studio.get(path, &cookie);
        assert_eq!(header(&response, "Content-Type"), kind);
        assert_eq!(header(&response, "Cache-Control"), "no-store");
        assert_eq!(header(&response, "Referrer-Policy"), "no-referrer");
        assert_eq!(header(&response, "X-Content-Type-Options"), "nosniff");
    }
}

#[test]
fn a_web_socket_names_its_page_and_is_one() {
    let (_folder, studio) = studio();
    let host = studio.host();
    // The key is the example of RFC 6455.
    let lines = [
        (&*cookie(&studio), "403"),
        (&*format!("Origin: http://{host}\r\n"), "403"),
        ("Connection: keep-alive, Upgrade\r\n", "426"),
        ("Upgrade: websocket\r\n", "426"),
        ("Sec-WebSocket-Version: 13\r\n", "426"),
        ("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n", "426"),
    ];
    let but = |missing: &str| {
        let kept = lines.iter().filter(|(line, _)| *line != missing);
        kept.map(|(line, _)| *line).collect::<String>()
    };
    for (missing, wanted) in lines {
        let response = studio.get("/socket", &but(missing));
        assert_eq!(status(&response), wanted, "{missing}");
    }
    let mut stream = studio.stream();
    let all = but("");
    write!(stream, "GET /socket HTTP/1.1\r\nHost: {host}\r\n{all}\r\n").unwrap();
    let mut start = [0; 129];
    stream.read_exact(&mut start).unwrap();
    let start = String::from_utf8_lossy(&start).into_owned();
    assert_eq!(status(&start), "101");
    let accepted = header(&start, "Sec-WebSocket-Accept");
    assert_eq!(accepted, "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

#[test]
fn what_is_no_request_does_no_harm() {
    let (_folder, studio) = studio();
    let start = format!("GET / HTTP/1.1\r\nHost: {}\r\n", studio.host());
    for wrong in [
        &*format!("{start}X: {}\r\n\r\n", "y".repeat(20_000)),
        &*format!("{start}{}\r\n", "X: y\r\n".repeat(100)),
        "\r\n\r\n\0\r\n\r\n",
        "GET\r\n\r\n",
        "GET / HTTP/1.1\r\n\u{e9}\r\n\r\n",
    ] {
        assert_eq!(status(&studio.response(wrong)), "400", "{wrong:.40}");
    }
    // Who says nothing more is not waited for.
    let begun = Instant::now();
    assert_eq!(status(&studio.response("GET / HT")), "400");
    let time = begun.elapsed();
    assert!(time < PATIENCE / 2 && time > Duration::from_secs(3));
    assert_eq!(status(&studio.get("/", &cookie(&studio))), "200");
}

#[test]
fn so_many_connections_are_served_at_once() {
    let (_folder, studio) = studio();
    let waiting: Vec<TcpStream> = (0..64).map(|_| studio.stream()).collect();
    // Whoever comes too early finds the last of them not yet counted.
    while status(&studio.get("/", "")) != "503" {}
    drop(waiting);
    let mut after = studio.get("/", "");
    while status(&after) == "503" {
        after = studio.get("/", "");
    }
    assert_eq!(status(&after), "403");
}

/// All of 127.0.0.0/8 leads to this machine, where Linux is concerned, and what listens at any address is found there.
#[cfg(target_os = "linux")]
#[test]
fn only_one_address_is_listened_at() {
    let (_folder, studio) = studio();
    assert!(TcpStream::connect(("127.0.0.1", studio.port)).is_ok());
    assert!(TcpStream::connect(("127.0.0.2", studio.port)).is_err());
    assert!(TcpStream::connect(("::1", studio.port)).is_err());
}
