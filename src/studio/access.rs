//! Who may have what: the page's files and its web socket, for a browser that was shown the token, and nothing for anybody else.
//!
//! Other pages in the same browser can send requests here, but cannot set the headers that are looked at: `Host` (a name of theirs may lead to this machine),
//! `Origin`, and the cookie, which is sent with requests of this site alone. Other users of the machine do not know the token.

use std::io;

use super::http::{Request, Response};

/// What a request is allowed.
#[derive(Debug)]
pub enum Answer {
    /// This, and no more.
    Response(Response),
    /// A web socket with this key.
    Socket(String),
}

/// The page's files.
const INDEX: &str = include_str!("../../studio/page/dist/index.html");
const SCRIPT: &[u8] = include_bytes!("../../studio/page/dist/studio.js");
const STYLE: &[u8] = include_bytes!("../../studio/page/dist/studio.css");

/// What a browser has to know.
#[derive(Debug)]
pub struct Access {
    token: String,
    port: u16,
}

impl Access {
    /// Makes a token for the host at this port.
    ///
    /// # Errors
    ///
    /// The system has no randomness to give.
    pub fn new(port: u16) -> io::Result<Self> {
        let token = secret()?;
        Ok(Self { token, port })
    }

    /// The address that lets a browser in.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    /// What a request gets.
    pub fn answer(&self, request: &Request) -> Answer {
        self.socket(request).unwrap_or_else(Answer::Response)
    }

    /// The key of a web socket; an error is any other response.
    fn socket(&self, request: &Request) -> Result<Answer, Response> {
        let forbidden = |what: &str| Err(Response::text("403 Forbidden", what));
        let host = request.header("host").unwrap_or_default();
        let own = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        if !own.iter().any(|own| own == host) {
            return forbidden("This is not the address of this page.");
        }
        let origin = request.header("origin");
        let is_own = origin == Some(&format!("http://{host}"));
        if request.has("origin") && !is_own {
            return forbidden("Another page asks for this.");
        }
        if request.method != "GET" {
            let refused = Response::text("405 Method Not Allowed", "Use GET.");
            return Err(refused.with("Allow", "GET"));
        }
        if let Some(token) = request.target.strip_prefix("/?token=") {
            return match is_equal(token, &self.token) {
                true => Err(self.admission()),
                false => forbidden("This address is from an earlier run, or incomplete."),
            };
        }
        if !self.has_cookie(request) {
            return forbidden("Open the address that `pinhole studio` has printed.");
        }
        match request.target.as_str() {
            "/" => Err(index()),
            "/studio.js" => Err(Response::new("200 OK", "text/javascript", SCRIPT.to_vec())),
            "/studio.css" => Err(Response::new("200 OK", "text/css", STYLE.to_vec())),
            "/socket" if !is_own => forbidden("A web socket says which page asks for it."),
            "/socket" => key(request).map(Answer::Socket),
            _ => Err(Response::text("404 Not Found", "There is no such page.")),
        }
    }

    /// The address is left for one without the token, so that it is not shown, copied or kept in the history.
    fn admission(&self) -> Response {
        let (name, token) = (self.cookie(), &self.token);
        let cookie = format!("{name}={token}; Path=/; HttpOnly; SameSite=Strict");
        Response::text("303 See Other", "This way.")
            .with("Location", "/")
            .with("Set-Cookie", cookie)
    }

    /// The cookie's name: browsers keep those of all ports together.
    fn cookie(&self) -> String {
        format!("pinhole-{}", self.port)
    }

    fn has_cookie(&self, request: &Request) -> bool {
        let name = self.cookie();
        let cookies = request.header("cookie").unwrap_or_default().split(';');
        let mut pairs = cookies.filter_map(|cookie| cookie.trim().split_once('='));
        pairs.any(|(known, value)| known == name && is_equal(value, &self.token))
    }
}

/// 128 random bits as hexadecimal digits.
fn secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bytes)))
}

/// Compares in a time that does not tell where two texts differ.
fn is_equal(a: &str, b: &str) -> bool {
    let pairs = a.bytes().zip(b.bytes());
    a.len() == b.len() && pairs.fold(0, |different, (a, b)| different | (a ^ b)) == 0
}

/// The page. Its styles have a nonce, since the editor makes some of them while it runs.
fn index() -> Response {
    let Ok(nonce) = secret() else {
        return Response::text("500 Internal Server Error", "There is no randomness.");
    };
    let policy = format!(
        "default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{nonce}'; img-src 'self' blob: data:; connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    let page = INDEX.replace("__NONCE__", &nonce).into_bytes();
    Response::new("200 OK", "text/html; charset=utf-8", page)
        .with("Content-Security-Policy", policy)
}

fn key(request: &Request) -> Result<String, Response> {
    let is = |name, wanted: &str| {
        let words = request.header(name).unwrap_or_default().split(',');
        words
            .map(str::trim)
            .any(|word| word.eq_ignore_ascii_case(wanted))
    };
    let key = request.header("sec-websocket-key");
    let is_socket = is("upgrade", "websocket")
        && is("connection", "upgrade")
        && is("sec-websocket-version", "13");
    match key {
        Some(key) if is_socket => Ok(key.to_owned()),
        _ => {
            let refused = Response::text("426 Upgrade Required", "This is a web socket.");
            Err(refused
                .with("Upgrade", "websocket")
                .with("Sec-WebSocket-Version", "13"))
        }
    }
}
