//! Who may do what.
//!
//! The page's files hold no secret, and whoever asks this host for them gets them. A conversation,
//! and with it the scene's file, is for pages that show a token. Other pages in the same browser
//! can connect as well, but they cannot set the headers that are looked at: `Host` (a name of
//! theirs may lead to this machine) and `Origin`. A token is never a part of what a browser sends
//! by itself: cookies go to all servers of a machine, so there is none, and the part of an address
//! that the token stands in stays in the browser.

use std::{
    io,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use axum::http::{
    HeaderMap, Method, StatusCode, Uri,
    header::{HOST, HeaderName, ORIGIN},
};
use subtle::ConstantTimeEq as _;

/// Path of the web socket.
pub const SOCKET: &str = "/socket";

/// Lifetime of the token that a browser is started with: a slow machine starts one in this time.
const LIFETIME: Duration = Duration::from_secs(60);

/// Returns why a request to the host at this port is refused, whoever sends it.
pub fn refusal(
    port: u16,
    method: &Method,
    uri: &Uri,
    headers: &HeaderMap,
) -> Option<(StatusCode, &'static str)> {
    let host = only(headers, &HOST).unwrap_or_default();
    let origin = only(headers, &ORIGIN);
    let is_own = ["127.0.0.1", "localhost"].iter().any(|name| {
        // Browsers leave the usual port out.
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

/// Returns the value of a header; an empty one, which is never right, if there are several or it is
/// no text.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().unwrap_or_default();
    Some(if values.next().is_none() { value } else { "" })
}

/// The tokens of a host.
#[derive(Debug)]
pub struct Access {
    /// In the address that is printed. It lets in any number of pages.
    printed: String,
    started: Mutex<Started>,
}

/// The session of the browser that the host starts. Its first token stands in a command line, which
/// all users can read.
#[derive(Debug)]
struct Started {
    /// In the command line. It serves once.
    once: String,
    /// When it stops to serve.
    until: Instant,
    /// What the page that has shown it is given in its place.
    session: Option<Session>,
}

#[derive(Debug)]
struct Session {
    token: String,
    is_over: Arc<AtomicBool>,
}

/// The right to a conversation.
#[derive(Debug)]
pub struct Pass {
    /// What the page shows when it connects again.
    pub token: String,
    is_over: Arc<AtomicBool>,
}

impl Pass {
    /// Whether the conversation has to end, because the address it began with was used twice.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::SeqCst)
    }
}

/// Why a page gets no conversation. The web socket is closed with a code that says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAdmitted {
    /// The token is not one of this host: it is that of an earlier run, or none.
    Unknown = 4001,
    /// The address that a browser was started with comes too late.
    Late = 4002,
    /// The address that a browser was started with was used twice.
    Twice = 4003,
}

impl Access {
    /// Makes the tokens of a host that starts now.
    ///
    /// # Errors
    ///
    /// The system has no randomness to give.
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

    /// The token of the printed address, and that of the address that a browser is started with.
    pub fn tokens(&self) -> [String; 2] {
        let started = self.started.lock().unwrap_or_else(PoisonError::into_inner);
        [self.printed.clone(), started.once.clone()]
    }

    /// Admits whoever shows a right token at this time.
    ///
    /// # Errors
    ///
    /// Why the token is not, or no longer, right.
    pub fn admit(&self, token: &str, now: Instant) -> Result<Pass, NotAdmitted> {
        let mut started = self.started.lock().unwrap_or_else(PoisonError::into_inner);
        if is_equal(token, &self.printed) {
            return Ok(Pass {
                token: self.printed.clone(),
                is_over: Arc::default(),
            });
        }
        if is_equal(token, &started.once) {
            return match &started.session {
                // Whoever was first may be somebody who has read the command line.
                Some(session) => {
                    session.is_over.store(true, Ordering::SeqCst);
                    Err(NotAdmitted::Twice)
                }
                None if now > started.until => Err(NotAdmitted::Late),
                None => {
                    let token = secret().map_err(|_| NotAdmitted::Unknown)?;
                    let session = started.session.insert(Session {
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

impl Session {
    fn pass(&self) -> Pass {
        Pass {
            token: self.token.clone(),
            is_over: Arc::clone(&self.is_over),
        }
    }
}

/// Makes 128 random bits, as hexadecimal digits.
///
/// # Errors
///
/// The system has no randomness to give.
pub fn secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bytes)))
}

/// Compares in a time that does not tell where two texts differ.
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
        // One that came in time is used up, whenever it is shown again: whoever was first may not
        // be the user.
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
        // The printed one always serves, here alone.
        assert!(late.admit(&printed, later(100_000)).is_ok());
        assert_eq!(
            used.admit(&printed, begin).err(),
            Some(NotAdmitted::Unknown)
        );
    }
}
