//! The program, and a plain client that says what a browser would say.

use std::{
    fs,
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    time::Duration,
};

use pinhole::scene::SMALLEST;
use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::{
    Message, WebSocket,
    client::client,
    handshake::client::{Request, generate_key},
};

use crate::program::command;

/// The longest that anything may take.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// The program, which serves the smallest scene as `a.scn`, in a folder of its own.
pub fn studio() -> (TempDir, Studio) {
    serve("a.scn", SMALLEST)
}

/// The program, which serves a file of this name with this text, in a folder of its own.
pub fn serve(name: &str, text: &str) -> (TempDir, Studio) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    let studio = Studio::start(folder.path(), &[name]);
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
    pub fn start(folder: &Path, arguments: &[&str]) -> Self {
        let arguments = [&["studio", "--no-open"], arguments].concat();
        Self::started(command(folder, &arguments))
    }

    pub fn started(mut command: Command) -> Self {
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines
            .map(Result::unwrap)
            .find(|line| line.starts_with("http"))
            .expect("it prints an address");
        let rest = address.strip_prefix("http://127.0.0.1:").unwrap();
        let (port, token) = rest.split_once("/?token=").unwrap();
        let mut studio = Self {
            child,
            port: port.parse().unwrap(),
            token: token.to_owned(),
            secret: String::new(),
        };
        let response = studio.get(&format!("/?token={token}"), "");
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

    /// The response to a request for a path, with the host and these headers.
    pub fn get(&self, path: &str, headers: &str) -> String {
        let host = self.host();
        self.response(&format!(
            "GET {path} HTTP/1.1\r\nHost: {host}\r\n{headers}\r\n"
        ))
    }

    /// A page, to which nothing but the file was told yet.
    pub fn page(&self) -> (Page, Value) {
        let host = self.host();
        let request = Request::builder()
            .uri(format!("ws://{host}/socket"))
            .header("Host", &host)
            .header("Origin", format!("http://{host}"))
            .header("Cookie", self.cookie())
            .header("Connection", "Upgrade")
            .header("Upgrade", "websocket")
            .header("Sec-WebSocket-Version", "13")
            .header("Sec-WebSocket-Key", generate_key())
            .body(())
            .unwrap();
        let (socket, _) = client(request, self.stream()).unwrap();
        let mut page = Page {
            socket,
            requests: 0,
            told: Vec::new(),
        };
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

pub struct Page {
    pub socket: WebSocket<TcpStream>,
    requests: i32,
    /// Notifications that nobody has asked for yet.
    told: Vec<Value>,
}

impl Page {
    pub fn read(&mut self) -> Value {
        match self.socket.read().unwrap() {
            Message::Text(text) => serde_json::from_str(&text).unwrap(),
            other => panic!("{other:?}"),
        }
    }

    pub fn write(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    pub fn tell(&mut self, method: &str, params: Value) {
        self.write(&json!({ "jsonrpc": "2.0", "method": method, "params": params }).to_string());
    }

    /// Asks, and does not wait for the answer.
    pub fn request(&mut self, method: &str, params: Value) -> i32 {
        self.requests += 1;
        let id = self.requests;
        let request = json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params });
        self.write(&request.to_string());
        id
    }

    /// The whole response to a request.
    pub fn response(&mut self, id: i32) -> Value {
        loop {
            let message = self.read();
            if message["id"] == id {
                assert_eq!(message["jsonrpc"], "2.0");
                return message;
            }
            self.told.push(message);
        }
    }

    pub fn respond(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        self.response(id)
    }

    /// The result of a request.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let response = self.respond(method, params);
        assert!(response.get("error").is_none(), "{response}");
        response["result"].clone()
    }

    /// The parameters of the next notification of this name, since the last one that was asked for.
    pub fn told(&mut self, method: &str) -> Value {
        loop {
            let place = self.told.iter().position(|it| it["method"] == method);
            match place {
                Some(place) => return self.told.remove(place)["params"].clone(),
                None => {
                    let message = self.read();
                    self.told.push(message);
                }
            }
        }
    }
}
