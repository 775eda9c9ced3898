// How a test walks the page: node TEST.mjs ADDRESS BROWSER ...
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { setTimeout } from "node:timers/promises";
import { chromium } from "playwright-core";

const kPatienceMs = 240_000;  // of every wait: a busy machine takes many times what an idle one does

const [address, executablePath] = process.argv.slice(2);
const axe = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"], timeout: kPatienceMs });
const faults = [];
let faultsExpected = false;

export { address };

/** While a daemon restarts, lost connections are no fault of the page. */
export function expectFaults(are) {
  faultsExpected = are;
}

/** Refused tokens, unknown boats and a daemon that asks for patience (503) are part of what the page is for. */
function isExpected(text) {
  return faultsExpected || /status of (401|404|503)/.test(text);
}

/** An empty page, whose faults count. */
export async function newPage(width, colorScheme = "light") {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme });
  context.setDefaultTimeout(kPatienceMs);
  const page = await context.newPage();
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" && !isExpected(message.text())) faults.push(message.text());
  });
  page.on("request", (request) => {
    if (!request.url().startsWith(address)) faults.push(`a request to ${request.url()}`);
  });
  return page;
}

/** The page once its boats, or the coefficients of its boat, stand there. */
export async function open(width, colorScheme = "light", hash = "#/") {
  const page = await newPage(width, colorScheme);
  await page.goto(`${address}/${hash}`);
  await page.waitForSelector(hash === "#/" ? "tbody a" : "#coefficients table");
  return page;
}

/** What the daemon answers; it is asked again for as long as it says to come back later. */
export async function answerOf(route) {
  for (;;) {
    const response = await fetch(`${address}/api/v1${route}`);
    if (response.status !== 503) {
      assert.equal(response.status, 200, route);
      return response.json();
    }
    await setTimeout(1000 * Number(response.headers.get("Retry-After") ?? 1));
  }
}

export const count = (page, selector, wanted) =>
  page.waitForFunction(([found, number]) => document.querySelectorAll(found).length === number, [selector, wanted]);

/** Whether it is there within two seconds: what the pointer is on is named in a later frame. */
export const appears = (locator) => locator.first().waitFor({ timeout: 2000 }).then(() => true, () => false);

export const names = (page) => page.locator(".boats tbody th").allTextContents();

/** The boats that have a name on the map, and the box of each name. None covers another or leaves the map. */
export async function namesOnMap(page) {
  const found = await page.evaluate(() => {
    const boxOf = (element) => element.getBoundingClientRect().toJSON();
    return {
      map: boxOf(document.querySelector(".map")),
      names: [...document.querySelectorAll(".map-names span")].map((span) => ({ id: span.textContent, ...boxOf(span) })),
    };
  });
  const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
  found.names.forEach((name, i) => {
    const { map } = found;
    assert.ok(name.left >= map.left && name.right <= map.right && name.top >= map.top && name.bottom <= map.bottom, name.id);
    for (const other of found.names.slice(i + 1)) assert.ok(apart(name, other), `${name.id} covers ${other.id}`);
  });
  return found.names;
}

export async function accessible(page, where) {
  // By the debugger, since the page's own policy lets no foreign script in.
  await page.evaluate(axe);
  const found = await page.evaluate(() => axe.run(document));
  const serious = found.violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), [], where);
}

const overflow = () => document.documentElement.scrollWidth - document.documentElement.clientWidth;

export async function fits(page, where) {
  // A chart takes its new width in the frame after the page does. The condition is a function, not a text: the page's
  // own policy forbids the evaluation of texts, which each frame after the first would need.
  try {
    await page.waitForFunction(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth);
  } catch (cause) {
    throw new Error(`${where} is ${await page.evaluate(overflow)} px too wide`, { cause });
  }
}

/** Takes the steps one after the other, and ends the process. */
export async function walk(steps) {
  for (const [name, step] of Object.entries(steps)) {
    await step();
    assert.deepEqual(faults, [], name);
    console.log(`ok: ${name}`);
  }
  await browser.close();
  process.exit(0);
}
