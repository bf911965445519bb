//! Who is let in, and to what.

use std::{
    io::{Read, Write},
    net::TcpStream,
    time::{Duration, Instant},
};

use super::client::{PATIENCE, studio};

fn status(response: &str) -> &str {
    let line = response.strip_prefix("HTTP/1.1 ").unwrap_or_default();
    line.get(..3).unwrap_or(response)
}

fn header<'a>(response: &'a str, name: &str) -> &'a str {
    let (head, _) = response.split_once("\r\n\r\n").unwrap();
    let mut values = head
        .lines()
        .filter_map(|line| line.strip_prefix(name)?.strip_prefix(": "));
    let value = values
        .next()
        .unwrap_or_else(|| panic!("no {name} in {head}"));
    assert_eq!(values.next(), None);
    value
}

#[test]
fn the_token_is_exchanged_for_a_cookie() {
    let (_folder, studio) = studio();
    assert_eq!(studio.token.len(), 32);
    let response = studio.get(&format!("/?token={}", studio.token), "");
    assert_eq!(status(&response), "303");
    assert_eq!(header(&response, "Location"), "/");
    let cookie = header(&response, "Set-Cookie");
    let attributes = "Path=/; HttpOnly; SameSite=Strict";
    assert_eq!(cookie, format!("{}; {attributes}", studio.cookie()));
    let wrong = [
        "",
        "x",
        &studio.token[1..],
        &format!("{}0", studio.token),
        &"0".repeat(32),
    ]
    .map(|token| format!("/?token={token}"));
    for path in wrong {
        let response = studio.get(&path, "");
        assert_eq!(status(&response), "403", "{path}");
        assert!(!response.contains(&studio.secret));
    }
    // What browsers send to other servers of this machine, too, opens nothing in an address.
    assert_ne!(studio.token, studio.secret);
    let response = studio.get(&format!("/?token={}", studio.secret), "");
    assert_eq!(status(&response), "403");
    // Another run has another token.
    let (_folder, other) = super::client::studio();
    assert!(studio.token != other.token && studio.secret != other.secret);
}

#[test]
fn nothing_is_given_out_without_the_cookie() {
    let (_folder, studio) = studio();
    let (cookie, token) = (studio.cookie(), &studio.secret);
    let (name, _) = cookie.split_once('=').unwrap();
    for path in ["/", "/studio.js", "/studio.css", "/socket", "/a.scn", "/x"] {
        for wrong in [
            String::new(),
            format!("{name}="),
            format!("{name}={}", "0".repeat(32)),
            format!("{name}={}", &token[1..]),
            format!("pinhole-1={token}"),
            format!("x={cookie}"),
            // Two headers: a browser sends one.
            format!("{cookie}\r\nCookie: {cookie}"),
        ] {
            let origin = format!("Origin: http://{}", studio.host());
            let response = studio.get(path, &format!("{origin}\r\nCookie: {wrong}\r\n"));
            assert_eq!(status(&response), "403", "{path} {wrong}");
        }
    }
    let right = [
        cookie.clone(),
        format!("a=b; {cookie}; c"),
        format!("{name}=x;{cookie}"),
    ];
    for right in right {
        let response = studio.get("/", &format!("Cookie: {right}\r\n"));
        assert_eq!(status(&response), "200", "{right}");
    }
}

#[test]
fn other_hosts_and_pages_are_refused() {
    let (_folder, studio) = studio();
    let (port, cookie, token) = (studio.port, studio.cookie(), &studio.token);
    let ask = |path: &str, headers: &str| {
        studio.response(&format!(
            "GET {path} HTTP/1.1\r\nCookie: {cookie}\r\n{headers}\r\n\r\n"
        ))
    };
    for host in ["127.0.0.1", "localhost"] {
        let host = format!("{host}:{port}");
        let response = ask("/", &format!("Host: {host}\r\nOrigin: http://{host}"));
        assert_eq!(status(&response), "200", "{host}");
    }
    let wrong_hosts = [
        "Host: example.org".to_owned(),
        format!("Host: example.org:{port}"),
        format!("Host: 127.0.0.1.example.org:{port}"),
        "Host: 127.0.0.1".to_owned(),
        "Host: localhost:1".to_owned(),
        format!("Host: 127.0.0.1:{port}\r\nHost: 127.0.0.1:{port}"),
        "Host:".to_owned(),
        "X: y".to_owned(),
    ];
    let wrong_origins = [
        "null".to_owned(),
        "http://example.org".to_owned(),
        "http://127.0.0.1".to_owned(),
        format!("https://127.0.0.1:{port}"),
        format!("http://localhost:{port}"),
        String::new(),
    ];
    let wrong_origins =
        wrong_origins.map(|origin| format!("Host: 127.0.0.1:{port}\r\nOrigin: {origin}"));
    for headers in wrong_hosts.iter().chain(&wrong_origins) {
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
    let cookie = format!("Cookie: {}\r\n", studio.cookie());
    for path in [
        "/a.scn",
        "/index.html",
        "/studio.js/",
        "/studio.js?x",
        "/?x",
        "//",
        "/..",
        "/../a.scn",
        "/..%2fa.scn",
        "/%2e%2e/a.scn",
        "/..\\a.scn",
        "/./studio.js",
        "//etc/passwd",
        "/%2Fetc%2Fpasswd",
        "file:///etc/passwd",
        "http://127.0.0.1/studio.js",
        "*",
    ] {
        let response = studio.get(path, &cookie);
        assert_eq!(status(&response), "404", "{path}");
        assert!(!response.contains("camera") && !response.contains("root:"));
    }
    let host = studio.host();
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
    let cookie = format!("Cookie: {}\r\n", studio.cookie());
    let mut nonces = Vec::new();
    for _ in 0..2 {
        let response = studio.get("/", &cookie);
        let policy = header(&response, "Content-Security-Policy");
        let (_, nonce) = policy.split_once("'nonce-").unwrap();
        let (nonce, _) = nonce.split_once('\'').unwrap();
        let directives: Vec<_> = policy.split("; ").collect();
        assert_eq!(
            directives,
            [
                "default-src 'none'",
                "script-src 'self'",
                &format!("style-src 'self' 'nonce-{nonce}'"),
                "img-src 'self' blob: data:",
                "connect-src 'self'",
                "worker-src 'self'",
                "base-uri 'none'",
                "form-action 'none'",
                "frame-ancestors 'none'",
            ]
        );
        assert!(!response.contains("__NONCE__"));
        nonces.push(nonce.to_owned());
    }
    assert_ne!(nonces[0], nonces[1]);
    assert!(
        nonces
            .iter()
            .all(|nonce| nonce.len() == 32 && *nonce != studio.secret)
    );
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
    let cookie = format!("Cookie: {}\r\n", studio.cookie());
    let origin = format!("Origin: http://{host}\r\n");
    let upgrade = "Connection: keep-alive, Upgrade\r\nUpgrade: websocket\r\n";
    let version = "Sec-WebSocket-Version: 13\r\n";
    let key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    let missing = |left_out: &str| {
        let all = [&cookie, &origin, upgrade, version, key];
        let kept = all.into_iter().filter(|line| *line != left_out);
        kept.collect::<String>()
    };
    for (left_out, wanted) in [
        (&*cookie, "403"),
        (&*origin, "403"),
        (upgrade, "426"),
        (version, "426"),
        (key, "426"),
    ] {
        let response = studio.get("/socket", &missing(left_out));
        assert_eq!(status(&response), wanted, "{left_out}");
    }
    // The example of RFC 6455.
    let mut stream = studio.stream();
    let all = missing("");
    write!(stream, "GET /socket HTTP/1.1\r\nHost: {host}\r\n{all}\r\n").unwrap();
    let mut start = [0; 129];
    stream.read_exact(&mut start).unwrap();
    let start = String::from_utf8_lossy(&start).into_owned();
    assert_eq!(status(&start), "101");
    assert_eq!(
        header(&start, "Sec-WebSocket-Accept"),
        "s3pPLMBiTxaQ9kYGzzhZRbK+xOo="
    );
}

#[test]
fn what_is_no_request_does_no_harm() {
    let (_folder, studio) = studio();
    let host = studio.host();
    let long = format!(
        "GET / HTTP/1.1\r\nHost: {host}\r\nX: {}\r\n\r\n",
        "y".repeat(20_000)
    );
    let many = format!(
        "GET / HTTP/1.1\r\nHost: {host}\r\n{}\r\n",
        "X: y\r\n".repeat(100)
    );
    for wrong in [
        &long,
        &many,
        "\r\n\r\n\0\r\n\r\n",
        "GET\r\n\r\n",
        "GET / HTTP/1.1\r\n\u{e9}\r\n\r\n",
    ] {
        let response = studio.response(wrong);
        assert_eq!(status(&response), "400", "{wrong:.40}");
    }
    // Who says nothing more is not waited for.
    let begun = Instant::now();
    assert_eq!(status(&studio.response("GET / HT")), "400");
    let time = begun.elapsed();
    assert!(
        time < PATIENCE / 2 && time > Duration::from_secs(3),
        "{time:?}"
    );
    assert_eq!(
        status(&studio.get("/", &format!("Cookie: {}\r\n", studio.cookie()))),
        "200"
    );
}

#[test]
fn so_many_connections_are_served_at_once() {
    let (_folder, studio) = studio();
    let waiting: Vec<TcpStream> = (0..64).map(|_| studio.stream()).collect();
    // Whoever comes too early finds the last of them not yet counted.
    let mut refused = String::new();
    while status(&refused) != "503" {
        refused = studio.get("/", "");
    }
    drop(waiting);
    while status(&refused) == "503" {
        refused = studio.get("/", "");
    }
    assert_eq!(status(&refused), "403");
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
