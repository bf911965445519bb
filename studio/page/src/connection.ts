// The connection to the engine: a web socket to the served host, or a web worker, carrying one JSON-RPC message a text. It is the transport of the editor's
// language client, and carries the page's own requests beside it. A lost connection is opened anew after growing pauses.

import type { Transport } from "@codemirror/lsp-client";
import { Refusal } from "./protocol";

/** Something that carries texts. */
interface Wire {
  send(text: string): void;
}

/** Opens a wire; the three functions are called as it opens, brings a text, and closes. */
type Connector = (opened: (wire: Wire) => void, receive: (text: string) => void, closed: () => void) => void;

export type ConnectionState = "connecting" | "open" | "lost";

interface Waiting {
  resolve(result: unknown): void;
  reject(error: Error): void;
}

/** Pauses before attempts to connect anew, in milliseconds; the last one repeats. */
const PAUSES = [250, 500, 1000, 2000, 4000, 8000];

export class Connection implements Transport {
  state: ConnectionState = "connecting";
  onState: (state: ConnectionState) => void = () => {};
  onNotification: (method: string, params: unknown) => void = () => {};
  /** Resolves as soon as the server has been told who we are, so that what is sent then comes after all that the editor has sent before. */
  ready: () => Promise<unknown> = () => Promise.resolve();

  private wire: Wire | null = null;
  private readonly handlers = new Set<(text: string) => void>();
  private readonly waiting = new Map<string, Waiting>();
  private requests = 0;
  private attempts = 0;

  constructor(private readonly connector: Connector) {}

  open(): void {
    this.connector(
      wire => {
        this.wire = wire;
        this.enter("open");
      },
      text => this.receive(text),
      () => this.lose(),
    );
  }

  send(text: string): void {
    if (this.wire === null) throw new Error("The connection is lost.");
    this.wire.send(text);
  }

  subscribe(handler: (text: string) => void): void {
    this.handlers.add(handler);
  }

  unsubscribe(handler: (text: string) => void): void {
    this.handlers.delete(handler);
  }

  /** Asks the server. Rejects with a `Refusal` if it refuses, and with another error if the connection is lost. */
  async request<Result>(method: string, params: unknown): Promise<Result> {
    await this.ready();
    const id = `page-${++this.requests}`;
    return new Promise<Result>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (result: unknown) => void, reject });
      try {
        this.send(JSON.stringify({ jsonrpc: "2.0", id, method, params }));
      } catch (error) {
        this.waiting.delete(id);
        reject(error as Error);
      }
    });
  }

  private receive(text: string): void {
    // What opens and closes at once has not come back.
    this.attempts = 0;
    const message = JSON.parse(text);
    const waiting = "method" in message ? undefined : this.waiting.get(message.id);
    if (waiting !== undefined) {
      this.waiting.delete(message.id);
      const { error } = message;
      if (error) waiting.reject(new Refusal(error.code, error.message));
      else waiting.resolve(message.result);
      return;
    }
    if (!("id" in message) && /^(studio|pinhole)\//.test(message.method)) {
      this.onNotification(message.method, message.params);
      return;
    }
    for (const handler of [...this.handlers]) handler(text);
  }

  private lose(): void {
    this.wire = null;
    for (const waiting of this.waiting.values()) waiting.reject(new Error("The connection was lost."));
    this.waiting.clear();
    this.enter("lost");
    const pause = PAUSES[Math.min(this.attempts++, PAUSES.length - 1)];
    setTimeout(() => this.open(), pause);
  }

  private enter(state: ConnectionState): void {
    const changed = this.state !== state;
    this.state = state;
    if (changed) this.onState(state);
  }
}

/** A web socket on the page's own host. */
export function webSocket(path: string): Connector {
  return (opened, receive, closed) => {
    const url = new URL(path, location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    url.hash = "";
    const socket = new WebSocket(url);
    socket.addEventListener("open", () => opened(socket));
    socket.addEventListener("message", event => receive(String(event.data)));
    socket.addEventListener("close", closed);
  };
}

/** A web worker that runs the engine. It is open when it says its first word, after it has loaded the engine; one that fails is replaced. */
export function worker(path: string): Connector {
  return (opened, receive, closed) => {
    const engine = new Worker(new URL(path, location.href), { type: "module" });
    let isOpen = false;
    engine.addEventListener("message", event => {
      if (!isOpen) opened({ send: text => engine.postMessage(text) });
      isOpen = true;
      receive(String(event.data));
    });
    engine.addEventListener("error", () => {
      engine.terminate();
      closed();
    });
  };
}
