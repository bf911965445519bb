//! The little of HTTP that serves a page: a request's head is read, a response is written, and the connection ends.

use std::{
    io::{self, Read, Write},
    net::{Shutdown, TcpStream},
    time::{Duration, Instant},
};

/// A head has at most so many bytes: those of browsers have about one KiB, unless other programs on this machine have set many cookies. And
const LONGEST_HEAD: usize = 16 << 10;

/// so many lines, of which browsers send some 20,
const MOST_HEADERS: usize = 64;

/// and comes within this time. On one machine it comes at once; browsers also open connections that they may need later, and these shall not be kept for long.
const HEAD_TIMEOUT: Duration = Duration::from_secs(5);

/// So long a connection is kept after the response, for the other end to take it: more than a machine needs for it.
const FAREWELL: Duration = Duration::from_millis(200);

/// What a browser asks for.
#[derive(Debug, Default)]
pub struct Request {
    /// The method, `GET` as a rule.
    pub method: String,
    /// The target: a path, with a query or without.
    pub target: String,
    headers: Vec<(String, String)>,
    /// What came behind the head.
    pub rest: Vec<u8>,
}

impl Request {
    /// Reads a request's head; none where there is no right one in time.
    pub fn read(stream: &mut TcpStream) -> Option<Self> {
        let end = Instant::now() + HEAD_TIMEOUT;
        let mut head = Vec::new();
        let mut piece = [0; 4096];
        loop {
            let read = read_before(stream, &mut piece, end);
            let length = read.ok().filter(|length| *length > 0)?;
            head.extend_from_slice(&piece[..length]);
            if head.len() > LONGEST_HEAD {
                return None;
            }
            if let Some(request) = Self::parse(&head).ok()? {
                return Some(request);
            }
        }
    }

    /// The request that these bytes begin with; none while its head is not complete.
    fn parse(bytes: &[u8]) -> Result<Option<Self>, httparse::Error> {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut parsed = httparse::Request::new(&mut headers);
        let httparse::Status::Complete(length) = parsed.parse(bytes)? else {
            return Ok(None);
        };
        let headers = parsed.headers.iter();
        let headers = headers.map(|header| {
            let value = String::from_utf8_lossy(header.value).into_owned();
            (header.name.to_ascii_lowercase(), value)
        });
        Ok(Some(Self {
            method: parsed.method.unwrap_or_default().to_owned(),
            target: parsed.path.unwrap_or_default().to_owned(),
            headers: headers.collect(),
            rest: bytes[length..].to_vec(),
        }))
    }

    /// A header by its name in small letters; of several nothing that would be right.
    pub fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(known, _)| known == name);
        let (_, value) = found.next()?;
        Some(if found.next().is_none() { value } else { "" })
    }
}

/// What a browser gets.
#[derive(Debug)]
pub struct Response {
    status: &'static str,
    headers: Vec<(&'static str, String)>,
    body: Vec<u8>,
}

impl Response {
    /// A text, which is given out as such.
    pub fn text(status: &'static str, text: &str) -> Self {
        let body = format!("{text}\n").into_bytes();
        Self::new(status, "text/plain; charset=utf-8", body)
    }

    /// A file of this type.
    pub fn new(status: &'static str, kind: &str, body: Vec<u8>) -> Self {
        let headers = vec![("Content-Type", kind.to_owned())];
        Self {
            status,
            headers,
            body,
        }
    }

    /// The same with a header more.
    pub fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.headers.push((name, value.into()));
        self
    }

    /// Writes the response, and ends the connection.
    pub fn end(self, mut stream: TcpStream) -> io::Result<()> {
        let mut bytes = format!("HTTP/1.1 {}\r\n", self.status).into_bytes();
        for (name, value) in &self.headers {
            write!(bytes, "{name}: {value}\r\n")?;
        }
        // Nothing is kept, guessed, or told to others.
        write!(
            bytes,
            "Content-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\r\n",
            self.body.len()
        )?;
        bytes.extend(self.body);
        stream.write_all(&bytes)?;
        stream.shutdown(Shutdown::Write)?;
        // What was sent and not read would tear the connection down before the response has arrived.
        let end = Instant::now() + FAREWELL;
        let mut rest = [0; 4096];
        while read_before(&mut stream, &mut rest, end)? > 0 {}
        Ok(())
    }
}

/// Reads what comes before a certain time; nothing behind the end.
fn read_before(stream: &mut TcpStream, bytes: &mut [u8], end: Instant) -> io::Result<usize> {
    let left = end.saturating_duration_since(Instant::now());
    // A timeout of zero would be none.
    if left.is_zero() {
        return Err(io::ErrorKind::TimedOut.into());
    }
    stream.set_read_timeout(Some(left))?;
    stream.read(bytes)
}

/// Accepts to go on as a web socket, as RFC 6455 wants it.
pub fn accept_socket(stream: &mut TcpStream, key: &str) -> io::Result<()> {
    use base64::{Engine as _, engine::general_purpose::STANDARD};
    let hash = sha1_smol::Sha1::from(format!("{key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
    let accept = STANDARD.encode(hash.digest().bytes());
    let head = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}\r\n\r\n"
    );
    stream.write_all(head.as_bytes())
}
