// The engine (the language server) in a web worker, which exchanges JSON texts with the page. The
// engine reads new messages between slices of work, so that it can drop the work on a text that has
// been changed.

import init, { Engine } from "pinhole-engine";

function run(engine: Engine): void {
  const slices = new MessageChannel();
  let isPlanned = false;
  const say = (texts: string[]) => {
    for (const text of texts) postMessage(text);
    if (isPlanned || !engine.isBusy()) return;
    isPlanned = true;
    // The next slice of work begins when this null message arrives. Texts of the page that arrive
    // before it are handled first.
    slices.port2.postMessage(null);
  };
  slices.port1.onmessage = () => {
    isPlanned = false;
    say(engine.advance());
  };
  addEventListener("message", ({ data }: MessageEvent<string>) => say(engine.handle(data)));
  say([engine.greeting()]);
}

// Rethrows an error from a timer, so that the page gets an `error` event. A worker does not report
// an unhandled rejection to the page.
const fail = (error: unknown) => setTimeout(() => { throw error; });
const wasm = new URL("pinhole_bg.wasm", import.meta.url);
init({ module_or_path: wasm }).then(() => run(new Engine()), fail);
