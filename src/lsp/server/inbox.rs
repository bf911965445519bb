//! The messages that have come.
//!
//! A thread of its own does nothing but read, so that the loop sees all that waits before it answers the first: what was
//! cancelled in the meantime is not computed.

use std::{
    collections::{HashSet, VecDeque},
    io::{BufReader, ErrorKind, Read},
    sync::mpsc::{self, Receiver, Sender},
    thread,
};

use lsp_server::{Message, Request, RequestId};

/// The messages that have come and are not taken yet.
pub struct Inbox {
    messages: Receiver<Message>,
    waiting: VecDeque<Message>,
    /// The requests that waiting messages cancel.
    cancelled: HashSet<RequestId>,
}

impl Inbox {
    /// Reads messages as they come. What is none is said to `log`.
    pub fn read(input: impl Read + Send + 'static, log: fn(&str)) -> Self {
        let (sender, receiver) = mpsc::channel();
        thread::spawn(move || read(input, &sender, log));
        Self::new(receiver)
    }

    /// Takes messages from a channel.
    pub fn new(messages: Receiver<Message>) -> Self {
        Self {
            messages,
            waiting: VecDeque::new(),
            cancelled: HashSet::new(),
        }
    }

    /// Whether no message waits.
    pub fn is_empty(&mut self) -> bool {
        self.gather();
        self.waiting.is_empty()
    }

    /// Whether a message that waits cancels a request.
    pub fn is_cancelled(&mut self, id: &RequestId) -> bool {
        self.gather();
        self.cancelled.contains(id)
    }

    /// The next message, as soon as there is one; none if no more will come.
    pub fn next(&mut self) -> Option<Message> {
        self.wait();
        let message = self.waiting.pop_front()?;
        if let Some(id) = cancelled(&message) {
            self.cancelled.remove(&id);
        }
        Some(message)
    }

    /// The next message, if it is such a request.
    pub fn next_if(&mut self, wanted: impl FnOnce(&Request) -> bool) -> Option<Request> {
        self.wait();
        match self.waiting.pop_front()? {
            Message::Request(request) if wanted(&request) => Some(request),
            other => {
                self.waiting.push_front(other);
                None
            }
        }
    }

    /// Waits until there is a message, or there will be none.
    fn wait(&mut self) {
        if self.is_empty()
            && let Ok(message) = self.messages.recv()
        {
            self.push(message);
        }
    }

    fn gather(&mut self) {
        while let Ok(message) = self.messages.try_recv() {
            self.push(message);
        }
    }

    fn push(&mut self, message: Message) {
        self.cancelled.extend(cancelled(&message));
        self.waiting.push_back(message);
    }
}

/// The request that a message cancels.
fn cancelled(message: &Message) -> Option<RequestId> {
    match message {
        Message::Notification(notification) if notification.method == "$/cancelRequest" => {
            serde_json::from_value(notification.params.get("id")?.clone()).ok()
        }
        _ => None,
    }
}

fn read(input: impl Read, sender: &Sender<Message>, log: fn(&str)) {
    let mut input = BufReader::new(input);
    loop {
        match Message::read(&mut input) {
            Ok(Some(message)) => {
                let is_exit = matches!(&message, Message::Notification(n) if n.method == "exit");
                // Behind `exit` nobody listens any more.
                if sender.send(message).is_err() || is_exit {
                    return;
                }
            }
            Ok(None) => return,
            // The next message may be a right one.
            Err(error) if error.kind() == ErrorKind::InvalidData => log(&error.to_string()),
            Err(error) => {
                log(&error.to_string());
                return;
            }
        }
    }
}
