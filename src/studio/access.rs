//! Access control of the host.
//!
//! The page's files hold no secret, and are served to any request for this host. A conversation,
//! and with it the scene's file, is only for pages that show a token. Other pages in the same
//! browser can connect as well, but cannot forge the headers that are checked: `Host` (a foreign
//! name may resolve to this machine) and `Origin`. A browser never sends a token by itself: there
//! are no cookies, which go to all servers of a machine, and the token is in the fragment of the
//! address, which stays in the browser.

use std::{
    io,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use axum::http::{
    HeaderMap, Method, StatusCode, Uri,
    header::{HOST, HeaderName, ORIGIN},
};
use subtle::ConstantTimeEq as _;

use crate::lock::lock;

/// Path of the web socket.
pub const SOCKET: &str = "/socket";

/// Lifetime of the token that a browser is started with: even a slow machine starts one in this
/// time.
const LIFETIME: Duration = Duration::from_secs(60);

/// Returns why a request to the host at this port is refused, with or without a token; `None` if it
/// is not.
pub fn refusal(
    port: u16,
    method: &Method,
    uri: &Uri,
    headers: &HeaderMap,
) -> Option<(StatusCode, &'static str)> {
    let host = only(headers, &HOST).unwrap_or_default();
    let origin = only(headers, &ORIGIN);
    let is_own = ["127.0.0.1", "localhost"].iter().any(|name| {
        // Browsers leave out the default port.
        host == format!("{name}:{port}") || (port == 80 && host == *name)
    });
    if !is_own || uri.authority().is_some() {
        Some((
            StatusCode::FORBIDDEN,
            "This is not the address of this page.",
        ))
    } else if origin.is_some_and(|origin| origin != format!("http://{host}")) {
        Some((StatusCode::FORBIDDEN, "Another page asks for this."))
    } else if uri.path() == SOCKET && origin.is_none() {
        Some((
            StatusCode::FORBIDDEN,
            "A web socket says which page asks for it.",
        ))
    } else if method != Method::GET {
        Some((StatusCode::METHOD_NOT_ALLOWED, "Use GET."))
    } else {
        None
    }
}

/// Returns the value of a header; an empty one, which is never valid, if there are several or it is
/// not a text.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().unwrap_or_default();
    Some(if values.next().is_none() { value } else { "" })
}

/// The tokens of a host.
#[derive(Debug)]
pub struct Access {
    /// Token in the printed address. It admits any number of pages.
    printed: String,
    started: Mutex<Started>,
}

/// The browser that the host starts. Its first token is in a command line, which all users can
/// read.
#[derive(Debug)]
struct Started {
    /// Token in the command line. It is valid once.
    once: String,
    /// Time until which the token in the command line is valid.
    until: Instant,
    /// Session of the page that has shown the token.
    session: Option<BrowserSession>,
}

#[derive(Debug)]
struct BrowserSession {
    token: String,
    is_over: Arc<AtomicBool>,
}

/// Permission for a conversation.
#[derive(Debug)]
pub struct Pass {
    /// Token that the page shows when it connects again.
    pub token: String,
    is_over: Arc<AtomicBool>,
}

impl Pass {
    /// Whether the conversation has to end, because the address that it began with was used twice.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::SeqCst)
    }
}

/// Reason why a page is not admitted, with the code that the web socket is closed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAdmitted {
    /// The token is not one of this host; it may be of an earlier run.
    Unknown = 4001,
    /// The address that a browser was started with was used too late.
    Late = 4002,
    /// The address that a browser was started with was used twice.
    Twice = 4003,
}

impl Access {
    /// Makes the tokens of a host that starts now.
    ///
    /// # Errors
    ///
    /// The system's random number generator fails.
    pub fn new() -> io::Result<Self> {
        Ok(Self {
            printed: secret()?,
            started: Mutex::new(Started {
                once: secret()?,
                until: Instant::now() + LIFETIME,
                session: None,
            }),
        })
    }

    /// Returns the token of the printed address, and that of the address that a browser is started
    /// with.
    pub fn tokens(&self) -> [String; 2] {
        let started = lock(&self.started);
        [self.printed.clone(), started.once.clone()]
    }

    /// Admits a page that shows a valid token at this time.
    ///
    /// # Errors
    ///
    /// The token is not, or no longer, valid.
    pub fn admit(&self, token: &str, now: Instant) -> Result<Pass, NotAdmitted> {
        let mut started = lock(&self.started);
        if is_equal(token, &self.printed) {
            return Ok(Pass {
                token: self.printed.clone(),
                is_over: Arc::default(),
            });
        }
        if is_equal(token, &started.once) {
            return match &started.session {
                // The first page may belong to somebody who has read the command line.
                Some(session) => {
                    session.is_over.store(true, Ordering::SeqCst);
                    Err(NotAdmitted::Twice)
                }
                None if now > started.until => Err(NotAdmitted::Late),
                None => {
                    let token = secret().map_err(|_| NotAdmitted::Unknown)?;
                    let session = started.session.insert(BrowserSession {
                        token,
                        is_over: Arc::default(),
                    });
                    Ok(session.pass())
                }
            };
        }
        match &started.session {
            Some(session) if is_equal(token, &session.token) => {
                if session.is_over.load(Ordering::SeqCst) {
                    return Err(NotAdmitted::Twice);
                }
                Ok(session.pass())
            }
            _ => Err(NotAdmitted::Unknown),
        }
    }
}

impl BrowserSession {
    fn pass(&self) -> Pass {
        Pass {
            token: self.token.clone(),
            is_over: Arc::clone(&self.is_over),
        }
    }
}

/// Returns 128 random bits, as hexadecimal digits.
///
/// # Errors
///
/// The system's random number generator fails.
pub fn secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bytes)))
}

/// Compares two texts in constant time, which does not reveal where they differ.
fn is_equal(a: &str, b: &str) -> bool {
    a.as_bytes().ct_eq(b.as_bytes()).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_address_that_a_browser_is_started_with_serves_once_and_for_a_minute() {
        let begin = Instant::now();
        let later = |seconds| begin + Duration::from_secs(seconds);
        let late = Access::new().unwrap();
        let [printed, once] = late.tokens();
        assert_eq!(late.admit(&once, later(70)).err(), Some(NotAdmitted::Late));
        // A token that came in time is used up, whenever it is shown again: the first page may not
        // be the user's.
        let used = Access::new().unwrap();
        let [_, once] = used.tokens();
        let first = used.admit(&once, later(50)).unwrap();
        assert!(first.token != once && !first.is_over());
        let again = used.admit(&first.token, later(1000)).unwrap();
        assert_eq!(again.token, first.token);
        assert_eq!(
            used.admit(&once, later(900)).err(),
            Some(NotAdmitted::Twice)
        );
        assert!(first.is_over() && again.is_over());
        for token in [&once, &first.token] {
            assert_eq!(used.admit(token, begin).err(), Some(NotAdmitted::Twice));
        }
        // The printed token is always valid, but only for its host.
        assert!(late.admit(&printed, later(100_000)).is_ok());
        assert_eq!(
            used.admit(&printed, begin).err(),
            Some(NotAdmitted::Unknown)
        );
    }
}
