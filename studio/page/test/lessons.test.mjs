// Tests of lessons: their list and steps, whether conditions follow changes of the scene, links,
// and a lesson of a teacher.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { andFinished, drag, FIGURE, finished, hand, handle, hold, host, launch, link, menu, open, serve, site, text, type } from "./helpers.mjs";
import { choose, conditions, last, names, read, state, until } from "./lessons.mjs";

test("a lesson is opened, done with the mouse, and left, and no text is lost", async t => {
  const page = await open(await launch(t), await host(t));
  const mine = FIGURE.replace("radius 1", "radius 1.5");
  await andFinished(page, () => type(page, mine));
  await choose(page, 1);
  assert.equal(await text(page), read(names[0], "scn"));
  assert.equal(await page.textContent("#file-name"), `${names[0]}.scn`);
  assert.match(await page.textContent("#lesson-title"), /^1\. The view plane$/);
  // The unsaved text that the lesson's scene has replaced is offered as a draft.
  await page.waitForSelector("#draft-bar:not([hidden])");
  await page.click("#draft-later");
  assert.equal(await state(page), "");
  await last(page);
  await until(page, "0 of 3 hold");
  assert.equal(await page.locator(".condition-mark[aria-label='does not hold:']").count(), 3);
  // The three objects are dragged to the middle of the picture, the front one first.
  for (const [from, held] of [[[265, 292], "1 of 3"], [[513, 253], "2 of 3"], [[316, 155], "Solved."]]) {
    await andFinished(page, () => drag(page, from, [400, 225]));
    await until(page, held);
  }
  assert.ok((await conditions(page)).every(([holds]) => holds));
  await page.click("#lesson-list");
  assert.match(await page.textContent("#lesson-body li:first-child"), /✓/);
  // Returning to the lesson does not change the text. `Start again` restores the lesson's own
  // scene.
  const solved = await text(page);
  await page.click("#lesson-body li:first-child button");
  assert.equal(await text(page), solved);
  await andFinished(page, () => page.click("#lesson-again"));
  assert.equal(await text(page), read(names[0], "scn"));
  await until(page, "0 of 3 hold");
  await andFinished(page, () => page.click("#lesson-close"));
  assert.ok(await page.isHidden("#lesson"));
  assert.equal(new URL(page.url()).hash, "");
  assert.equal(await text(page), mine);
  assert.deepEqual(page.complaints, []);
});

test("the printed page has the open lesson as a whole", async t => {
  const page = await open(await launch(t), await host(t));
  const paper = async () => {
    await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
    await page.emulateMedia({ media: "print" });
    const said = await page.locator("#print-lesson").innerText();
    await page.emulateMedia({ media: null });
    await page.evaluate(() => dispatchEvent(new Event("afterprint")));
    return said;
  };
  assert.equal(await paper(), "");
  await choose(page, 1);
  await last(page);
  await until(page, "0 of 3 hold");
  const said = await paper();
  // The printed lesson has its title, all steps, and each condition with its mark.
  for (const heading of ["1. The view plane", ...read(names[0], "md").match(/(?<=^## ).*$/gm)]) assert.ok(said.includes(heading), `${heading} in\n${said}`);
  assert.equal(said.match(/○/g).length, 3);
  assert.ok(await page.isHidden("#print-lesson"));
  await page.click("#lesson-close");
  assert.equal(await paper(), "");
});

test("Undo stays in a lesson, and each lesson keeps its text until the page is reloaded", async t => {
  const page = await open(await launch(t), await host(t));
  const mine = FIGURE.replace("radius 1", "radius 1.5");
  await andFinished(page, () => type(page, mine));
  const scenes = [0, 1].map(i => read(names[i], "scn"));
  const changed = scenes.map(scene => `${scene}// changed\n`);
  for (const i of [0, 1]) {
    await choose(page, i + 1);
    await andFinished(page, () => type(page, changed[i]));
    for (let undone = 0; undone < 4; undone++) {
      await page.click(".cm-content");
      await page.keyboard.press("Control+z");
    }
    assert.equal(await text(page), scenes[i]);
    assert.equal(await page.textContent("#file-name"), `${names[i]}.scn`);
    await andFinished(page, () => type(page, changed[i]));
  }
  // Layers of one lesson are not shown in the next.
  await menu(page, "Show", "#layers >> text=Horizon");
  await page.waitForSelector("#lines .horizon", { state: "attached" });
  await choose(page, 3);
  assert.equal(await page.locator("#lines .horizon").count(), 0);
  await andFinished(page, () => page.goBack());
  // Only the user's own text is offered as a draft, not the texts of lessons.
  assert.equal(await page.locator("#draft-choices li").count(), 1);
  // Back leads to the first lesson with its changed text, and from there to the user's own text.
  await andFinished(page, () => page.goBack());
  assert.equal(await text(page), changed[0]);
  await andFinished(page, () => page.goBack());
  assert.ok(await page.isHidden("#lesson"));
  assert.equal(await text(page), mine);
  // Drafts are compared with the text half a second after its last change.
  await page.waitForSelector("#draft-bar", { state: "hidden", timeout: 5000 });
  assert.deepEqual(page.complaints, []);
});

test("conditions are judged after a drag and not during it, one request at a time", async t => {
  const page = await open(await launch(t), await host(t), { late: { "pinhole/lesson": 1500 } });
  await choose(page, 1);
  await last(page);
  await until(page, "0 of 3 hold");
  const asked = [];
  const session = await page.context().newCDPSession(page);
  await session.send("Network.enable");
  session.on("Network.webSocketFrameSent", ({ response }) => response.payloadData.includes('"pinhole/lesson"') && asked.push(Date.now()));
  await page.selectOption("#objects", { index: 1 });
  const object = await page.locator("#handles .handle").first().getAttribute("aria-label");
  const [x, y] = await handle(page, object);
  const before = await text(page);
  await hand(page, [x, y], [30, 0], { hold: true });
  await page.waitForTimeout(1000);
  assert.notEqual(await text(page), before);
  assert.equal(asked.length, 0);
  await page.mouse.up();
  while (asked.length === 0) await page.waitForTimeout(20);
  // The pauses in typing are longer than the delay before the page sends a request, but shorter
  // than the delay of the answer.
  await page.focus(".cm-content");
  await page.keyboard.press("Control+End");
  for (const letter of "// ab") {
    await page.keyboard.type(letter);
    await page.waitForTimeout(250);
  }
  await page.waitForTimeout(3500);
  assert.ok(asked.length >= 2 && asked.length <= 3, `${asked.length}`);
  asked.slice(1).forEach((at, i) => assert.ok(at - asked[i] >= 1400, `${at - asked[i]} ms after`));
  assert.equal(await state(page), "0 of 3 hold");
});

test("every lesson is solved by its solution, and by nothing less", async t => {
  const page = await open(await launch(t), await host(t));
  for (const [i, name] of names.entries()) {
    await choose(page, i + 1);
    assert.equal(await text(page), read(name, "scn"), name);
    await last(page);
    await page.waitForFunction(() => / of \d hold/.test(document.querySelector("#lesson-state").textContent));
    const before = await conditions(page);
    assert.ok(before.length > 0 && before.some(([holds]) => !holds), name);
    // The conditions of this step are counted, not those of other steps.
    assert.match(await state(page), new RegExp(`^${before.filter(([holds]) => holds).length} of ${before.length} hold$`));
    // Each condition is described in words, not by a path such as `inspect/camera`.
    for (const [, words] of before) assert.ok(!/[a-z]\/[a-z]/.test(words), words);
    await andFinished(page, () => type(page, read(name, "solution.scn")));
    await until(page, "Solved.");
    assert.ok((await conditions(page)).every(([holds]) => holds), name);
  }
  assert.deepEqual(page.complaints, []);
});

test("a lesson is done by keyboard alone", async t => {
  const page = await open(await launch(t), await host(t));
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.textContent);
  const tabTo = async (id, key = "Tab") => {
    for (let i = 0; i < 60 && (await focused()) !== id; i++) await page.keyboard.press(key);
    assert.equal(await focused(), id);
  };
  await page.focus("#undo");
  await tabTo("lessons");
  await page.keyboard.press("Enter");
  assert.equal(await focused(), "lesson-title");
  await tabTo("8. Singular cases");
  await andFinished(page, () => page.keyboard.press("Enter"));
  assert.equal(await focused(), "lesson-title");
  await tabTo("lesson-next");
  for (let i = 0; i < 3; i++) await page.keyboard.press("Enter");
  await page.waitForSelector(".conditions li");
  await tabTo("lesson-back");
  await page.keyboard.press("Enter");
  assert.equal(await page.locator(".conditions").count(), 0);
  await tabTo("lesson-close");
  await page.keyboard.press("Enter");
  assert.equal(await focused(), "lessons");
  assert.ok(await page.isHidden("#lesson"));
});

test("a lesson starts with the usual tools and without layers, and leaving it shows the layers again", async t => {
  const page = await open(await launch(t), await host(t));
  const layers = () => page.locator("#layers [name]:checked").evaluateAll(all => all.map(it => it.name));
  const tool = () => page.locator("input[name=tool]:checked").getAttribute("value");
  await menu(page, "Show", "#layers >> text=Horizon");
  await page.keyboard.press("Escape");
  for (const number of [1, 5]) {
    await page.selectOption("#objects", { index: 1 });
    await hold(page, "z");
    await page.focus("#stage");
    await page.keyboard.press("o");
    assert.deepEqual([await tool(), await layers()], ["orbit", number === 1 ? ["horizon"] : []]);
    await andFinished(page, () => choose(page, number));
    assert.deepEqual([await tool(), await layers()], ["move", []]);
    await page.selectOption("#objects", { index: 1 });
    await page.waitForSelector("#along:not([hidden])");
    assert.notEqual(await page.locator("input[name=along]:checked").getAttribute("value"), "z");
  }
  await page.click("#lesson-close");
  assert.deepEqual(await layers(), ["horizon"]);
});

test("a warning about a link is gone when the next link is right", async t => {
  const page = await open(await launch(t), await host(t));
  const said = text => page.waitForFunction(text => document.querySelector("#said").textContent === text, text);
  for (const [wrong, message] of [["lesson=77", "There is no lesson 77."], ["scene=!!!", "The link is damaged: its scene cannot be read."]]) {
    await page.evaluate(hash => { location.hash = hash; }, wrong);
    await said(message);
    await page.evaluate(() => { location.hash = "lesson=2"; });
    await said("");
  }
});

test("a link opens a lesson, also after a reload, and Back leaves it", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => page.goto(`${new URL(started.address).origin}/#lesson=4`));
  assert.equal(await text(page), read(names[3], "scn"));
  await page.reload();
  await finished(page);
  await page.waitForSelector("#lesson:not([hidden])");
  assert.equal(await text(page), read(names[3], "scn"));
  await andFinished(page, () => page.goto(`${new URL(started.address).origin}/#lesson=5`));
  assert.equal(await text(page), read(names[4], "scn"));
  await andFinished(page, () => page.goBack());
  assert.match(await page.textContent("#lesson-title"), /^4\./);
  await page.goto(`${new URL(started.address).origin}/#lesson=99`);
  await page.waitForFunction(() => /no lesson 99/.test(document.querySelector("#said").textContent));
});

test("a link opens a scene with layers on, also after a reload, and Share makes it", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const scene = read(names[3], "scn");
  await andFinished(page, () => type(page, scene));
  await menu(page, "Show", "#layers >> text=Vanishing points");
  await page.click("#layers >> text=Horizon");
  const address = await link(page);
  assert.match(address, /#scene=[\w-]+&show=vanishing,horizon$/);
  const other = await page.context().browser().newContext();
  const shown = await other.newPage();
  const { hash } = new URL(started.address);
  await shown.goto(`${address}&${hash.slice(1)}`);
  for (let i = 0; i < 2; i++) {
    await finished(shown);
    assert.equal(await text(shown), scene);
    await shown.waitForSelector("#lines .horizon", { state: "attached" });
    await shown.waitForSelector("#lines .axis-z", { state: "attached" });
    assert.deepEqual(await shown.locator("#layers [name]:checked").evaluateAll(all => all.map(it => it.name)), ["vanishing", "horizon"]);
    await shown.reload();
  }
  // Another address in the open page changes the layers.
  await shown.goto(`${address.split("&")[0]}&show=axis`);
  await shown.waitForSelector("#lines .view-axis", { state: "attached" });
  assert.equal(await shown.locator("#lines .horizon").count(), 0);
});

const LESSON = `# <b>Mine</b>

One <img src=x onerror="window.broken = 1"> [link](https://example.com) and \`code\`.

## Task

Make the ball larger.

\`\`\`check
inspect/objects/Ball/radius > start  // Ball is larger
\`\`\`

Then make it yellow.

\`\`\`check
inspect/objects/Ball/color = "#ffff00"
\`\`\`
`;

test("a teacher's lesson runs, with its own scene or a student's, and shows no foreign HTML", async t => {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-lesson-"));
  const [lesson, mine] = [path.join(folder, "mine.md"), path.join(folder, "student.scn")];
  writeFileSync(lesson, LESSON);
  writeFileSync(path.join(folder, "mine.scn"), FIGURE);
  writeFileSync(mine, FIGURE.replace("radius 1", "radius 1.5"));
  const browser = await launch(t);
  const hosts = [await serve(null, { folder, lesson }), await serve(mine, { lesson })];
  t.after(() => {
    for (const started of hosts) started.stop();
    rmSync(folder, { recursive: true, force: true });
  });
  const page = await open(browser, hosts[0]);
  await page.waitForSelector("#lesson:not([hidden])");
  assert.equal(await text(page), FIGURE);
  assert.equal(await page.textContent("#file-name"), "mine.scn");
  assert.equal(await page.textContent("#lesson-title"), "<b>Mine</b>");
  assert.equal(await page.locator("#lesson-body :is(img, a, b)").count(), 0);
  assert.match(await page.textContent("#lesson-body"), /<img .* link and code\./);
  await page.click("#lesson-next");
  await until(page, "0 of 2 hold");
  assert.deepEqual(await page.locator(".conditions li").evaluateAll(all => all.map(it => it.textContent)), ["○Ball is largernow 1, at the start 1", '○inspect/objects/Ball/color = "#ffff00"now #808000']);
  await andFinished(page, () => type(page, FIGURE.replace("radius 1", "radius 2")));
  await until(page, "1 of 2 hold");
  // While the text has errors, the marks of the conditions stay as they are.
  await type(page, "camera {}");
  await page.waitForTimeout(500);
  assert.equal(await state(page), "1 of 2 hold");
  await andFinished(page, () => type(page, FIGURE.replace("radius 1", "radius 2").replace("olive", "yellow")));
  await until(page, "Solved.");
  assert.equal(await page.evaluate(() => window.broken), undefined);
  // A lesson that was changed is shown after a reload.
  writeFileSync(lesson, LESSON.replace("<b>Mine</b>", "Changed").replace("> start", "< oops"));
  page.on("dialog", dialog => dialog.accept());
  await page.reload();
  await finished(page);
  await until(page, "line 10 of the lesson: `oops` is no value for `<`");
  assert.equal(await page.textContent("#lesson-title"), "Changed");
  writeFileSync(lesson, LESSON);
  const other = await open(browser, hosts[1]);
  await other.click("#lesson-next");
  await until(other, "1 of 2 hold");
  assert.equal(await text(other), FIGURE.replace("radius 1", "radius 1.5"));
  await other.click("#lessons");
  await other.click("#lessons");
  assert.match(await other.textContent("#lesson-body li:first-child"), /Mine/);
  await andFinished(other, () => other.click("#lesson-body li:nth-child(2) button"));
  assert.equal(await text(other), read(names[0], "scn"));
  // The page parses HTML in a document without a window, where no handler can run. The browser
  // complains about the handlers in it anyway, so these complaints are ignored.
  const complaints = [page, other].flatMap(({ complaints }) => complaints);
  assert.deepEqual(complaints.filter(it => !it.startsWith("Executing inline event handler violates")), []);
});

/** Starts a host with a teacher's lesson. The host's scene is a student's file, or a new scene if
 * `student` is null. */
async function teacher(t, lesson, student = null) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-lesson-"));
  const [md, file] = [path.join(folder, "mine.md"), path.join(folder, "student.scn")];
  writeFileSync(md, lesson);
  writeFileSync(path.join(folder, "mine.scn"), FIGURE);
  if (student !== null) writeFileSync(file, student);
  const started = await serve(student === null ? null : file, { folder, lesson: md });
  t.after(() => {
    started.stop();
    rmSync(folder, { recursive: true, force: true });
  });
  return started;
}

test("a teacher's lesson about a student's file shows that file again after another lesson", async t => {
  const student = FIGURE.replace("radius 1", "radius 1.5");
  const started = await teacher(t, LESSON, student);
  const page = await open(await launch(t), started);
  const isBack = async () => {
    assert.equal(await text(page), student);
    assert.equal(await page.textContent("#file-name"), "student.scn");
    if ((await page.textContent("#lesson-next")) === "Next ▸") await page.click("#lesson-next");
    await until(page, "1 of 2 hold");
  };
  await isBack();
  const another = async () => {
    if (await page.isHidden("#lesson-body li button")) await page.click("#lesson-list");
    await andFinished(page, () => page.click("#lesson-body li:nth-child(2) button"));
    assert.equal(await text(page), read(names[0], "scn"));
  };
  await another();
  await page.click("#lesson-list");
  await andFinished(page, () => page.click("#lesson-body li:nth-child(1) button"));
  await isBack();
  await another();
  await andFinished(page, () => page.goBack());
  await isBack();
  await another();
  await andFinished(page, () => page.goto(`${new URL(started.address).origin}/#lesson=0`));
  await isBack();
});

const RICH = `# The **bold** \`title\`

> A quotation of ~~struck~~ text

#### A small heading

| a | b |
| --- | --- |
| 1 | **2** |

![An olive ball](ball.png) and ![](empty.png)

- [x] done

\`\`\`check-list
inspect/camera/d > 100
\`\`\`

  \`\`\`check
  inspect/camera/d > 101
  \`\`\`

<!--
\`\`\`check
inspect/camera/d > 0
\`\`\`
-->

## Task

~~~check
inspect/camera/d > 2  // d is large
inspect/camera/d > 3
~~~
`;

test("a lesson's Markdown is shown as such, and its checks are those of the engine", async t => {
  const page = await open(await launch(t), await teacher(t, RICH));
  assert.equal(await page.textContent("#lesson-title"), "The bold title");
  const body = page.locator("#lesson-body");
  for (const [selector, words] of [["blockquote", "A quotation of struck text"], ["del", "struck"], ["h4", "A small heading"], ["table th:nth-child(2)", "b"], ["table td strong", "2"]])
    assert.equal((await body.locator(selector).textContent()).trim(), words);
  const shown = await body.textContent();
  assert.match(shown, /An olive ball and/);
  assert.match(shown, /☑ done/);
  assert.doesNotMatch(shown, /<\w|> 0/);
  assert.equal(await body.locator("img, input, .conditions").count(), 0);
  assert.deepEqual((await body.locator("pre").allTextContents()).map(it => it.trim()), ["inspect/camera/d > 100", "inspect/camera/d > 101"]);
  await page.click("#lesson-next");
  await until(page, "1 of 2 hold");
  assert.deepEqual(await conditions(page), [[true, "d is large"], [false, "inspect/camera/d > 3"]]);
});

for (const [width, height] of [[400, 800], [400, 640], [1280, 720]]) {
  test(`a lesson is legible at ${width} × ${height}`, async t => {
    const page = await open(await launch(t), await host(t), { viewport: { width, height } });
    await page.click("#lessons");
    if (height < 700) await page.click("#tabs [data-tab=text]");
    for (const [i] of names.entries()) {
      if (await page.isHidden("#lesson-body li button")) await page.click("#lesson-list");
      await page.click(`#lesson-body li:nth-child(${i + 1}) button`);
      for (;;) {
        const found = await page.evaluate(() => {
          const panel = document.querySelector("#lesson").getBoundingClientRect();
          const body = document.querySelector("#lesson-body");
          const buttons = [...document.querySelectorAll("#lesson button")].map(it => it.getBoundingClientRect());
          return {
            wide: document.documentElement.scrollWidth - innerWidth,
            inside: buttons.every(it => it.right <= innerWidth && it.bottom <= panel.bottom + 1 && it.height >= 24),
            across: body.scrollWidth - body.clientWidth,
            lines: body.clientHeight / parseFloat(getComputedStyle(body).lineHeight),
            size: parseFloat(getComputedStyle(body).fontSize),
          };
        });
        assert.deepEqual([found.wide, found.inside, found.across], [0, true, 0], JSON.stringify(found));
        // At least three lines of the lesson are visible without scrolling.
        assert.ok(found.lines >= 3 && found.size >= 14, JSON.stringify(found));
        if ((await page.textContent("#lesson-next")) !== "Next ▸") break;
        await page.click("#lesson-next");
      }
    }
    // The editor is still visible beside the lesson.
    assert.ok((await page.locator(".cm-editor").boundingBox()).height > 20);
  });
}

const skip = process.env.SITE === undefined ? "SITE names no folder" : false;

test("the static page has the lessons, and its engine judges them", { skip }, async t => {
  const { address } = await site(t, process.env.SITE);
  const page = await open(await launch(t), { address: `${address}#lesson=2` });
  await last(page);
  await until(page, "2 of 3 hold");
  assert.equal(await text(page), read(names[1], "scn"));
  await andFinished(page, () => type(page, read(names[1], "solution.scn")));
  await until(page, "Solved.");
  // One condition of lesson 7 is about the error, so the engine must compute an exact picture.
  await choose(page, 7);
  await last(page);
  await until(page, "3 of 4 hold");
  await andFinished(page, () => type(page, read(names[6], "solution.scn")));
  await until(page, "Solved.");
  assert.deepEqual(page.complaints, []);
});
