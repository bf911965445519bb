//! Controls access to the host.
//!
//! The page's files contain no secret and are served to any request for this host. A WebSocket
//! connection gives access to the scene's file, so it requires a token.
//!
//! Pages of other sites in the same browser can connect to the host, too. They are recognized by
//! two headers that a page cannot forge: `Origin` names the site of the page, and `Host` reveals a
//! site whose own name resolves to this machine (DNS rebinding).
//!
//! The browser never sends a token by itself: the token is in the fragment of the address, which
//! browsers do not send. Cookies are not used, since browsers would send them to all servers on the
//! machine.

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

/// Path in the host's address at which pages open a WebSocket.
pub const SOCKET: &str = "/socket";

/// Lifetime of the token in the address with which the host starts a browser. After this time, the
/// token is refused. Even on a slow machine, a browser starts within a minute. A longer time would
/// be less secure, because other users of the machine can read the address in the command line.
const LIFETIME: Duration = Duration::from_secs(60);

/// Decides whether a request to the host at `port` must be refused because of its address, origin
/// or method. The token is checked later, by [`Access::admit`]. Returns the HTTP status and the
/// reason, or `None` if the request is allowed.
pub fn refusal(
    port: u16,
    method: &Method,
    uri: &Uri,
    headers: &HeaderMap,
) -> Option<(StatusCode, &'static str)> {
    let host = only(headers, &HOST).unwrap_or_default();
    let origin = only(headers, &ORIGIN);
    let is_own = ["127.0.0.1", "localhost"].iter().any(|name| {
        // Browsers leave out the port 80, the default, in the header `Host`.
        host == format!("{name}:{port}") || (port == 80 && host == *name)
    });
    let forbidden = |why| Some((StatusCode::FORBIDDEN, why));
    if !is_own || uri.authority().is_some() {
        forbidden("This is not the address of this page.")
    } else if origin.is_some_and(|origin| origin != format!("http://{host}")) {
        forbidden("Another page asks for this.")
    } else if uri.path() == SOCKET && origin.is_none() {
        forbidden("A web socket says which page asks for it.")
    } else if method != Method::GET {
        Some((StatusCode::METHOD_NOT_ALLOWED, "Use GET."))
    } else {
        None
    }
}

/// Returns the value of a header; `None` if the header is missing. If it has several values, or a
/// value that is not a text, returns an empty text, which is never valid.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().unwrap_or_default();
    Some(if values.next().is_none() { value } else { "" })
}

/// The tokens of a host, and the pages that have used them.
#[derive(Debug)]
pub struct Access {
    /// Token in the address that is printed for the user. It admits any number of pages and never
    /// expires.
    printed: String,
    started: Mutex<Started>,
}

/// State of the browser that the host starts. The browser gets its token in a command line, which
/// all users of the machine can read.
#[derive(Debug)]
struct Started {
    /// Token in the command line. It can be used only once.
    once: String,
    /// Time until which the token in the command line is valid.
    until: Instant,
    /// Session of the page that has used the token in the command line; `None` before that.
    session: Option<Permission>,
}

/// Permission for a page to open WebSocket connections. It can be revoked.
#[derive(Clone, Debug)]
pub struct Permission {
    /// Token that the page sends when it connects again.
    pub token: String,
    is_over: Arc<AtomicBool>,
}

impl Permission {
    fn new(token: String) -> Self {
        Self {
            token,
            is_over: Arc::default(),
        }
    }

    /// Returns whether the permission is revoked and the connection must end. A permission that was
    /// given for the token in the command line is revoked if the token is sent a second time.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::SeqCst)
    }
}

/// Reason why a page is not admitted. Its number is the code with which the page's WebSocket is
/// closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAdmitted {
    /// The token does not belong to this host. It may belong to an earlier run.
    Unknown = 4001,
    /// The token in the command line was sent after its lifetime.
    Late = 4002,
    /// The token in the browser's command line was sent a second time. The page that sent the token
    /// first is then no longer admitted either, because one of the two pages may belong to another
    /// user.
    Twice = 4003,
}

impl Access {
    /// Makes the tokens of a host that starts now.
    ///
    /// # Errors
    ///
    /// Returns an error if the system's random number generator fails.
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

    /// Returns two tokens. The first is in the address that is printed for the user, the second in
    /// the address with which the host starts a browser.
    pub fn tokens(&self) -> [String; 2] {
        let started = lock(&self.started);
        [self.printed.clone(), started.once.clone()]
    }

    /// Admits a page that sends a token at the time `now`. If the token from the command line is
    /// sent a second time, refuses it and also ends the session of the first page.
    ///
    /// # Errors
    ///
    /// Returns the reason if the token is unknown, too late or used twice.
    pub fn admit(&self, token: &str, now: Instant) -> Result<Permission, NotAdmitted> {
        let mut started = lock(&self.started);
        if is_equal(token, &self.printed) {
            return Ok(Permission::new(self.printed.clone()));
        }
        if is_equal(token, &started.once) {
            return match &started.session {
                // The first page may belong to another user who has read the command line, so its
                // session ends, too.
                Some(session) => {
                    session.is_over.store(true, Ordering::SeqCst);
                    Err(NotAdmitted::Twice)
                }
                None if now > started.until => Err(NotAdmitted::Late),
                None => {
                    let token = secret().map_err(|_| NotAdmitted::Unknown)?;
                    Ok(started.session.insert(Permission::new(token)).clone())
                }
            };
        }
        match &started.session {
            Some(session) if is_equal(token, &session.token) => {
                if session.is_over() {
                    return Err(NotAdmitted::Twice);
                }
                Ok(session.clone())
            }
            _ => Err(NotAdmitted::Unknown),
        }
    }
}

/// Returns 128 random bits as hexadecimal digits.
///
/// # Errors
///
/// Returns an error if the system's random number generator fails.
pub fn secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bytes)))
}

/// Compares two texts in constant time, so that the time does not reveal where they differ.
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
        // A token that was sent in time cannot be used again. If it is sent a second time, both
        // pages are refused, since the first page may not be the user's.
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
        // The printed token is valid at any time, but only for its own host.
        assert!(late.admit(&printed, later(100_000)).is_ok());
        assert_eq!(
            used.admit(&printed, begin).err(),
            Some(NotAdmitted::Unknown)
        );
    }
}
