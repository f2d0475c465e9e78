// SPDX-License-Identifier: Apache-2.0
// report.html in a real browser, opened from the disk: `node report_browser_test.mjs PROGRAM FOLDER`. Exits with 77,
// which says why, where there is no browser.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, rmSync, statSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { browserLacks, launchBrowser } from "./support/browser.mjs";
import { contentOf, gatherErrors } from "./support/page_content.mjs";

const [program, folder] = process.argv.slice(2);
const MOST_BYTES = 5e6;

if (browserLacks()) {
  console.log(`skipped: no ${browserLacks()} (tools/setup --browser installs it)`);
  process.exit(77);
}

// A page with the report, which must load nothing but itself.
async function openReport(browser, file, options) {
  const context = await browser.newContext({ offline: true, ...options });
  const page = await context.newPage(), asked = [];
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) asked.push(request.url()); });
  const errors = gatherErrors(page), address = pathToFileURL(file).href;
  await page.goto(address);
  await page.waitForFunction(() => document.querySelector("#map-view .scene")?.dataset.points > 0);
  await page.waitForTimeout(700);  // the scene rests, and is drawn with all points
  return { page, end: async () => {
    assert.deepEqual(errors, []);
    assert.deepEqual(asked, [address]);
    await context.close();
  } };
}

async function showsTheMapWithItsObjects(page) {
  const scene = "#map-view .scene", whole = await contentOf(page, scene);
  assert.ok(whole.share > 0.2 && whole.colors > 1000, `the map is empty: ${JSON.stringify(whole)}`);
  const tool = (name) => page.locator(`[data-tool=${name}]`);
  const pictures = { all: await page.locator(scene).screenshot() };
  for (const what of ["objects", "path", "keyframes", "ceiling"]) {
    await tool(what).uncheck();
    await page.waitForTimeout(200);
    pictures[what] = await page.locator(scene).screenshot();
    assert.ok(!pictures[what].equals(pictures.all), `without ${what} nothing changes`);
    await tool(what).check();
  }
  await tool("above").click();
  await page.waitForTimeout(700);
  const above = await contentOf(page, scene);
  assert.ok(above.share > 0.1, `nothing from above: ${JSON.stringify(above)}`);
}

async function playsItsFrames(page) {
  const scrubber = page.locator("[data-tool=scrubber]");
  await scrubber.fill("3");
  await page.click("[data-tool=play]");
  await page.waitForFunction(() => Number(document.querySelector("[data-tool=scrubber]").value) > 5);
  await page.click("[data-tool=play]");
  assert.match(await page.textContent("[data-tool=time]"), /^\d+\.\d s$/);
  const moving = [];
  for (let frame = 0; frame < 40; ++frame) {
    await scrubber.fill(String(frame));
    moving.push(Number(await page.getAttribute("#map-view .scene", "data-moving")));
  }
  const playing = moving.filter((points) => points > 100).length;
  assert.ok(playing > 30, `people walk in ${playing} of 40 frames: ${moving}`);
}

async function fitsAPhone(page) {
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than the screen");
  const content = await contentOf(page, "#map-view .scene");
  assert.ok(content.share > 0.1 && content.colors > 500, `the map is empty: ${JSON.stringify(content)}`);
}

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const sequence = path.join(folder, "office"), out = path.join(folder, "out"), report = path.join(out, "report.html");
execFileSync(program, ["synth", sequence, "--scene", "walking_xyz", "--frames", "40", "--size", "320x240",
                       "--detections", "imperfect"], { stdio: "ignore" });
execFileSync(program, ["run", sequence, "--out", out, "--keep-movers", "--segmenter", `detections:${sequence}/detections`], { stdio: "ignore" });
assert.ok(statSync(report).size < MOST_BYTES, `the report has ${statSync(report).size} bytes`);
const browser = await launchBrowser();
try {
  const desktop = await openReport(browser, report, { viewport: { width: 1200, height: 900 } });
  await showsTheMapWithItsObjects(desktop.page);
  await playsItsFrames(desktop.page);
  await desktop.end();
  const phone = await openReport(browser, report, { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true });
  await fitsAPhone(phone.page);
  await phone.end();
  console.log("the report works in a browser");
} finally {
  await browser.close();
}
