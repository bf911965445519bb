//! Serves the page. Any client on this machine gets the page's files. Only pages that [`Access`]
//! admits get a WebSocket connection.

use std::{
    io,
    net::{Ipv4Addr, TcpListener},
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

use axum::{
    Router,
    extract::{
        ConnectInfo, Request, State, WebSocketUpgrade,
        ws::{CloseFrame, Message, WebSocket},
    },
    http::{HeaderValue, StatusCode, header},
    middleware::{self, Next},
    response::{IntoResponse, Response},
    routing::get,
};
use tokio::{
    runtime::{Builder, Handle},
    sync::watch,
    time::timeout,
};

use super::{
    access::{self, Access, Permission},
    connection_limits::{LimitedListener, Visitor},
    conversation::{self, converse},
    lesson_file::LessonFile,
    scene_file::SceneFile,
};

/// Maximum time that the ending host waits for its connections to finish a save and to close. After
/// this time, the host ends even if a disk does not respond. Half a second suffices for a usual
/// save; a longer time would annoy a user who has pressed Ctrl+C.
const FAREWELL: Duration = Duration::from_millis(500);

/// HTML of Studio's page, as `npm run build` writes it.
const INDEX: &str = include_str!("../../studio/page/dist/index.html");
/// Script of Studio's page, as `npm run build` writes it.
const SCRIPT: &[u8] = include_bytes!("../../studio/page/dist/studio.js");
/// Style sheet of Studio's page, as `npm run build` writes it.
const STYLE: &[u8] = include_bytes!("../../studio/page/dist/studio.css");

/// The host that serves a page on this machine, and the scene that the page edits.
#[derive(Debug)]
pub struct Host {
    listener: TcpListener,
    port: u16,
    shared: Arc<Shared>,
}

/// State that all connections share.
#[derive(Debug)]
struct Shared {
    access: Access,
    file: Mutex<SceneFile>,
    lesson: Option<LessonFile>,
    /// Whether the host is about to end. Each connection holds a receiver of this value until it is
    /// closed, so that the host can wait until no receiver is left.
    ending: watch::Sender<bool>,
}

impl Host {
    /// Listens at a port that only programs on this machine can reach. If `port` is 0, the system
    /// chooses a free port.
    ///
    /// # Errors
    ///
    /// Returns an error if the port is taken, or if the system's random number generator fails.
    pub fn new(port: u16, file: SceneFile, lesson: Option<LessonFile>) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            port: listener.local_addr()?.port(),
            listener,
            shared: Arc::new(Shared {
                access: Access::new()?,
                file: Mutex::new(file),
                lesson,
                ending: watch::Sender::new(false),
            }),
        })
    }

    /// Returns two addresses of the page. The first is printed for the user. The second is given to
    /// a browser in a command line, which other users of the machine can read, so it is valid only
    /// once.
    pub fn addresses(&self) -> [String; 2] {
        let port = self.port;
        let tokens = self.shared.access.tokens();
        tokens.map(|token| format!("http://127.0.0.1:{port}/#token={token}"))
    }

    /// Serves pages until the future `end` is ready. A save in progress is completed, unless it
    /// takes longer than half a second.
    ///
    /// # Errors
    ///
    /// Returns an error if the system's event queue cannot be set up.
    pub fn serve(self, end: impl Future<Output = ()>) -> io::Result<()> {
        // The runtime's only thread transports messages. Each connection does its work on its own
        // thread.
        let runtime = Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .build()?;
        runtime.block_on(async {
            let door = LimitedListener::new(tokio::net::TcpListener::from_std(self.listener)?);
            let mut ending = self.shared.ending.subscribe();
            let serving = axum::serve(door, routes(self.port, Arc::clone(&self.shared)))
                .with_graceful_shutdown(async move {
                    let _ = ending.wait_for(|ending| *ending).await;
                });
            tokio::spawn(serving.into_future());
            end.await;
            self.shared.ending.send_replace(true);
            let _ = timeout(FAREWELL, self.shared.ending.closed()).await;
            Ok::<_, io::Error>(())
        })?;
        // A connection that has not ended yet may still use the runtime, so the runtime is never
        // dropped.
        std::mem::forget(runtime);
        Ok(())
    }
}

type MakeService = axum::extract::connect_info::IntoMakeServiceWithConnectInfo<Router, Visitor>;

fn routes(port: u16, shared: Arc<Shared>) -> MakeService {
    let javascript = [(header::CONTENT_TYPE, "text/javascript")];
    let css = [(header::CONTENT_TYPE, "text/css")];
    Router::new()
        .route("/", get(index))
        .route("/studio.js", get(async move || (javascript, SCRIPT)))
        .route("/studio.css", get(async move || (css, STYLE)))
        .route(access::SOCKET, get(socket))
        .fallback(async || (StatusCode::NOT_FOUND, "There is no such page.\n"))
        .layer(middleware::from_fn_with_state(port, guard))
        .with_state(shared)
        .into_make_service_with_connect_info::<Visitor>()
}

/// Refuses requests that are not meant for this host. Each response gets headers that forbid
/// caching, guessing of content types, and referrers.
async fn guard(State(port): State<u16>, request: Request, next: Next) -> Response {
    let refusal = access::refusal(port, request.method(), request.uri(), request.headers());
    let mut response = match refusal {
        None => next.run(request).await,
        Some((status, why)) => (status, format!("{why}\n")).into_response(),
    };
    let mut lines = vec![
        (header::CACHE_CONTROL, "no-store"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ];
    if response.status() == StatusCode::METHOD_NOT_ALLOWED {
        lines.push((header::ALLOW, "GET"));
    }
    if response.status() != StatusCode::SWITCHING_PROTOCOLS {
        lines.push((header::CONNECTION, "close"));
    }
    for (name, value) in lines {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}

/// Serves the HTML of the page. Since the editor creates some styles while it runs, the content
/// security policy allows styles with a nonce, i.e. a random word for this response.
async fn index() -> Response {
    let Ok(nonce) = access::secret() else {
        let why = "There is no randomness.\n";
        return (StatusCode::INTERNAL_SERVER_ERROR, why).into_response();
    };
    let policy = format!(
        "default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{nonce}'; img-src 'self' blob: data:; connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    let lines = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8".to_owned()),
        (header::CONTENT_SECURITY_POLICY, policy),
    ];
    (lines, INDEX.replace("__NONCE__", &nonce)).into_response()
}

async fn socket(
    State(shared): State<Arc<Shared>>,
    ConnectInfo(visitor): ConnectInfo<Visitor>,
    upgrade: WebSocketUpgrade,
) -> Response {
    upgrade
        .read_buffer_size(1 << 14)
        .max_message_size(conversation::LONGEST)
        .max_frame_size(conversation::LONGEST)
        .on_upgrade(async move |socket| admit(&shared, &visitor, socket).await)
}

/// Waits for the first message, which must be a token. If the token is valid, begins to serve the
/// page. [`Connection`](super::connection_limits::Connection) limits the waiting time.
async fn admit(shared: &Arc<Shared>, visitor: &Visitor, mut socket: WebSocket) {
    let Some(Ok(Message::Text(token))) = socket.recv().await else {
        return;
    };
    match shared.access.admit(&token, Instant::now()) {
        Ok(permission) => {
            visitor.admit();
            begin(Arc::clone(shared), permission, socket);
        }
        Err(refusal) => {
            let code = refusal as u16;
            let reason = "".into();
            let goodbye = Message::Close(Some(CloseFrame { code, reason }));
            let _ = socket.send(goodbye).await;
            // Unread messages would reset the connection before the close code arrives, so they are
            // read.
            while let Some(Ok(_)) = socket.recv().await {}
        }
    }
}

/// Serves a page on a new thread. If no thread can be started, the connection is closed.
fn begin(shared: Arc<Shared>, permission: Permission, socket: WebSocket) {
    let runtime = Handle::current();
    let ending = shared.ending.subscribe();
    let thread = thread::Builder::new().name("connection".to_owned());
    // A panic of the thread ends only its own connection, so the result is ignored.
    let _ = thread.spawn(move || {
        let (file, lesson) = (&shared.file, shared.lesson.as_ref());
        converse(runtime, socket, &permission, &ending, file, lesson);
    });
}
