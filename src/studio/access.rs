//! Who may have what: the page's files and its web socket, for a browser that was shown the token, and nothing for anybody else.
//!
//! Other pages in the same browser can send requests here, but cannot set the headers that are looked at: `Host` (a name of theirs may lead to this machine),
//! `Origin`, and the cookie, which is sent with requests of this site alone. Other users of the machine do not know the token.

use std::{
    io,
    sync::{Mutex, MutexGuard, PoisonError},
};

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
    port: u16,
    /// In the address that is printed.
    token: String,
    /// In the address that a browser is started with, until it has come. Other users see command lines.
    token_once: Mutex<Option<String>>,
    /// In the cookie. The browser sends it to servers at other ports of this machine as well, so it must not be worth anything in an address.
    secret: String,
}

impl Access {
    /// Makes the secrets of the host at this port.
    ///
    /// # Errors
    ///
    /// The system has no randomness to give.
    pub fn new(port: u16) -> io::Result<Self> {
        Ok(Self {
            port,
            token: secret()?,
            token_once: Mutex::new(Some(secret()?)),
            secret: secret()?,
        })
    }

    /// The address that lets a browser in, and one that does so once.
    pub fn addresses(&self) -> [String; 2] {
        let once = self.once().clone().unwrap_or_default();
        let port = self.port;
        [&self.token, &once].map(|token| format!("http://127.0.0.1:{port}/?token={token}"))
    }

    fn once(&self) -> MutexGuard<'_, Option<String>> {
        self.token_once
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// What a request gets.
    pub fn answer(&self, request: &Request) -> Answer {
        let target = request.target.as_str();
        Answer::Response(if let Some(refusal) = self.refusal(request) {
            refusal
        } else if let Some(token) = target.strip_prefix("/?token=") {
            self.exchange(token)
        } else if !self.has_cookie(request) {
            forbidden("Open the address that `pinhole studio` has printed.")
        } else {
            match target {
                "/" => index(),
                "/studio.js" => Response::new("200 OK", "text/javascript", SCRIPT.to_vec()),
                "/studio.css" => Response::new("200 OK", "text/css", STYLE.to_vec()),
                "/socket" if request.header("origin").is_none() => {
                    forbidden("A web socket says which page asks for it.")
                }
                "/socket" => match socket_key(request) {
                    Some(key) => return Answer::Socket(key.to_owned()),
                    None => Response::text("426 Upgrade Required", "This is a web socket.")
                        .with("Upgrade", "websocket")
                        .with("Sec-WebSocket-Version", "13"),
                },
                _ => Response::text("404 Not Found", "There is no such page."),
            }
        })
    }

    /// Why a request is refused whoever sends it: it is not for this host, not from its page, or not for reading.
    fn refusal(&self, request: &Request) -> Option<Response> {
        let host = request.header("host").unwrap_or_default();
        let is_own = ["127.0.0.1", "localhost"].iter().any(|name| {
            // Browsers leave the usual port out.
            host == format!("{name}:{}", self.port) || (self.port == 80 && host == *name)
        });
        let origin = request.header("origin");
        if !is_own {
            Some(forbidden("This is not the address of this page."))
        } else if origin.is_some_and(|origin| origin != format!("http://{host}")) {
            Some(forbidden("Another page asks for this."))
        } else if request.method != "GET" {
            let refusal = Response::text("405 Method Not Allowed", "Use GET.");
            Some(refusal.with("Allow", "GET"))
        } else {
            None
        }
    }

    /// The cookie for a token.
    fn exchange(&self, token: &str) -> Response {
        let mut once = self.once();
        let is_first = once.as_ref().is_some_and(|once| is_equal(token, once));
        if is_first {
            *once = None;
        }
        if !is_first && !is_equal(token, &self.token) {
            return forbidden(
                "This address is from an earlier run, used already, or incomplete. Open the one that `pinhole studio` has printed.",
            );
        }
        let (name, secret) = (self.cookie(), &self.secret);
        let cookie = format!("{name}={secret}; Path=/; HttpOnly; SameSite=Strict");
        // The address is left for one without the token, so that it is not shown, copied or kept in the history.
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
        pairs.any(|(known, value)| known == name && is_equal(value, &self.secret))
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

fn forbidden(what: &str) -> Response {
    Response::text("403 Forbidden", what)
}

/// The key of a request for a web socket, if it is one.
fn socket_key(request: &Request) -> Option<&str> {
    let is = |name, wanted: &str| {
        let mut words = request.header(name).unwrap_or_default().split(',');
        words.any(|word| word.trim().eq_ignore_ascii_case(wanted))
    };
    let is_socket = is("upgrade", "websocket")
        && is("connection", "upgrade")
        && is("sec-websocket-version", "13");
    let key = request.header("sec-websocket-key");
    key.filter(|key| is_socket && !key.is_empty())
}
