// SPDX-License-Identifier: Apache-2.0
// The view in a real browser: `node view_browser_test.mjs PROGRAM FOLDER`. Exits with 77, which
// says why, where there is no browser.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, openSync, readSync, rmSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { browserLacks, launchBrowser, startView } from "./support/browser.mjs";
import { contentOf, gatherErrors } from "./support/page_content.mjs";

const [program, folder] = process.argv.slice(2);
const FRAMES = 40;
const LONGEST_MS = 2000, MOST_BYTES = 1.5e6;

if (browserLacks()) {
  console.log(`skipped: no ${browserLacks()} (tools/setup --browser installs it)`);
  process.exit(77);
}

// How many points a PLY has, by its header.
function pointsIn(file) {
  const head = Buffer.alloc(1000);
  readSync(openSync(file), head, 0, head.length, 0);
  return Number(/element vertex (\d+)/.exec(head.toString("latin1"))[1]);
}

const pointsOn = (page) => page.evaluate(() => Number(document.getElementById("scene").dataset.points || 0));
const untilOnPage = (page, condition, value) => page.waitForFunction(condition, value, { timeout: 30000 });

async function seesARunGoOn(page, sequence, out) {
  const run = await startView(program, ["run", sequence, "--out", out, "--live", "--speed", "0.08", "--view",
    "--view-address", "127.0.0.1:0/a-token-of-the-test", "--segmenter", `detections:${sequence}/detections`]);
  await page.goto(run.url);
  await untilOnPage(page, () => document.getElementById("scene").dataset.points > 0);
  const first = await pointsOn(page);
  await untilOnPage(page, (least) => document.getElementById("scene").dataset.points > least, first);
  await untilOnPage(page, () => /person \d+/.test(document.getElementById("objects").textContent));
  assert.doesNotMatch(await page.textContent("#status"), /finished/, "all of it was seen after the run had ended");
  await untilOnPage(page, () => document.getElementById("status").textContent.startsWith("finished"));
  while (!existsSync(path.join(out, "map.ply")) && run.child.exitCode === null) await page.waitForTimeout(50);
  return run;
}

async function showsAllOfIt(page, out) {
  const points = pointsIn(path.join(out, "map.ply"));
  await untilOnPage(page, (all) => document.getElementById("scene").dataset.points == all, points);
  await page.waitForTimeout(700);  // the scene rests, and is drawn with all points
  const scene = await contentOf(page, "#scene");
  assert.ok(scene.share > 0.1 && scene.colors > 500, `the scene is empty: ${JSON.stringify(scene)}`);
}

// How soon the map is there, and what the page weighs. Only a machine that does little else is timed.
async function isLightAndSoonThere(browser, url, isIdle) {
  const page = await browser.newPage();
  await page.goto(url);
  await untilOnPage(page, () => performance.getEntriesByName("the map is drawn").length > 0);
  const { drawn_ms, bytes } = await page.evaluate(() => ({
    drawn_ms: performance.getEntriesByName("the map is drawn")[0].startTime,
    bytes: ["navigation", "resource"].flatMap((type) => performance.getEntriesByType(type))
      .reduce((sum, entry) => sum + entry.decodedBodySize, 0) }));
  console.log(`the map is drawn ${Math.round(drawn_ms)} ms after the address is opened; the page has ${bytes} bytes`);
  assert.ok(bytes > 1e5 && bytes < MOST_BYTES, `the page has ${bytes} bytes`);
  if (isIdle) assert.ok(drawn_ms < LONGEST_MS, `the map is drawn after ${drawn_ms} ms`);
  await page.close();
}

async function scrubs(page) {
  await page.locator("#scrubber").fill("5");
  assert.match(await page.textContent("#frame-number"), /^\d+ /);
  assert.equal(await page.getAttribute("#newest", "aria-pressed"), "false");
  await page.click("#newest");
  assert.equal(await page.inputValue("#scrubber"), await page.getAttribute("#scrubber", "max"));
}

async function connectsAgain(page, run, out) {
  run.child.kill("SIGINT");
  await run.ended;
  const address = new URL(run.url);
  const show = await startView(program, ["show", out, "--view-address", address.host + address.pathname.slice(0, -1)]);
  assert.equal(show.url, run.url);
  await untilOnPage(page, (title) => document.getElementById("title").textContent === title, out);
  await showsAllOfIt(page, out);
  return show;
}

async function fitsAPhone(browser, url) {
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true });
  const page = await context.newPage(), errors = gatherErrors(page);
  await page.goto(url);
  await untilOnPage(page, () => document.getElementById("scene").dataset.points > 0);
  await page.tap("#above");
  assert.equal(await page.getAttribute("#follow", "aria-pressed"), "false");
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than the screen");
  await page.touchscreen.tap(195, 200);
  assert.deepEqual(errors, []);
  await context.close();
}

const isIdle = os.loadavg()[0] < 0.7 * os.cpus().length;
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const sequence = path.join(folder, "office"), out = path.join(folder, "out");
execFileSync(program, ["synth", sequence, "--scene", "walking_xyz", "--frames", String(FRAMES), "--size", "320x240",
                       "--detections", "imperfect"], { stdio: "ignore" });
const browser = await launchBrowser();
let running = null;
try {
  const page = await browser.newPage({ viewport: { width: 1000, height: 700 } });
  const errors = gatherErrors(page);
  running = await seesARunGoOn(page, sequence, out);
  await showsAllOfIt(page, out);
  const picture = await contentOf(page, "#picture");
  assert.ok(picture.share > 0.5 && picture.colors > 500, `the image is empty: ${JSON.stringify(picture)}`);
  await scrubs(page);
  running = await connectsAgain(page, running, out);
  await fitsAPhone(browser, running.url);
  await isLightAndSoonThere(browser, running.url, isIdle);
  assert.deepEqual(errors, []);
  console.log("the view works in a browser");
} finally {
  await browser.close();
  running?.child.kill("SIGKILL");
}
