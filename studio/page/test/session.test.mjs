// Tests of sessions: reloading, reconnecting, a new host, an address used twice, and other servers.

import assert from "node:assert/strict";
import { chmodSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { andFinished, FIGURE, finished, host, launch, open, serve, text, type } from "./helpers.mjs";

const LARGER = FIGURE.replace("radius 1", "radius 1.5");

/** Waits until the page shows a text about its connection. */
async function says(page, pattern) {
  await page.waitForFunction(pattern => new RegExp(pattern).test(document.querySelector("#connection").textContent), pattern.source, { timeout: 40_000 });
  assert.ok(await page.isVisible("#connection"));
}

async function connected(page) {
  await page.waitForSelector("#connection-bar", { state: "hidden", timeout: 30_000 });
  await finished(page);
}

/** Asserts that the text is still there and can be downloaded. */
async function keeps(page, scene) {
  assert.equal(await text(page), scene);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#connection-download")]);
  assert.equal(readFileSync(await download.path(), "utf8"), scene);
}

test("only the token is removed from the address, and reloading keeps the session", async t => {
  const started = await host(t);
  const { origin, hash } = new URL(started.address);
  const page = await open(await launch(t), { address: `${origin}/#view=1&${hash.slice(1)}&show=text` });
  for (let i = 0; i < 2; i++) {
    assert.equal(page.url(), `${origin}/#view=1&show=text`);
    assert.equal(await page.evaluate(() => document.cookie), "");
    await page.reload();
    await connected(page);
  }
  assert.deepEqual(await page.context().cookies(), []);
  assert.deepEqual(page.complaints, []);
});

test("a tab without the token says how to get it, and two tabs work with it", async t => {
  const started = await host(t);
  const first = await open(await launch(t), started);
  const second = await first.context().newPage();
  await second.goto(new URL(started.address).origin);
  await says(second, /no token .*printed in its terminal/);
  assert.ok(await second.isHidden("#connection-download"));
  await second.goto(started.address);
  await connected(second);
  await andFinished(first, () => type(first, LARGER));
  await andFinished(second, () => first.keyboard.press("Control+s"));
  assert.equal(await text(second), LARGER);
});

test("a broken connection is restored, and the text stays", async t => {
  const started = await host(t);
  const page = await (await launch(t)).newPage();
  let wire;
  await page.routeWebSocket(/socket/, socket => {
    socket.connectToServer();
    wire = socket;
  });
  await page.goto(started.address);
  await connected(page);
  await andFinished(page, () => type(page, LARGER));
  await wire.close({ code: 3000 });
  await says(page, /Connection lost; connecting again/);
  await connected(page);
  assert.equal(await text(page), LARGER);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), LARGER);
});

test("a host that was long unreachable is found again automatically", async t => {
  const started = await host(t);
  const page = await (await launch(t)).newPage();
  let [wire, isAway] = [null, false];
  await page.routeWebSocket(/socket/, socket => {
    if (isAway) return void socket.close({ code: 3000 });
    socket.connectToServer();
    wire = socket;
  });
  await page.goto(started.address);
  await connected(page);
  isAway = true;
  await wire.close({ code: 3000 });
  await type(page, LARGER);
  await says(page, /Nothing answers at this address any more/);
  isAway = false;
  await connected(page);
  await page.waitForFunction(() => /not saved/.test(document.querySelector("#file-state").textContent));
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), LARGER);
});

test("a restarted host is distinguished from a lost one, and its address continues the text", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const { port } = new URL(started.address);
  await started.stop();
  await says(page, /Studio was ended\. .*printed in its terminal/);
  await type(page, LARGER);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => /Nothing was saved/.test(document.querySelector("#said").textContent));
  await keeps(page, LARGER);
  const again = await serve(started.file, { port });
  t.after(() => again.stop());
  await says(page, /Studio was started anew.*printed in its terminal/);
  await keeps(page, LARGER);
  await page.goto(again.address);
  await connected(page);
  assert.equal(await text(page), LARGER);
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), LARGER);
});

test("a dead host is reported, and the address of one at another port continues the text", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await type(page, LARGER);
  await started.stop("SIGKILL");
  await says(page, /Connection lost; connecting again/);
  await says(page, /Nothing answers .*printed in its terminal/);
  await keeps(page, LARGER);
  const again = await serve(started.file);
  t.after(() => again.stop());
  // The browser asks before it leaves an unsaved text.
  const [asked] = await Promise.all([page.waitForEvent("dialog"), page.goto(again.address).catch(() => {})]);
  assert.equal(asked.type(), "beforeunload");
  await asked.accept();
  await connected(page);
  assert.equal(await text(page), FIGURE);
});

test("an address of an earlier run is reported as such", async t => {
  const started = await host(t);
  const page = await (await launch(t)).newPage();
  await page.goto(`${new URL(started.address).origin}/#token=${"0".repeat(32)}`);
  await says(page, /earlier run of Studio, or incomplete/);
  await page.goto(started.address);
  await connected(page);
});

test("the opened address works once, and a second use ends both pages' sessions", async t => {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-open-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  for (const name of ["xdg-open", "open"]) {
    writeFileSync(path.join(folder, name), `#!/bin/sh\nprintf %s "$1" > '${folder}/part' && mv '${folder}/part' '${folder}/opened'\n`);
    chmodSync(path.join(folder, name), 0o755);
  }
  const scene = path.join(folder, "scene.scn");
  writeFileSync(scene, FIGURE);
  const started = await serve(scene, { browser: folder });
  t.after(() => started.stop());
  while (!existsSync(path.join(folder, "opened"))) await new Promise(resolve => setTimeout(resolve, 20));
  const once = readFileSync(path.join(folder, "opened"), "utf8");
  assert.notEqual(once, started.address);
  const first = await open(await launch(t), { address: once });
  await first.reload();
  await connected(first);
  await andFinished(first, () => type(first, LARGER));
  const second = await first.context().newPage();
  await second.goto(once);
  for (const page of [first, second]) await says(page, /opened twice.* has ended.*printed in its terminal/);
  await keeps(first, LARGER);
  assert.equal(readFileSync(scene, "utf8"), FIGURE);
  // The address that the host has printed still works.
  await first.goto(started.address);
  await connected(first);
  assert.equal(await text(first), LARGER);
});

test("a page of another local server gets no access", async t => {
  const started = await host(t);
  const { origin, host: name, hash } = new URL(started.address);
  const token = hash.slice("#token=".length);
  const heads = [];
  const server = createServer((request, response) => {
    heads.push(`${request.url} ${JSON.stringify(request.headers)}`);
    response.writeHead(200, { "content-type": "text/html" }).end("<!doctype html><iframe></iframe>");
  });
  await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
  t.after(() => server.close());
  const theirs = `http://127.0.0.1:${server.address().port}/`;
  const page = await open(await launch(t), started);
  // The other server's page tries to reach Studio, first from a new tab, then from Studio's tab.
  const other = await page.context().newPage();
  await other.goto(theirs);
  const found = await other.evaluate(
    async ([origin, name]) => {
      const socket = new WebSocket(`ws://${name}/socket`);
      const said = [];
      socket.onopen = () => said.push("open");
      socket.onmessage = ({ data }) => said.push(data);
      const ended = new Promise(resolve => (socket.onclose = resolve));
      const fetched = await fetch(`${origin}/`, { credentials: "include" }).then(response => response.text(), () => null);
      document.querySelector("iframe").src = `${origin}/`;
      await ended;
      await new Promise(resolve => setTimeout(resolve, 500));
      const frame = document.querySelector("iframe");
      let inside = null;
      try { inside = frame.contentWindow.location.href; } catch {}
      return { said, fetched, inside, stored: Object.keys(sessionStorage), cookie: document.cookie };
    },
    [origin, name],
  );
  assert.deepEqual(found, { said: [], fetched: null, inside: null, stored: [], cookie: "" });
  page.on("dialog", dialog => dialog.accept());
  await page.evaluate(theirs => location.assign(theirs), theirs);
  await page.waitForURL(theirs);
  assert.deepEqual(await page.evaluate(() => [document.referrer, ...Object.keys(sessionStorage)]), [""]);
  assert.ok(heads.length >= 2);
  for (const head of heads) assert.ok(!head.includes(token) && !head.includes(name) && !/"cookie"/.test(head), head);
});

test("without a connection the page says nothing about errors, only which text the picture shows", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  page.on("dialog", dialog => dialog.accept());
  const said = async pattern => {
    await page.waitForFunction(pattern => new RegExp(pattern).test(document.querySelector("#stale").textContent), pattern, { timeout: 3000 });
    assert.ok(await page.isVisible("#stale"));
  };
  await page.locator(".cm-line").last().click();
  await page.keyboard.type("x");
  await said("has errors");
  await started.stop("SIGKILL");
  await said("^Without a connection this is the picture of an older text");
  await page.keyboard.press("Backspace");
  await page.waitForFunction(() => document.querySelector("#stale").hidden, null, { timeout: 3000 });
  await page.keyboard.type("// a");
  await said("^Without a connection");
  const again = await serve(started.file, { port: new URL(started.address).port });
  t.after(() => again.stop());
  await page.goto(again.address);
  await page.waitForFunction(() => document.querySelector("#stale").hidden && document.querySelector("#connection-bar").hidden);
});
