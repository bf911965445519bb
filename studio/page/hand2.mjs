import { launch, open, host, FIGURE, hand, rested, text } from "./test/helpers.mjs";
const ends = [];
const t = { after: end => ends.push(end) };
const page = await open(await launch(t), await host(t, FIGURE.replace("d      2.75", "fov    40deg")));
await page.waitForTimeout(1200);
const by = async (name, [dx, dy]) => {
  const at = await page.locator(`#outside-handles .handle[data-handle=${name}]`).boundingBox();
  await hand(page, [at.x + at.width / 2, at.y + at.height / 2], [dx, dy], { hold: true });
  await page.waitForTimeout(500);
  await page.screenshot({ path: `/tmp/m/look/f-${name}.png` });
  await page.mouse.up();
  await rested(page);
  console.log((await text(page)).split("\n").slice(5, 14).join(" "));
};
await by("fov", [0, -14]);
await by("view_height", [40, 4]);
for (const end of ends.reverse()) await end();
