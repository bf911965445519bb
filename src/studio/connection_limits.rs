//! Limits connections that have not sent a valid token: how long each may stay open, how many bytes
//! it may send, and how many there may be.
//!
//! Any program on this machine can connect and keep a connection open without sending anything. If
//! there are too many such connections, the oldest is closed, so that a new connection is always
//! accepted.

use std::{
    collections::VecDeque,
    io,
    net::SocketAddr,
    pin::Pin,
    sync::{
        Arc, Weak,
        atomic::{AtomicBool, Ordering},
    },
    task::{Context, Poll},
    time::Duration,
};

use axum::{
    extract::connect_info::Connected,
    serve::{IncomingStream, Listener},
};
use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    net::{TcpListener, TcpStream},
    sync::Notify,
    time::timeout,
};

/// Maximum number of open connections that have not sent a valid token. If there is one more, the
/// oldest is closed. A page opens at most four connections, so 64 suffice for many pages. With a
/// higher number, other programs on the machine could make the host use more memory.
const MOST: usize = 64;

/// Time after which a connection that has not sent a valid token is closed. On one machine, a
/// request with its response, or a WebSocket handshake with the token, takes milliseconds. Five
/// seconds suffice even if the machine is slow.
const LIFETIME: Duration = Duration::from_secs(5);

/// Maximum number of bytes that a connection may send before it has sent a valid token. If it sends
/// more, it is closed. A browser's request has about 1 KiB, or more if other programs on this
/// machine have set many cookies. 32 KiB leave room for the cookies.
const LONGEST: usize = 32 << 10;

/// State of a connection, shared between the listener and the handler of the connection's requests.
/// The handler lifts the limits when it has received a valid token.
#[derive(Clone, Debug, Default)]
pub struct Visitor(Arc<VisitorState>);

#[derive(Debug, Default)]
struct VisitorState {
    is_admitted: AtomicBool,
    give_place: Notify,
}

impl Visitor {
    /// Lifts the limits of the connection, because it has sent a valid token.
    pub fn admit(&self) {
        self.0.is_admitted.store(true, Ordering::SeqCst);
    }

    fn is_admitted(&self) -> bool {
        self.0.is_admitted.load(Ordering::SeqCst)
    }
}

impl Connected<IncomingStream<'_, LimitedListener>> for Visitor {
    fn connect_info(stream: IncomingStream<'_, LimitedListener>) -> Self {
        stream.io().visitor.clone()
    }
}

/// A listener that applies the limits to each connection until the connection has sent a valid
/// token.
#[derive(Debug)]
pub struct LimitedListener {
    listener: TcpListener,
    /// Connections that have not sent a valid token, the oldest first.
    strangers: VecDeque<Weak<VisitorState>>,
}

impl LimitedListener {
    /// Creates a limiting listener from a plain one.
    pub fn new(listener: TcpListener) -> Self {
        Self {
            listener,
            strangers: VecDeque::new(),
        }
    }

    fn make_place(&mut self) {
        let is_stranger = |state: &Weak<VisitorState>| {
            let state = state.upgrade();
            state.is_some_and(|state| !state.is_admitted.load(Ordering::SeqCst))
        };
        self.strangers.retain(is_stranger);
        while self.strangers.len() >= MOST {
            if let Some(oldest) = self.strangers.pop_front().and_then(|it| it.upgrade()) {
                oldest.give_place.notify_one();
            }
        }
    }
}

impl Listener for LimitedListener {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        let (stream, address) = Listener::accept(&mut self.listener).await;
        // If the socket option `TCP_NODELAY` cannot be set, small messages are only delayed, so the
        // error is ignored.
        let _ = stream.set_nodelay(true);
        self.make_place();
        let visitor = Visitor::default();
        self.strangers.push_back(Arc::downgrade(&visitor.0));
        (Connection::new(stream, visitor), address)
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A TCP connection. Until it has sent a valid token, reading and writing fail if it exceeds a
/// limit.
pub struct Connection {
    stream: TcpStream,
    visitor: Visitor,
    /// Number of bytes that the connection may still send before it has sent a valid token.
    left: usize,
    /// Future that is ready when the connection must be closed, because its time is over or because
    /// there are too many connections. A future that was ready is replaced by `None`.
    stay: Option<Pin<Box<dyn Future<Output = ()> + Send>>>,
}

impl Connection {
    fn new(stream: TcpStream, visitor: Visitor) -> Self {
        let state = Arc::clone(&visitor.0);
        let stay = async move {
            let _ = timeout(LIFETIME, state.give_place.notified()).await;
        };
        Self {
            stream,
            visitor,
            left: LONGEST,
            stay: Some(Box::pin(stay)),
        }
    }

    /// Returns an error if the connection has not sent a valid token and must be closed, because
    /// its time is over or because there are too many connections.
    fn check(&mut self, context: &mut Context<'_>) -> io::Result<()> {
        if self.visitor.is_admitted() {
            return Ok(());
        }
        let stay = self.stay.as_mut();
        if stay.is_none_or(|stay| stay.as_mut().poll(context).is_ready()) {
            self.stay = None;
            return Err(io::ErrorKind::TimedOut.into());
        }
        Ok(())
    }
}

impl AsyncRead for Connection {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.check(context)?;
        let before = buffer.filled().len();
        let polled = Pin::new(&mut self.stream).poll_read(context, buffer);
        if !self.visitor.is_admitted() {
            let Some(left) = self.left.checked_sub(buffer.filled().len() - before) else {
                return Poll::Ready(Err(io::ErrorKind::InvalidData.into()));
            };
            self.left = left;
        }
        polled
    }
}

impl AsyncWrite for Connection {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.check(context)?;
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        self.check(context)?;
        Pin::new(&mut self.stream).poll_write_vectored(context, slices)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
