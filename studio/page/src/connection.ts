// The connection to the engine, which computes all answers. It is a WebSocket to the host (the
// program that serves the page), a web worker, or the extension of VS Code whose panel contains the
// page. Each text is a JSON-RPC message. A lost connection is reopened after growing pauses, unless
// the host refuses the page.

import type { Transport } from "@codemirror/lsp-client";
import { session } from "./address";
import { meta } from "./dom";
import { panel } from "./panel";
import { Refusal } from "./protocol";

/** An open channel that sends texts to the engine. */
interface Wire { send(text: string): void }

/** Reason why there is no connection. After `lost`, `ended` (the host has ended) and `failed` (the
 * worker or VS Code's server has failed), the page reconnects by itself. After the other reasons,
 * the user must open an address that the host has printed. `keyless`: the page has no token.
 * `restarted`: the token is from an earlier run of the host. `late` and `twice`: the token was sent
 * after its lifetime, or a second time. */
type Closed = "lost" | "ended" | "failed" | "keyless" | "unknown" | "restarted" | "late" | "twice";
const TRIED_AGAIN: Closed[] = ["lost", "ended", "failed"];

/** State of the connection. `silent` means that the connection is lost, and that the attempts to
 * reconnect after all `PAUSES` have failed. */
export type ConnectionState = "connecting" | "open" | "silent" | Closed;

/** Function that opens a channel. It calls `opened` with the channel, `receive` for each text, and
 * `closed` when the channel is closed. */
type Connector = (opened: (wire: Wire) => void, receive: (text: string) => void,
  closed: (why: Closed) => void) => void;

/** Pauses before attempts to reconnect, in ms. They grow, so that a missing host costs little work.
 * The last pause repeats. */
const PAUSES = [250, 500, 1000, 2000, 4000, 8000];
/** Silence of the server, in ms, after which the page sends a test request. A shorter time would
 * cause more requests; a longer one would delay the notice that the server does not reply. */
const SILENCE = 700;
const HANGING = 1200; // time after which a reply to a test request is late, in ms

/** Prefix of the ids of the page's own requests. Answers with other ids are for the language
 * client. */
const OWN = "page-";
const NO_CONNECTION = "This cannot be done without a connection.";

/** Meanings of the codes with which the host closes a WebSocket. */
const CLOSED: Partial<Record<number, Closed>> = { 1001: "ended", 4002: "late", 4003: "twice" };
const UNKNOWN = 4001;

class Connection implements Transport {
  state: ConnectionState = "connecting";
  onState: (state: ConnectionState) => void = () => {};
  /** Called with true if a test request gets no reply in time, and with false at the next
   * message. */
  onHang: (isHanging: boolean) => void = () => {};
  /** Resolves when the language client is initialized and all earlier messages are sent. */
  ready: () => Promise<unknown> = () => Promise.resolve();

  private wire: Wire | null = null;
  private handle: (text: string) => void = () => {};
  private readonly waiting =
    new Map<string, { resolve(result: any): void; reject(error: Error): void }>();
  private requests = 0;
  private attempts = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** Number of the latest attempt to connect, counted from 1. Events of earlier attempts are
   * ignored. */
  private current = 0;
  /** Time of the last message from the server, in ms since the page was loaded. */
  private lastMessageTime = 0;
  /** Time at which the unanswered test request was sent, in ms since the page was loaded; 0 if no
   * test request is unanswered. */
  private testSentTime = 0;
  private hangs = false;

  constructor(private readonly connector: Connector) {
    setInterval(() => this.listen(), 250);
    // Browsers stop the timers of hidden pages. When a page is hidden or shown, the age of an
    // unanswered test request therefore says nothing about the server, so the request is forgotten.
    document.addEventListener("visibilitychange", () => (this.testSentTime = 0));
  }

  /** Checks whether the server still replies. Sends a test request after a silence, and calls
   * `onHang` if its reply is late. Called four times a second. */
  private listen(): void {
    const now = performance.now();
    if (this.wire === null || document.hidden) return;
    if (this.testSentTime === 0) {
      if (now - this.lastMessageTime < SILENCE) return;
      this.testSentTime = now;
      void this.request("studio/alive", {}).catch(() => {});
    } else if (now - this.testSentTime > HANGING && !this.hangs) this.onHang((this.hangs = true));
  }

  open(): void {
    const attempt = ++this.current;
    const isCurrent = () => attempt === this.current;
    this.connector(wire => {
      if (!isCurrent()) return;
      this.wire = wire;
      this.enter("open");
    }, text => isCurrent() && this.receive(text), why => isCurrent() && this.lose(why));
  }

  /** Reconnects at once. It is called if there is a new reason to try, such as a new token. */
  retry(): void {
    clearTimeout(this.timer);
    this.attempts = 0;
    this.enter("connecting");
    this.open();
  }

  send(text: string): void {
    if (this.wire === null) throw new Error(NO_CONNECTION);
    this.wire.send(text);
  }

  /** Sets the language client's handler. The handler gets all messages except answers to `request`.
   */
  subscribe(handler: (text: string) => void): void { this.handle = handler; }
  unsubscribe(): void { this.handle = () => {}; }

  /** Sends a request. Rejects with a `Refusal` if the server refuses it, and with another error if
   * the connection is lost or `wanted` is aborted. */
  async request<Result>(method: string, params: unknown, wanted?: AbortSignal): Promise<Result> {
    // Without a connection, `ready` may never resolve, so the request is rejected at once.
    if (this.wire === null) throw new Error(NO_CONNECTION);
    const id = OWN + ++this.requests;
    return new Promise<Result>((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      // The request waits for `ready`. If the connection is lost or the request is aborted in this
      // time, the request is removed from `waiting`, and must not be sent.
      this.ready().then(() => {
        if (!this.waiting.has(id)) return;
        this.send(JSON.stringify({ jsonrpc: "2.0", id, method, params }));
      }).catch(reject);
      wanted?.addEventListener("abort", () => {
        const cancel = { jsonrpc: "2.0", method: "$/cancelRequest", params: { id } };
        if (this.waiting.delete(id)) this.send(JSON.stringify(cancel));
        reject(wanted.reason as Error);
      });
    });
  }

  /** Sends a notification after all earlier messages, if there is a connection. */
  notify(method: string, params: object): void {
    const text = JSON.stringify({ jsonrpc: "2.0", method, params });
    this.ready().then(() => this.wire?.send(text)).catch(() => {});
  }

  private receive(text: string): void {
    // The next attempts to reconnect begin with the shortest pause again. The count is reset at the
    // first message, not when the channel opens, because a failing server may accept connections.
    this.attempts = 0;
    this.lastMessageTime = performance.now();
    this.testSentTime = 0;
    if (this.hangs) this.onHang((this.hangs = false));
    const message = JSON.parse(text);
    if ("method" in message || !String(message.id).startsWith(OWN)) return this.handle(text);
    const { id, result, error } = message;
    if (error) this.waiting.get(id)?.reject(new Refusal(error.code, error.message));
    else this.waiting.get(id)?.resolve(result);
    this.waiting.delete(id);
  }

  private lose(why: Closed): void {
    this.wire = null;
    this.testSentTime = 0;
    this.hangs = false;
    const lost = new Error("The connection was lost.");
    for (const waiting of this.waiting.values()) waiting.reject(lost);
    this.waiting.clear();
    if (!TRIED_AGAIN.includes(why)) return this.enter(why);
    // The state `ended` remains until a new connection opens. Failed attempts to reconnect must not
    // replace it by another reason.
    const isSilent = why === "lost" && this.attempts >= PAUSES.length;
    if (this.state !== "ended") this.enter(isSilent ? "silent" : why);
    const pause = PAUSES[Math.min(this.attempts++, PAUSES.length - 1)];
    this.timer = setTimeout(() => this.open(), pause);
  }

  private enter(state: ConnectionState): void {
    const changed = this.state !== state;
    this.state = state;
    if (changed) this.onState(state);
  }
}

/** The socket of the latest attempt to connect. Earlier sockets are closed, so that their late
 * answers do not replace a newer token. */
let latest: WebSocket | undefined;

/** Opens a WebSocket and sends the page's token. The host's first message contains the token for
 * the next connection. After this message, the channel is open. */
const webSocket: Connector = (opened, receive, closed) => {
  const { token } = session;
  if (token === null) return closed("keyless");
  const socket = new WebSocket(`${location.origin.replace(/^http/, "ws")}/socket`);
  latest?.close();
  latest = socket;
  let isOpen = false;
  socket.addEventListener("open", () => socket.send(token));
  socket.addEventListener("message", event => {
    if (isOpen) return receive(String(event.data));
    if (socket !== latest) return;
    isOpen = true;
    session.keep(JSON.parse(String(event.data)).params.token, "host");
    opened(socket);
  });
  socket.addEventListener("close", ({ code }) => closed(code === UNKNOWN
    ? (session.isFresh ? "unknown" : "restarted") : CLOSED[code] ?? "lost"));
};

/** Starts the engine in a web worker. Its first message opens the channel; a failure closes it. */
const worker: Connector = (opened, receive, closed) => {
  const engine = new Worker(new URL("engine.js", location.href), { type: "module" });
  let isOpen = false;
  engine.addEventListener("message", event => {
    if (!isOpen) opened({ send: text => engine.postMessage(text) });
    isOpen = true;
    receive(String(event.data));
  });
  engine.addEventListener("error", () => {
    engine.terminate();
    closed("failed");
  });
};

/** Asks the VS Code extension for a connection to the server. The extension's first text opens the
 * channel; its text `ended` closes the channel. */
const extension: Connector = (opened, receive, closed) => {
  let isOpen = false;
  window.onmessage = ({ data }: MessageEvent<unknown>) => {
    if (typeof data !== "string") return;
    if (data === "ended") return closed("failed");
    if (!isOpen) opened({ send: text => panel?.postMessage(text) });
    isOpen = true;
    receive(data);
  };
  panel?.postMessage("waiting");
};

export const isServed = meta("host") !== "static";
export const connection = new Connection(panel ? extension : isServed ? webSocket : worker);
