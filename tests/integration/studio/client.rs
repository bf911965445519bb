//! The program, and a plain client that says what a browser would say.

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
};

use crate::{
    lsp::client::{Carrier, Client, PATIENCE},
    program::Folder,
};

/// The program, which serves the smallest scene as `a.scn`, in a folder of its own.
pub fn studio() -> (Folder, Studio) {
    let folder = Folder::with([("a.scn", SMALLEST)]);
    let studio = Studio::start(folder.command("studio --no-open a.scn"));
    (folder, studio)
}

/// The program while it serves.
pub struct Studio {
    pub child: Child,
    pub port: u16,
    pub token: String,
    pub secret: String,
}

impl Studio {
    pub fn start(mut command: Command) -> Self {
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines.find_map(|line| {
            let line = line.unwrap();
            let (port, token) = line
                .strip_prefix("http://127.0.0.1:")?
                .split_once("/?token=")?;
            Some((port.parse().unwrap(), token.to_owned()))
        });
        let (port, token) = address.expect("it prints an address");
        let mut studio = Self {
            child,
            port,
            token,
            secret: String::new(),
        };
        let response = studio.get(&format!("/?token={}", studio.token), "");
        let (_, secret) = response.split_once(&format!("pinhole-{port}=")).unwrap();
        studio.secret = secret[..32].to_owned();
        studio
    }

    pub fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    pub fn cookie(&self) -> String {
        format!("pinhole-{}={}", self.port, self.secret)
    }

    pub fn stream(&self) -> TcpStream {
        let stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_write_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// The response to what is sent.
    pub fn response(&self, request: &str) -> String {
        let mut stream = self.stream();
        stream.write_all(request.as_bytes()).unwrap();
        let mut response = String::new();
        stream.read_to_string(&mut response).unwrap();
        response
    }

    /// The response to a request for a path, with the host and these lines of the head.
    pub fn get(&self, path: &str, headers: &str) -> String {
        let host = self.host();
        self.response(&format!(
            "GET {path} HTTP/1.1\r\nHost: {host}\r\n{headers}\r\n"
        ))
    }

    /// A page, to which nothing but the file was told yet.
    pub fn page(&self) -> (Client<Page>, Value) {
        let host = self.host();
        let mut request = format!("ws://{host}/socket").into_client_request().unwrap();
        for (name, value) in [
            ("Origin", format!("http://{host}")),
            ("Cookie", self.cookie()),
        ] {
            request.headers_mut().insert(name, value.parse().unwrap());
        }
        let (socket, _) = client(request, self.stream()).unwrap();
        let mut page = Client::new(Page(socket));
        let file = page.told("studio/file");
        (page, file)
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A page's end of the web socket.
pub struct Page(pub WebSocket<TcpStream>);

impl Carrier for Page {
    const URI: &'static str = "studio:///scene.scn";

    fn write(&mut self, text: &str) {
        self.0.send(Message::text(text)).unwrap();
    }

    fn read(&mut self) -> String {
        let message = self.0.read().unwrap();
        message.into_text().unwrap().as_str().to_owned()
    }
}
