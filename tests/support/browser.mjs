// SPDX-License-Identifier: Apache-2.0
// A headless Chromium, and the program with its view: for tests and tools/view_movie.mjs.
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const CHROMIUM = "/usr/bin/chromium";
const PLAYWRIGHT = path.join(root, "build/browser/node_modules/playwright-core");

// What is missing for a browser; empty if nothing.
export function browserLacks() {
  const lacks = [];
  if (!existsSync(CHROMIUM)) lacks.push("chromium");
  if (!existsSync(PLAYWRIGHT)) lacks.push("playwright-core in build/browser");
  return lacks.join(", ");
}

export function launchBrowser() {
  const { chromium } = createRequire(import.meta.url)(PLAYWRIGHT);
  return chromium.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

// Starts the program; resolves when it has printed the address of its page.
export function startView(program, options) {
  const child = spawn(program, options, { stdio: ["ignore", "pipe", "pipe"] });
  const running = { child, output: "" };
  running.ended = new Promise((resolve) => child.on("exit", (code, signal) => resolve({ code, signal })));
  return new Promise((resolve, reject) => {
    for (const stream of [child.stdout, child.stderr]) {
      stream.on("data", (text) => {
        running.output += text;
        running.url = running.url || /http:\/\/\S+/.exec(running.output)?.[0];
        if (running.url) resolve(running);
      });
    }
    running.ended.then(() => reject(new Error(`no view: ${running.output}`)));
  });
}
