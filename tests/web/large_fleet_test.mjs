// Walks the page of a real daemon with many boats in a real browser:
//   node large_fleet_test.mjs ADDRESS BROWSER BOATS
// Exits 0 when all is well. It counts what the page does and holds no clock against it, since that would tell of the
// machine: bench/page_speed.mjs measures.
import assert from "node:assert/strict";
import { address, count, names, newPage, open, walk } from "./page_walk.mjs";

const boats = Number(process.argv[4]);
const kRowsAtOnce = 100;

/** Counts what so many reports of the daemon change of the table. */
function changesOf(page, reports) {
  return page.evaluate((wanted) => new Promise((resolve) => {
    const changed = { nodes: 0, texts: 0 };
    new MutationObserver((records) => {
      for (const { type, addedNodes, removedNodes } of records) {
        if (type === "characterData") changed.texts += 1;
        else changed.nodes += addedNodes.length + removedNodes.length;
      }
    }).observe(document.querySelector(".boats tbody"), { childList: true, subtree: true, characterData: true });
    let seen = 0;
    new EventSource("api/v1/events").addEventListener("fleet", () => {
      seen += 1;
      if (seen === wanted) resolve(changed);
    });
  }), reports);
}

await walk({
  async "something is painted before the script and the boats are there"() {
    const page = await newPage(1280);
    let painted;
    const isPainted = new Promise((resolve) => { painted = resolve; });
    await page.route("**/page.js", (route) => isPainted.then(() => route.continue()));
    await page.goto(`${address}/`, { waitUntil: "commit" });
    await page.waitForFunction(() => performance.getEntriesByName("first-contentful-paint").length > 0);
    assert.equal(await page.getByRole("status").textContent(), "Connecting");
    painted();
    await page.waitForSelector("tbody a");
    await page.context().close();
  },
  async "the table holds a part of the fleet, and its controls reach all of it"() {
    const page = await open(1280);
    await count(page, ".boats tbody tr", kRowsAtOnce);
    const counted = await page.locator(".count strong").allTextContents();
    assert.equal(counted.map(Number).reduce((sum, number) => sum + number), boats);
    await page.getByRole("button", { name: "Boat", exact: true }).click();
    const first = (await names(page))[0];
    await page.getByRole("button", { name: "Boat", exact: true }).click();
    const last = (await names(page))[0];
    assert.ok(first < last);
    await page.getByRole("searchbox").fill(first);
    await count(page, ".boats tbody tr", 1);
    assert.deepEqual(await names(page), [first]);
    await page.getByRole("searchbox").fill("");
    await page.getByRole("button", { name: `Show ${kRowsAtOnce} more of ${boats}` }).click();
    await count(page, ".boats tbody tr", 2 * kRowsAtOnce);
    await page.context().close();
  },
  async "a report of the daemon changes texts of the rows that are shown, and makes none anew"() {
    const page = await open(1280);
    await count(page, ".boats tbody tr", kRowsAtOnce);
    const columns = await page.locator(".boats thead th").count();
    const reports = 5;
    const changed = await changesOf(page, reports);
    assert.equal(changed.nodes, 0);
    // The page may hear of one more than is counted.
    assert.ok(changed.texts <= (reports + 1) * kRowsAtOnce * columns, `${changed.texts} texts`);
    await page.context().close();
  },
});
