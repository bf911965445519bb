//! The running program `pinhole studio`, and a simple client that sends what a browser would send.

use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    process::{Child, Command, Stdio},
};

use pinhole::scene::SMALLEST;
use serde_json::Value;
use tungstenite::{
    Message, WebSocket,
    client::{IntoClientRequest, client},
    protocol::frame::coding::CloseCode,
};

use crate::{
    lsp::client::{Client, PATIENCE, Transport},
    program::Folder,
};

/// Starts `pinhole studio` in a new folder, with the smallest scene in `a.scn`.
pub fn studio() -> (Folder, Studio) {
    let folder = Folder::with([("a.scn", SMALLEST)]);
    let studio = Studio::start(folder.command("studio --no-open a.scn"));
    (folder, studio)
}

/// A running `pinhole studio` that serves a scene.
pub struct Studio {
    pub child: Child,
    pub port: u16,
    /// Token in the address that the program has printed.
    pub token: String,
}

impl Studio {
    pub fn start(mut command: Command) -> Self {
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines.find_map(|line| {
            let line = line.unwrap();
            let (port, token) = line
                .strip_prefix("http://127.0.0.1:")?
                .split_once("/#token=")?;
            Some((port.parse().unwrap(), token.to_owned()))
        });
        let (port, token) = address.expect("it prints an address");
        Self { child, port, token }
    }

    pub fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    pub fn stream(&self) -> TcpStream {
        let stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_write_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// Sends an HTTP request over a new connection, and returns the response.
    pub fn response(&self, request: &str) -> String {
        let mut stream = self.stream();
        stream.write_all(request.as_bytes()).unwrap();
        let mut response = String::new();
        stream.read_to_string(&mut response).unwrap();
        response
    }

    /// Sends a GET request for the path `path`, with the header lines `headers`. Returns the
    /// response.
    pub fn get(&self, path: &str, headers: &str) -> String {
        let host = self.host();
        self.response(&format!(
            "GET {path} HTTP/1.1\r\nHost: {host}\r\n{headers}\r\n"
        ))
    }

    /// Opens a WebSocket and sends nothing over it, not even the token.
    pub fn socket(&self) -> WebSocket<TcpStream> {
        let host = self.host();
        let mut request = format!("ws://{host}/socket").into_client_request().unwrap();
        let origin = format!("http://{host}").parse().unwrap();
        request.headers_mut().insert("Origin", origin);
        client(request, self.stream()).unwrap().0
    }

    /// Opens a page with a token. Returns the page and the token of its session. If the host
    /// refuses the page, returns the close code.
    pub fn admitted(&self, token: &str) -> Result<(Client<Page>, String), CloseCode> {
        let mut socket = self.socket();
        socket.send(Message::text(token)).unwrap();
        let said = match socket.read().unwrap() {
            Message::Text(said) => said,
            Message::Close(Some(frame)) => return Err(frame.code),
            other => panic!("{other:?}"),
        };
        let said: Value = serde_json::from_str(&said).unwrap();
        assert_eq!(said["method"], "studio/session");
        let token = said["params"]["token"].as_str().unwrap().to_owned();
        Ok((Client::new(Page(socket)), token))
    }

    /// Opens a page with the printed token. Returns the page, and the host's message about the
    /// scene's file.
    pub fn page(&self) -> (Client<Page>, Value) {
        let (mut page, token) = self.admitted(&self.token).unwrap();
        assert_eq!(token, self.token);
        let file = page.notification("studio/file");
        (page, file)
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The page's side of a WebSocket connection.
pub struct Page(pub WebSocket<TcpStream>);

impl Transport for Page {
    const URI: &'static str = "studio:///scene.scn";

    fn write(&mut self, text: &str) {
        self.0.send(Message::text(text)).unwrap();
    }

    fn read(&mut self) -> String {
        let message = self.0.read().unwrap();
        message.into_text().unwrap().as_str().to_owned()
    }
}

impl Client<Page> {
    /// Skips messages until the host closes the WebSocket. Returns the close code.
    pub fn closed(&mut self) -> CloseCode {
        loop {
            match self.transport.0.read().unwrap() {
                Message::Close(Some(frame)) => return frame.code,
                Message::Text(_) => {}
                other => panic!("{other:?}"),
            }
        }
    }
}
