// Tests of the host's file: saving it, changes by other programs, and conflicts.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { andFinished, comparing, decoded, FIGURE, finished, hand, host, launch, menu, onPage, open, pixels, rendered, rested, serve, text, type } from "./helpers.mjs";

const NEARER = FIGURE.replace("eye    (3, 3.5, 8)", "eye    (3, 3.5, 6)");
const LARGER = FIGURE.replace("radius 1", "radius 1.5");

/** Opens a page of a host without a file, in a new folder. */
async function withoutFile(t) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-new-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const started = await serve(null, { folder });
  t.after(() => started.stop());
  return { folder, started, page: await open(await launch(t), started) };
}

test("a browser without ImageDecoder shows the same picture", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await page.addInitScript(() => delete window.ImageDecoder);
  await page.reload();
  await finished(page);
  await comparing(page);
  assert.equal(await page.evaluate(() => "ImageDecoder" in window), false);
  assert.equal(await pixels(page), await decoded(page, rendered(started.folder, FIGURE)));
});

test("saving in another editor changes the page", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => started.write(NEARER));
  assert.equal(await text(page), NEARER);
  await comparing(page);
  assert.equal(await pixels(page), await decoded(page, rendered(started.folder, NEARER)));
  assert.equal(await page.textContent("#file-state"), "");
});

test("Save writes the file by key and by button", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, LARGER));
  assert.equal(await page.textContent("#file-state"), "not saved");
  assert.equal(started.text(), FIGURE);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), LARGER);
  await type(page, NEARER);
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), NEARER);
});

test("a removed file is reported, and Save writes it again", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  rmSync(started.file);
  await page.waitForFunction(() => /is gone/.test(document.querySelector("#said").textContent));
  assert.equal(await text(page), FIGURE);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), FIGURE);
});

test("a file that is not UTF-8 is reported and not overwritten", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const latin = Buffer.from(FIGURE.replace("ball,", "b\u00e4ll,"), "latin1");
  started.write(latin);
  await page.waitForFunction(() => /cannot be read: .*UTF-8/.test(document.querySelector("#said").textContent));
  await andFinished(page, () => type(page, LARGER));
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => /is not saved, .*another name/.test(document.querySelector("#said").textContent));
  assert.deepEqual(readFileSync(started.file), latin);
  assert.equal(await text(page), LARGER);
  // The message disappears when the file is valid again.
  started.write(FIGURE);
  await page.waitForFunction(() => /is there again/.test(document.querySelector("#said").textContent));
});

test("a file keeps its CR LF line ends, and is compared without them", async t => {
  const crlf = text => text.replaceAll("\n", "\r\n");
  const started = await host(t, crlf(FIGURE));
  const page = await open(await launch(t), started);
  assert.equal(await page.textContent("#file-state"), "");
  await andFinished(page, () => started.write(crlf(NEARER)));
  assert.equal(await text(page), NEARER);
  assert.ok(await page.isHidden("#conflict-dialog"));
  await andFinished(page, () => type(page, LARGER));
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), crlf(LARGER));
});

test("a file restored with another text is shown if the page has no unsaved text", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  rmSync(started.file);
  await page.waitForFunction(() => /is gone/.test(document.querySelector("#said").textContent));
  await andFinished(page, () => started.write(NEARER));
  assert.equal(await text(page), NEARER);
  assert.equal(await page.textContent("#file-state"), "");
});

test("an outside change of half a surrogate pair replaces the whole character", async t => {
  const started = await host(t, `// 😀\n${FIGURE}`);
  const page = await open(await launch(t), started);
  await andFinished(page, () => started.write(`// 😁\n${FIGURE}`));
  assert.equal(await text(page), `// 😁\n${FIGURE}`);
  // An unpaired surrogate, which some programs put into pasted text, is replaced.
  await page.click(".cm-content");
  await page.keyboard.press("Control+Home");
  await andFinished(page, () =>
    page.evaluate(() => {
      const clipboardData = new DataTransfer();
      clipboardData.setData("text/plain", "// \ud83d\n");
      document.querySelector(".cm-content").dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
    }),
  );
  assert.match(await text(page), /\/\/ \ufffd\n/);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), await text(page));
});

test("the page sends requests only to its host", async t => {
  const started = await host(t);
  const page = await (await launch(t)).newPage();
  const asked = new Set();
  page.on("request", request => asked.add(new URL(request.url()).origin));
  page.on("websocket", socket => asked.add(new URL(socket.url()).host));
  await page.goto(started.address);
  await page.waitForSelector(".hint");
  await page.click("text=Download");
  await Promise.all([page.waitForEvent("download"), page.click("#download-png")]);
  const { origin, host: name } = new URL(started.address);
  assert.deepEqual([...asked].filter(it => it !== origin && it !== name && it !== "null"), []);
});

const saved = page => page.waitForFunction(() => document.querySelector("#file-state").textContent === "");

test("a late answer to Save belongs to the scene that was saved", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, LARGER));
  process.kill(started.pid, "SIGSTOP");
  await page.keyboard.press("Control+s");
  await menu(page, "File", "#new");
  process.kill(started.pid, "SIGCONT");
  await rested(page);
  assert.equal(started.text(), LARGER);
  await andFinished(page, () => type(page, NEARER));
  assert.equal(await page.textContent("#file-state"), "not saved");
  await page.keyboard.press("Control+s");
  await page.waitForSelector("#name-dialog[open]");
  // The name of the host's file is refused, because this file exists.
  await page.fill("#name-field", "scene.scn");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /is there already/.test(document.querySelector("#name-problem").textContent));
  assert.equal(started.text(), LARGER);
  await page.keyboard.press("Escape");
  await page.click("#undo");
  await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), LARGER);
  assert.equal(await page.textContent("#file-state"), "");
});

test("a scene beside the host's can be saved after the host restarts", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  page.on("dialog", dialog => dialog.accept());
  await menu(page, "File", "#new");
  await andFinished(page, () => type(page, LARGER));
  await page.keyboard.press("Control+s");
  await page.fill("#name-field", "beside");
  await page.keyboard.press("Enter");
  await saved(page);
  const { port } = new URL(started.address);
  await started.stop("SIGKILL");
  const again = await serve(started.file, { port });
  t.after(() => again.stop());
  await page.goto(again.address);
  await page.waitForSelector("#connection-bar", { state: "hidden" });
  await andFinished(page, () => type(page, NEARER));
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#said").dataset.tone === "warning");
  assert.equal(readFileSync(path.join(started.folder, "beside.scn"), "utf8"), LARGER);
  await page.keyboard.press("Control+s");
  await page.fill("#name-field", "beside 2");
  await page.keyboard.press("Enter");
  await saved(page);
  assert.equal(readFileSync(path.join(started.folder, "beside 2.scn"), "utf8"), NEARER);
  assert.equal(started.text(), FIGURE);
});

test("New reports that Studio is not ready before the scene arrives", async t => {
  const started = await host(t);
  const context = await (await launch(t)).newContext();
  // Each message of the host arrives 1.5 seconds late.
  await context.addInitScript(() => {
    window.WebSocket = class extends WebSocket {
      addEventListener(type, hear) {
        super.addEventListener(type, type === "message" ? event => setTimeout(() => hear(event), 1500) : hear);
      }
    };
  });
  const page = await context.newPage();
  await page.goto(started.address);
  await menu(page, "File", "#new");
  assert.match(await page.textContent("#said"), /not ready/);
  await finished(page);
  assert.equal(await text(page), FIGURE);
});

test("Studio without a file and New start with the same valid text", async t => {
  const { page } = await withoutFile(t);
  const first = await text(page);
  assert.equal(await page.textContent("#file-state"), "");
  await andFinished(page, () => type(page, FIGURE));
  await andFinished(page, () => menu(page, "File", "#new"));
  assert.equal(await text(page), first);
  assert.equal(await page.textContent("#said"), "");
  // A checkerboard that is added after objects gets the height of their lowest points.
  for (const kind of ["sphere", "box", "checkerboard"]) {
    await andFinished(page, () => menu(page, "+ Add", `[data-kind=${kind}]`));
    await rested(page);
  }
  const made = await text(page);
  const [, ball, radius] = /Sphere1 \{ center \(\S+ (\S+), \S+  radius (\S+)/.exec(made).map(Number);
  const [, box, size] = /Box1 \{ center \(\S+ (\S+), \S+  size \(\S+ (\S+),/.exec(made).map(Number);
  const [, board] = /Checkerboard1 \{ y (\S+)/.exec(made).map(Number);
  assert.deepEqual([ball - radius, box - size / 2], [board, board], made);
});

test("Save asks for the name of a new scene", async t => {
  const { folder, page } = await withoutFile(t);
  await andFinished(page, () => type(page, FIGURE));
  await page.keyboard.press("Control+s");
  await page.fill("#name-field", "other.scn");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#file-name").textContent === "other.scn");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(readFileSync(path.join(folder, "other.scn"), "utf8"), FIGURE);
});

test("Save as writes another file beside the host's and continues with it", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, LARGER));
  await menu(page, "File", "#save-as");
  // The name of an existing file is refused.
  await page.waitForSelector("#name-dialog[open]");
  assert.equal(await page.inputValue("#name-field"), "scene.scn");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /is there already/.test(document.querySelector("#name-problem").textContent));
  await page.keyboard.press("Escape");
  assert.equal(await page.textContent("#file-name"), "scene.scn");
  for (const name of ["second", "third"]) {
    await page.click(".cm-content", { position: { x: 2, y: 5 } });
    await page.keyboard.press("Control+Shift+s");
    await page.fill("#name-field", name);
    await page.keyboard.press("Enter");
    await page.waitForFunction(name => document.querySelector("#file-name").textContent === `${name}.scn`, name);
    assert.equal(await page.textContent("#file-state"), "");
    assert.equal(readFileSync(path.join(started.folder, `${name}.scn`), "utf8"), LARGER);
  }
  await type(page, NEARER);
  await page.keyboard.press("Control+s");
  await saved(page);
  assert.equal(readFileSync(path.join(started.folder, "third.scn"), "utf8"), NEARER);
  assert.equal(readFileSync(path.join(started.folder, "second.scn"), "utf8"), LARGER);
  assert.equal(started.text(), FIGURE);
  // Undo changes only the text; the file's name stays. No draft of the saved text remains.
  await page.click("#undo");
  assert.equal(await text(page), LARGER);
  assert.equal(await page.textContent("#file-name"), "third.scn");
  await page.click("#redo");
  await page.waitForTimeout(900);
  await page.reload();
  await finished(page);
  await page.waitForTimeout(300);
  assert.ok(await page.isHidden("#draft-bar"));
  assert.equal(await text(page), FIGURE);
});

test("Save as of a new scene works like Save", async t => {
  const { folder, page } = await withoutFile(t);
  await andFinished(page, () => type(page, FIGURE));
  await menu(page, "File", "#save-as");
  await page.fill("#name-field", "first");
  await page.keyboard.press("Enter");
  await saved(page);
  await andFinished(page, () => type(page, LARGER));
  await page.keyboard.press("Control+s");
  await saved(page);
  assert.equal(readFileSync(path.join(folder, "first.scn"), "utf8"), LARGER);
});

test("Save adds the ending to a name, and keeps a refused name in the dialog with the reason", async t => {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-new-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  writeFileSync(path.join(folder, "taken.scn"), "");
  const started = await serve(null, { folder });
  t.after(() => started.stop());
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, FIGURE));
  await page.keyboard.press("Control+s");
  for (const [name, reason] of [["a/b", /no path/], ["a:b", /has none of/], ["taken", /something of this name .* start Studio with that file/]]) {
    await page.fill("#name-field", name);
    await page.keyboard.press("Enter");
    await page.waitForFunction(reason => new RegExp(reason).test(document.querySelector("#name-problem").textContent), reason.source);
    assert.ok(await page.isVisible("#name-dialog"));
    assert.equal(await page.inputValue("#name-field"), name);
  }
  await page.fill("#name-field", "my scene");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#file-name").textContent === "my scene.scn");
  assert.equal(readFileSync(path.join(folder, "my scene.scn"), "utf8"), FIGURE);
});

test("a file with mixed line ends keeps them", async t => {
  const ends = ["\r\n", "\n", "\n", "\r\n"];
  const mixed = text => text.split("\n").map((line, i, all) => (i === all.length - 1 ? line : line + ends[i % 4])).join("");
  const started = await host(t, mixed(FIGURE));
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, LARGER));
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  const at = LARGER.split("\n").findIndex(line => line.includes("radius 1.5"));
  const lines = mixed(LARGER).split(/(?<=\n)/);
  const saved = started.text().split(/(?<=\n)/);
  assert.deepEqual(saved.filter((_, i) => i !== at), lines.filter((_, i) => i !== at));
  assert.equal(await text(page), LARGER);
});

test("a file that cannot be written is named with a remedy", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, LARGER));
  const folder = path.dirname(started.file);
  renameSync(folder, `${folder}-away`);
  t.after(() => rmSync(`${folder}-away`, { recursive: true, force: true }));
  await page.waitForFunction(() => /is gone; Save/.test(document.querySelector("#said").textContent));
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => /scene\.scn is not saved: its folder is gone.*download/.test(document.querySelector("#said").textContent));
  assert.equal(await page.textContent("#file-state"), "not saved");
});

for (const [choice, onDisk, onPage] of [
  ["Keep the page's text and save it", LARGER, LARGER],
  ["Take the file's text", NEARER, NEARER],
  ["Decide later", NEARER, LARGER],
]) {
  test(`a conflict of page and file is resolved by choice: ${choice}`, async t => {
    const started = await host(t);
    const page = await open(await launch(t), started);
    await andFinished(page, () => type(page, LARGER));
    started.write(NEARER);
    await page.waitForSelector("#conflict-dialog[open]");
    const lines = page.locator("#conflict-lines");
    assert.deepEqual(await lines.locator(".removed").allTextContents(), ["-   eye    (3, 3.5, 6)", "- sphere   Ball  { center ball  radius 1  color olive }"]);
    assert.deepEqual(await lines.locator(".added").allTextContents(), ["+   eye    (3, 3.5, 8)", "+ sphere   Ball  { center ball  radius 1.5  color olive }"]);
    await page.getByRole("button", { name: choice }).click();
    await page.waitForSelector("#conflict-dialog", { state: "hidden" });
    await page.waitForTimeout(500);
    assert.equal(started.text(), onDisk);
    assert.equal(await text(page), onPage);
    if (onPage === NEARER) {
      await page.click(".cm-content");
      await page.keyboard.press("Control+z");
      assert.equal(await text(page), LARGER);
    }
  });
}

test("an outside save during a drag is shown when the drag ends", async t => {
  const started = await host(t, `let r = 1 // [0.5:0.25:2]\n${FIGURE.replace("radius 1", "radius r")}`);
  const before = started.text();
  const page = await open(await launch(t), started);
  await page.waitForSelector(".slider-row");
  const slider = async () => {
    const { x, y, width, height } = await page.locator(".slider-row input").boundingBox();
    return [x + 8 + (width - 16) / 3, y + height / 2];
  };
  for (const from of [() => onPage(page, [455, 320]), slider]) {
    await hand(page, await from(), [60, 0], { hold: true });
    await rested(page);
    const dragged = await text(page);
    assert.notEqual(dragged, before);
    started.write(before.replace("8)", "6)"));
    await page.waitForTimeout(1000);
    assert.ok(await page.isHidden("#conflict-dialog"));
    // The save by another program does not interrupt the drag.
    const [x, y] = await from();
    await page.mouse.move(x + 90, y, { steps: 6 });
    await rested(page);
    assert.notEqual(await text(page), dragged);
    await page.mouse.up();
    await page.waitForSelector("#conflict-dialog[open]");
    await page.getByRole("button", { name: "Take the file's text" }).click();
    await rested(page);
    assert.equal(await text(page), started.text());
    started.write(before);
    await page.waitForFunction(() => !document.querySelector(".cm-content").textContent.includes("3.5, 6)"));
    await rested(page);
    assert.equal(await text(page), before);
  }
  // If a drag has changed nothing, the page follows the file.
  await page.mouse.move(...(await onPage(page, [455, 320])));
  await page.mouse.down();
  await page.waitForTimeout(200);
  started.write(before.replace("8)", "6)"));
  await page.waitForTimeout(1000);
  assert.equal(await text(page), before);
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector(".cm-content").textContent.includes("3.5, 6)"));
  assert.ok(await page.isHidden("#conflict-dialog"));
});

test("a long rendering shows its progress, and Cancel ends it at once", async t => {
  const slow = FIGURE.replace(/image\s*{[^}]*}/, "").replace(/sampler\s*{[^}]*}/, "") + "\nimage { width 4096  height 4096 }\nsampler { method regular  per_pixel 65536 }\n";
  const started = await host(t);
  const page = await open(await launch(t), started);
  await type(page, slow);
  await page.waitForTimeout(500);
  const choose = async () => {
    await page.click("summary:has-text('Download')");
    await page.click("#download-png");
  };
  for (let i = 0; i < 2; i++) {
    await choose();
    await page.waitForSelector("#rendering:not([hidden])");
    await page.waitForFunction(() => parseFloat(document.querySelector("#percent").textContent) > 0, null, { timeout: 120_000 });
    // The page still responds while a picture is rendered, and refuses to render another one.
    await choose();
    assert.match(await page.textContent("#said"), /Another picture is being made/);
    const took = await page.evaluate(async () => {
      const begin = performance.now();
      document.querySelector("#cancel").click();
      while (!document.querySelector("#rendering").hidden) await new Promise(requestAnimationFrame);
      return performance.now() - begin;
    });
    assert.ok(took < 100, `${took} ms`);
    assert.match(await page.textContent("#said"), /scene\.png was cancelled/);
  }
  // After a cancelled rendering, the next one works.
  await type(page, FIGURE);
  const download = page.waitForEvent("download");
  await choose();
  assert.equal((await download).suggestedFilename(), "scene.png");
});

test("an outside save stops a playing number and is shown at once", async t => {
  const started = await host(t, `let r = 1 // [0.5:0.25:2]\n${FIGURE.replace("radius 1", "radius r")}`);
  const page = await open(await launch(t), started);
  await page.click('[aria-label="Play r"]');
  await page.waitForFunction(() => !document.querySelector(".cm-content").textContent.includes("let r = 1 "));
  started.write(started.text().replace("8)", "6)"));
  await page.waitForSelector("#conflict-dialog[open]", { timeout: 3000 });
  await page.getByRole("button", { name: "Take the file's text" }).click();
  await rested(page);
  assert.equal(await text(page), started.text());
  assert.equal(await page.locator(".play[aria-pressed=true]").count(), 0);
});

test("Save as shows the problem of the current name, not of the previous one", async t => {
  const page = await open(await launch(t), await host(t));
  await menu(page, "File", "#save-as");
  const problem = pattern => page.waitForFunction(pattern => new RegExp(pattern).test(document.querySelector("#name-problem").textContent), pattern, { timeout: 3000 });
  for (const [name, said] of [["a/b", "no path"], ["", "needs a name"], ["a/b", "no path"], ["  ", "needs a name"]]) {
    await page.fill("#name-field", name);
    await page.keyboard.press("Enter");
    await problem(said);
    assert.ok(await page.isVisible("#name-dialog"));
  }
});
