//! Runs the language server on standard input and output, as editors start it.
//!
//! A separate thread reads the input, so that the server handles all messages that have arrived
//! before it works on an answer. Thus it never computes an answer to a request that is already
//! cancelled, or diagnostics for a text that is already changed. The crate lsp-server is not used
//! for reading: it allocates as much memory as a message's header announces, and it stops at the
//! first malformed message.

use std::{
    io::{self, BufRead, BufReader, Read, Write},
    sync::mpsc::{self, Receiver, Sender},
    thread,
};

use lsp_server::Message;
use serde_json::Value;

use super::{
    messages::{self, Malformed},
    server::Server,
};

/// Message from the client, or the error response to a malformed message.
type Incoming = Result<Message, Value>;

/// Runs a server until the client sends `exit` or the input ends. Returns whether the connection
/// ended properly, by `exit` after `shutdown`.
///
/// # Errors
///
/// Returns an error if writing to the output fails.
pub fn serve(
    mut server: Server,
    input: impl Read + Send + 'static,
    output: &mut dyn Write,
    log: fn(&str),
) -> io::Result<bool> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || read(input, &sender, log));
    while let Some(incoming) = next_message(&receiver, &mut server, output)? {
        match incoming {
            Ok(message) => send(output, server.handle(message))?,
            Err(response) => {
                let response = response.to_string();
                write!(
                    output,
                    "Content-Length: {}\r\n\r\n{response}",
                    response.len()
                )?;
                output.flush()?;
            }
        }
        if let Some(properly) = server.ended() {
            return Ok(properly);
        }
    }
    Ok(false)
}

/// Returns the next message, and waits for it if necessary. Until it arrives, the server works on
/// earlier requests, and the resulting messages are sent. Returns `None` if the input has ended and
/// no work is left.
fn next_message(
    messages: &Receiver<Incoming>,
    server: &mut Server,
    output: &mut dyn Write,
) -> io::Result<Option<Incoming>> {
    while server.is_busy() {
        if let Ok(message) = messages.try_recv() {
            return Ok(Some(message));
        }
        send(output, server.advance())?;
    }
    Ok(messages.recv().ok())
}

fn send(output: &mut dyn Write, messages: Vec<Message>) -> io::Result<()> {
    messages
        .into_iter()
        .try_for_each(|message| message.write(&mut &mut *output))
}

fn read(input: impl Read, sender: &Sender<Incoming>, log: fn(&str)) {
    let mut input = BufReader::new(input);
    loop {
        match next(&mut input) {
            Ok(Some(message)) => {
                let is_exit =
                    matches!(&message, Ok(Message::Notification(n)) if n.method == "exit");
                // After `exit`, the client sends no further messages, so the thread ends.
                if sender.send(message).is_err() || is_exit {
                    return;
                }
            }
            Ok(None) => return,
            Err(Failed::Once(what)) => log(&what),
            Err(Failed::ForGood(what)) => {
                log(&what);
                return;
            }
        }
    }
}

/// Maximum length of a message from the client, in bytes: 1 GiB. If a header announces a longer
/// message, the header is assumed to be wrong, and reading ends, because the start of the next
/// message is unknown. Texts of scenes are far shorter.
const LONGEST: u64 = 1 << 30;

/// Maximum length of a header line, in bytes. Without a limit, a line that never ends could exhaust
/// the memory. Usual lines have about thirty bytes.
const LONGEST_HEADER: u64 = 4096;

/// Reason why a message could not be read.
enum Failed {
    /// The message is invalid, but the next one may be valid.
    Once(String),
    /// No further message can be read.
    ForGood(String),
}

impl From<io::Error> for Failed {
    fn from(error: io::Error) -> Self {
        Self::ForGood(error.to_string())
    }
}

/// Reads the next message. Returns `None` at the end of the input.
fn next(input: &mut impl BufRead) -> Result<Option<Incoming>, Failed> {
    let Some(length) = length(input)? else {
        return Ok(None);
    };
    // Memory is allocated for the bytes that arrive, not for the announced length.
    let mut content = Vec::new();
    let read = input.by_ref().take(length).read_to_end(&mut content)?;
    if (read as u64) < length {
        let what = format!("the input ends after {read} of {length} bytes of a message");
        return Err(Failed::ForGood(what));
    }
    match messages::read(&content) {
        Ok(message) => Ok(Some(Ok(message))),
        Err(Malformed::Answered(response)) => Ok(Some(Err(response))),
        Err(Malformed::Unanswered(what)) => Err(Failed::Once(what)),
    }
}

/// Reads the header of a message. Returns the length of the message in bytes, as stated in the
/// header, or `None` at the end of the input.
fn length(input: &mut impl BufRead) -> Result<Option<u64>, Failed> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        let mut header = input.by_ref().take(LONGEST_HEADER);
        if header.read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let malformed = || Failed::Once(format!("malformed header: {line:?}"));
        let field = line.strip_suffix("\r\n").ok_or_else(malformed)?;
        if field.is_empty() {
            break;
        }
        let (name, value) = field.split_once(": ").ok_or_else(malformed)?;
        if name.eq_ignore_ascii_case("Content-Length") {
            length = Some(value.parse().map_err(|_| malformed())?);
        }
    }
    match length {
        None => Err(Failed::Once("no Content-Length".to_owned())),
        Some(length) if length > LONGEST => Err(Failed::ForGood(format!(
            "a message of {length} bytes is announced, and at most {LONGEST} can be read"
        ))),
        Some(length) => Ok(Some(length)),
    }
}
