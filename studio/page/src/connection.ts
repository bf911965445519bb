// The connection to the engine: a web socket to the host, or a web worker, with a JSON-RPC message
// a text. A lost one is opened anew after growing pauses, unless the host refuses this page.

import type { Transport } from "@codemirror/lsp-client";
import { session } from "./address";
import { meta } from "./dom";
import { Refusal } from "./protocol";

/** Something that carries texts. */
interface Wire { send(text: string): void }

/** Why there is no connection. After `lost`, `ended` (the host's own word) and `failed` (a worker)
 *  it is tried again; after the others not before an address of the host is opened. */
type Closed = "lost" | "ended" | "failed" | "keyless" | "unknown" | "restarted" | "late" | "twice";
const TRIED_AGAIN: Closed[] = ["lost", "ended", "failed"];

/** `silent` is a connection that is lost for long. */
export type ConnectionState = "connecting" | "open" | "silent" | Closed;

/** Opens a wire; the three functions are called as it opens, brings a text, and closes. */
type Connector = (opened: (wire: Wire) => void, receive: (text: string) => void,
  closed: (why: Closed) => void) => void;

/** Pauses before attempts to connect anew, in milliseconds; the last one repeats. */
const PAUSES = [250, 500, 1000, 2000, 4000, 8000];
/** After so much silence the server is asked whether it lives, and has so long to answer, in ms. */
const QUIET = 700;
const HANGING = 1200;

/** What the numbers of the page's own requests begin with. */
const OWN = "page-";
const NO_CONNECTION = "This cannot be done without a connection.";

/** What the codes say with which the host closes a web socket. */
const CLOSED: Partial<Record<number, Closed>> = { 1001: "ended", 4002: "late", 4003: "twice" };
const UNKNOWN = 4001;

class Connection implements Transport {
  state: ConnectionState = "connecting";
  onState: (state: ConnectionState) => void = () => {};
  /** Told when nothing has come back for long, and when something has again. */
  onHang: (isHanging: boolean) => void = () => {};
  /** Resolves once the server has been told who we are and all that was sent before. */
  ready: () => Promise<unknown> = () => Promise.resolve();

  private wire: Wire | null = null;
  private handle: (text: string) => void = () => {};
  private readonly waiting =
    new Map<string, { resolve(result: any): void; reject(error: Error): void }>();
  private requests = 0;
  private attempts = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** Counts attempts to connect: of an older one nothing is heard any more. */
  private current = 0;
  /** When something was heard last, when the server was asked, and whether it was given up. */
  private heard = 0;
  private asked = 0;
  private hangs = false;

  constructor(private readonly connector: Connector) {
    setInterval(() => this.listen(), 250);
    // A browser stops the clocks of pages that nobody sees.
    document.addEventListener("visibilitychange", () => (this.asked = 0));
  }

  /** Asks a silent server whether it lives. */
  private listen(): void {
    const now = performance.now();
    if (this.wire === null || document.hidden) return;
    if (this.asked === 0) {
      if (now - this.heard < QUIET) return;
      this.asked = now;
      void this.request("studio/alive", {}).catch(() => {});
    } else if (now - this.asked > HANGING && !this.hangs) this.onHang((this.hangs = true));
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

  /** Tries at once, for a caller without a connection who has a new reason to hope for one. */
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

  /** The language client hears of all but the answers to `request`. */
  subscribe(handler: (text: string) => void): void { this.handle = handler; }
  unsubscribe(): void { this.handle = () => {}; }

  /** Asks the server. Rejects with a `Refusal`, or otherwise if it is lost, or not wanted more. */
  async request<Result>(method: string, params: unknown, wanted?: AbortSignal): Promise<Result> {
    // Without a server nobody is ever ready.
    if (this.wire === null) throw new Error(NO_CONNECTION);
    const id = OWN + ++this.requests;
    return new Promise<Result>((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      // Before anybody is ready, the connection may be lost, or the answer not wanted any more.
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

  private receive(text: string): void {
    // What opens and closes at once has not come back.
    this.attempts = 0;
    this.heard = performance.now();
    this.asked = 0;
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
    this.asked = 0;
    this.hangs = false;
    const lost = new Error("The connection was lost.");
    for (const waiting of this.waiting.values()) waiting.reject(lost);
    this.waiting.clear();
    if (!TRIED_AGAIN.includes(why)) return this.enter(why);
    // What the host has said holds until it answers again.
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

/** A web socket. Its first message is the token; the host's first one is that for the next time. */
const webSocket: Connector = (opened, receive, closed) => {
  const { token } = session;
  if (token === null) return closed("keyless");
  const socket = new WebSocket(`${location.origin.replace(/^http/, "ws")}/socket`);
  let isOpen = false;
  socket.addEventListener("open", () => socket.send(token));
  socket.addEventListener("message", event => {
    if (isOpen) return receive(String(event.data));
    isOpen = true;
    session.keep(JSON.parse(String(event.data)).params.token, "host");
    opened(socket);
  });
  socket.addEventListener("close", ({ code }) => closed(code === UNKNOWN
    ? (session.isFresh ? "unknown" : "restarted") : CLOSED[code] ?? "lost"));
};

/** A web worker that runs the engine, whose first word opens it. One that fails is replaced. */
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

export const isServed = meta("host") !== "static";
export const connection = new Connection(isServed ? webSocket : worker);
