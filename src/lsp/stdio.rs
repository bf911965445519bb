//! The server on standard input and output, as editors start it.
//!
//! A thread of its own does nothing but read, so that all that has come is taken in before the next
//! piece of work: what was cancelled in the meantime is not computed, and of several states of a
//! text only the last is judged. Messages are read here rather than by lsp-server, which takes any
//! length that is announced and ends at the first message that is none.

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

/// A message, or the response to something that came in its place.
type Incoming = Result<Message, Value>;

/// Has a server talk to a client until it ends. Says whether it ended properly: by `exit` after
/// `shutdown`.
///
/// # Errors
///
/// The output cannot be written to.
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
            Ok(message) => say(output, server.handle(message))?,
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

/// The next message, as soon as there is one; the server works while it waits. None if no more will
/// come, and all is done.
fn next_message(
    messages: &Receiver<Incoming>,
    server: &mut Server,
    output: &mut dyn Write,
) -> io::Result<Option<Incoming>> {
    while server.is_busy() {
        if let Ok(message) = messages.try_recv() {
            return Ok(Some(message));
        }
        say(output, server.advance())?;
    }
    Ok(messages.recv().ok())
}

fn say(output: &mut dyn Write, messages: Vec<Message>) -> io::Result<()> {
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
                // Behind `exit` nobody listens any more.
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

/// The longest message, in bytes. What announces more has lost its way, and what would follow it is
/// anybody's guess.
const LONGEST: u64 = 1 << 30;

/// The longest line of a header; those that are known take some thirty bytes.
const LONGEST_HEADER: u64 = 4096;

/// Why nothing was read.
enum Failed {
    /// The next message may be a right one.
    Once(String),
    /// Nothing can be read any more.
    ForGood(String),
}

impl From<io::Error> for Failed {
    fn from(error: io::Error) -> Self {
        Self::ForGood(error.to_string())
    }
}

/// The next message; none behind the last one.
fn next(input: &mut impl BufRead) -> Result<Option<Incoming>, Failed> {
    let Some(length) = length(input)? else {
        return Ok(None);
    };
    // Memory is taken for what has come, not for what was announced.
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

/// The length that a header announces; none at the end of the input.
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
