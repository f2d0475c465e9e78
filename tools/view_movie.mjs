#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// A moving picture (WebP) of a run in the viewer, for docs/pictures.
//
//   tools/view_movie.mjs PROGRAM SEQUENCE OUT.webp
//
// The run is live and slow, so that every few frames there is time for a picture of the page. Needs
// `tools/setup --browser webp`.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, statSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { browserLacks, launchBrowser, startView } from "../tests/support/browser.mjs";

const SPEED = "0.09";
const WIDTH = 960, HEIGHT = 600;
const QUALITY = "45";
const SHOWN_MS = 150;  // of each picture
const MOST_BYTES = 2e6;

const [program, sequence, out] = process.argv.slice(2);
if (!out) {
  console.error("usage: tools/view_movie.mjs PROGRAM SEQUENCE OUT.webp");
  process.exit(2);
}
if (browserLacks()) {
  console.error(`tools/view_movie.mjs: no ${browserLacks()}: run tools/setup --browser webp`);
  process.exit(2);
}

const folder = mkdtempSync(path.join(os.tmpdir(), "view_movie"));
const browser = await launchBrowser();
try {
  const page = await browser.newPage({ viewport: { width: WIDTH, height: HEIGHT } });
  const run = await startView(program, ["run", sequence, "--out", path.join(folder, "out"), "--live", "--speed", SPEED,
    "--view", "--segmenter", `detections:${path.join(sequence, "detections")}`]);
  await page.goto(run.url);
  const pictures = [];
  let last = "";
  for (;;) {
    const [frame, status] = await page.evaluate(() => ["frame-number", "status"].map((id) => document.getElementById(id).textContent));
    if (status.startsWith("finished")) break;
    if (frame === last || frame === "") {
      await page.waitForTimeout(30);
      continue;
    }
    last = frame;
    pictures.push(path.join(folder, `${String(pictures.length).padStart(4, "0")}.png`));
    await page.screenshot({ path: pictures.at(-1) });
  }
  execFileSync("img2webp", ["-loop", "0", "-lossy", "-q", QUALITY, "-m", "6", "-d", String(SHOWN_MS), ...pictures, "-o", out],
               { stdio: "ignore" });
  console.log(`${out}: ${pictures.length} pictures, ${statSync(out).size} bytes`);
  if (statSync(out).size > MOST_BYTES) throw new Error(`${out}: more than ${MOST_BYTES} bytes`);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
