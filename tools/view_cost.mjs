#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// The processor time of a run without --view, with it, and with it and a browser attached, in turns.
//
//   tools/view_cost.mjs PROGRAM SEQUENCE [ROUNDS]
//
// User and system time of the program alone, in seconds; of each way the median and the least, and the ratio of the
// medians to that without. Needs `tools/setup --browser`.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { browserLacks, launchBrowser, startView } from "../tests/support/browser.mjs";

const [program, sequence, rounds] = process.argv.slice(2);
if (!sequence) {
  console.error("usage: tools/view_cost.mjs PROGRAM SEQUENCE [ROUNDS]");
  process.exit(2);
}
if (browserLacks()) {
  console.error(`tools/view_cost.mjs: no ${browserLacks()}: run tools/setup --browser`);
  process.exit(2);
}

const folder = mkdtempSync(path.join(os.tmpdir(), "view_cost"));
const timed = ["-c", 'TIMEFORMAT="processor %U %S"; time "$@"', "timed", program, "run", sequence, "--out", path.join(folder, "out"),
               "--segmenter", `detections:${path.join(sequence, "detections")}`];

function seconds(output) {
  const [, user, system] = /processor ([\d.]+) ([\d.]+)/.exec(output);
  return Number(user) + Number(system);
}

async function withoutPage(options) {
  const child = spawn("bash", [...timed, ...options], { stdio: ["ignore", "ignore", "pipe"] });
  let output = "";
  child.stderr.on("data", (text) => { output += text; });
  await new Promise((resolve) => child.on("close", resolve));
  return seconds(output);
}

// The page is open before the run begins, and closed when it has the results.
async function withPage(browser) {
  const run = await startView("bash", [...timed, "--view"]);
  const page = await browser.newPage({ viewport: { width: 1000, height: 700 } });
  await page.goto(run.url);
  await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("finished"), null, { timeout: 300000 });
  const pictures = await page.evaluate(() => Number(document.getElementById("scene").dataset.pictures));
  await page.close();
  await run.ended;
  await new Promise((resolve) => setTimeout(resolve, 100));
  return { processor: seconds(run.output), pictures };
}

const times = { "without --view": [], "--view, no page": [], "--view, a page": [] }, pictures = [];
const browser = await launchBrowser();
try {
  for (let round = 0; round < Number(rounds || 5); ++round) {
    times["without --view"].push(await withoutPage([]));
    times["--view, no page"].push(await withoutPage(["--view"]));
    const run = await withPage(browser);
    times["--view, a page"].push(run.processor);
    pictures.push(run.pictures);
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const base = median(times["without --view"]);
for (const [way, values] of Object.entries(times)) {
  console.log(`${way.padEnd(16)} median ${median(values).toFixed(2)} s, least ${Math.min(...values).toFixed(2)} s, ` +
              `${(100 * (median(values) / base - 1)).toFixed(1)} %   ${values.map((value) => value.toFixed(2)).join(" ")}`);
}
console.log(`pictures that the page received: ${pictures.join(" ")}`);
