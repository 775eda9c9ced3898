// Walks the page of a real daemon in a real browser:
//   node page_test.mjs ADDRESS BROWSER BOAT TOKEN PICTURES
// Exits 0 when all is well. It restarts nothing itself: page_test.py writes "restarted" to its standard input.
import assert from "node:assert/strict";
import { createInterface } from "node:readline";
import { accessible, address, answerOf, appears, count, expectFaults, fits, names, namesOnMap, newPage, open, walk } from "./page_walk.mjs";

const [boat, token, pictures] = process.argv.slice(4);

await walk({
  async "the worst come first, and a header sorts"() {
    const page = await open(1280);
    const verdicts = (await page.locator(".boats .badge").allTextContents()).map((text) => text.trim().split(" ").at(-1));
    const rank = ["ERROR", "STALE", "WARN", "OK"];
    assert.deepEqual(verdicts, [...verdicts].sort((a, b) => rank.indexOf(a) - rank.indexOf(b)));
    await page.getByRole("button", { name: "Boat", exact: true }).click();
    const ascending = await names(page);
    assert.deepEqual(ascending, [...ascending].sort());
    await page.getByRole("button", { name: "Boat", exact: true }).click();
    assert.deepEqual(await names(page), ascending.reverse());
    assert.equal(await page.locator("th[aria-sort=descending]").count(), 1);
    await page.context().close();
  },
  async "search and verdict buttons select"() {
    const page = await open(1280);
    const all = (await names(page)).length;
    await page.getByRole("searchbox").fill(boat.toUpperCase());
    assert.deepEqual(await names(page), [boat]);
    await page.getByRole("searchbox").fill("no such boat");
    await page.getByText("No boat matches.").waitFor();
    await page.getByRole("searchbox").fill("");
    const stale = page.getByRole("button", { name: /STALE/ });
    await stale.click();
    // At one instant, since a boat that sends may fall silent between two.
    const shown = await page.evaluate(() => ({
      counted: Number(document.querySelector(".count.stale strong").textContent),
      verdicts: [...document.querySelectorAll(".boats tbody tr")].map((row) => row.className),
    }));
    assert.ok(shown.counted > 0 && shown.counted < all);
    assert.deepEqual(shown.verdicts, Array(shown.counted).fill("stale"));
    await stale.click();
    await count(page, ".boats tbody tr", all);
    await page.context().close();
  },
  async "the map names the boat that the focus is on, and the one that the pointer is on"() {
    const page = await open(1280);
    await page.locator(".map-names span").first().waitFor();
    const named = page.locator(".map-names .pointed-at");
    await page.getByRole("searchbox").fill(boat);
    const placesBesideTheName = async () => {
      await page.getByRole("searchbox").focus();
      await page.keyboard.press("ArrowDown");
      await named.getByText(boat, { exact: true }).waitFor();
      const [{ left, right, top, bottom }] = (await namesOnMap(page)).filter(({ id }) => id === boat);
      await page.getByRole("searchbox").focus();
      await named.waitFor({ state: "detached" });
      const [x, y] = [(left + right) / 2, (top + bottom) / 2];
      return [[left - 11, y], [right + 11, y], [x, bottom + 11], [x, top - 11]];
    };
    // The boat stands beside its name, in one of the places around it. It may have left the place by the time that a
    // busy machine has drawn it, so that each try asks for them again.
    const pointed = async () => {
      for (const [x, y] of await placesBesideTheName()) {
        await page.mouse.move(x, y);
        if (await appears(named)) return true;
      }
      await page.mouse.move(0, 0);
      return false;
    };
    for (let tries = 0; tries < 5; ++tries) if (await pointed()) break;
    assert.deepEqual(await named.allTextContents(), [boat]);
    await page.context().close();
  },
  async "the keyboard alone reaches a boat and comes back"() {
    const page = await open(1280);
    await page.keyboard.press("/");
    await page.keyboard.type(boat);
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { level: 1, name: boat }).waitFor();
    await page.locator("#tab-SURGE").focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#tab-SWAY").getAttribute("aria-selected"), "true");
    await page.goBack();
    await page.getByRole("searchbox").waitFor();
    await page.context().close();
  },
  async "the boat view shows what the API tells"() {
    const page = await open(1280, "light", `#/boat/${boat}`);
    const models = await answerOf(`/vehicles/${boat}/models`);
    const report = await answerOf(`/vehicles/${boat}/diagnosis`);
    await page.getByText(report.sentence).waitFor();
    const surge = models.models[0].coefficients.filter(({ equation }) => equation === "SURGE");
    await count(page, ".coefficients tbody tr", surge.length);
    await count(page, ".coefficients tbody tr:first-child svg g", models.models.length);
    assert.match(await page.locator(".coefficients svg title").last().textContent(), /^revision \d+: .+ \[.+, .+\]/);
    await page.locator(".chart canvas").waitFor();
    const file = await page.getByRole("link", { name: "Download revision 1", exact: true }).getAttribute("href");
    assert.equal((await (await fetch(`${address}/${file}`)).json()).provenance.revision, "1");
    await page.context().close();
  },
  async "an order is followed to its end"() {
    const page = await open(1280, "light", `#/boat/${boat}`);
    await page.getByLabel("Token").fill("a wrong token");
    await page.getByRole("button", { name: "Refresh the model" }).click();
    await page.getByRole("alert").getByText("token is missing or wrong").waitFor();
    const before = await page.locator(".coefficients svg").first().locator("g").count();
    await page.getByLabel("Token").fill(token);
    await page.getByRole("button", { name: "Refresh the model" }).click();
    await page.getByText(`published as revision ${before + 1}`).waitFor();
    await count(page, ".coefficients tbody tr:first-child svg g", before + 1);
    await page.context().close();
  },
  async "an earlier model is published again"() {
    const page = await open(1280, "light", `#/boat/${boat}`);
    const { models } = await answerOf(`/vehicles/${boat}/models`);
    const newest = Number(models[0].provenance.revision);
    assert.equal(await page.getByRole("button", { name: `Roll back to revision ${newest}`, exact: true }).count(), 0);
    const button = page.getByRole("button", { name: "Roll back to revision 1", exact: true });
    assert.ok(await button.isDisabled(), "no token is given");
    await page.getByLabel("Token").fill("a wrong token");
    await button.click();
    await page.getByRole("alert").getByText("token is missing or wrong").waitFor();
    await page.getByLabel("Token").fill(token);
    await button.click();
    await page.getByText(`Revision 1 is published again as revision ${newest + 1}.`).waitFor();
    await page.getByRole("link", { name: `Download revision ${newest + 1}`, exact: true }).waitFor();
    await page.context().close();
  },
  async "two revisions are compared side by side"() {
    const page = await open(1280, "light", `#/boat/${boat}`);
    const { models } = await answerOf(`/vehicles/${boat}/models`);
    const compared = (query) => answerOf(`/vehicles/${boat}/comparison${query}`);
    const newest = await compared("");
    await page.getByText(newest.sentence, { exact: true }).waitFor();
    await page.getByRole("button", { name: /^Show all/ }).click();
    await count(page, ".pairs tbody tr", models[0].coefficients.length);
    await count(page, ".pairs tbody tr:first-child svg g", 2);
    await page.getByRole("combobox", { name: /^Revision/ }).selectOption("2");
    await page.getByRole("combobox", { name: /^with revision/ }).selectOption("1");
    const earlier = await compared("?earlier=1&later=2");
    await page.getByText(earlier.sentence, { exact: true }).waitFor();
    await page.context().close();
  },
  async "the predicted path stands beside the measured one"() {
    const page = await open(1280, "light", `#/boat/${boat}`);
    const paths = await answerOf(`/vehicles/${boat}/predicted-paths`);
    assert.ok(paths.predicted.length > 0);
    await page.locator(".paths .predicted").first().waitFor();
    await count(page, ".paths polyline.predicted", paths.predicted.length);
    const points = await page.locator(".paths polyline.measured").getAttribute("points");
    assert.equal(points.split(" ").length, paths.measured.timeS.length);
    await page.getByText(`root mean square of ${paths.predicted.length} runs`).waitFor();
    await page.context().close();
  },
  async "an earlier diagnosis is opened"() {
    const page = await open(1280, "light", `#/boat/${boat}`);
    await page.getByLabel("Token").fill(token);
    await page.getByRole("button", { name: "Diagnose", exact: true }).click();
    await page.getByText("Diagnosis: published").waitFor();
    await count(page, ".kept tbody tr", 2);
    const { diagnoses: [last, first] } = await answerOf(`/vehicles/${boat}/diagnoses`);
    await page.locator(`a[href$="diagnoses/${last.publishedUnixS}/report"]`).waitFor();
    await page.locator(".kept tbody tr").last().getByRole("button").click();
    await page.locator(`a[href$="diagnoses/${first.publishedUnixS}/report"]`).waitFor();
    await page.getByRole("heading", { name: "An earlier diagnosis" }).waitFor();
    await page.locator(".kept tbody tr").first().getByRole("button").click();
    await page.locator(`a[href$="diagnoses/${last.publishedUnixS}/report"]`).waitFor();
    await page.context().close();
  },
  async "axe finds nothing serious, and nothing is cut off at any width"() {
    for (const scheme of ["light", "dark"]) {
      for (const [view, hash] of [["fleet", "#/"], ["boat", `#/boat/${boat}`]]) {
        const page = await open(1280, scheme, hash);
        if (view === "boat") for (const last of [".paths", ".pairs", "a[href$='/report']"]) await page.waitForSelector(last);
        await accessible(page, `${view}, ${scheme}`);
        for (const width of [360, 390, 768, 1280, 1920]) {
          await page.setViewportSize({ width, height: 900 });
          await fits(page, `${view} at ${width} px`);
          if (width !== 390 && width !== 1280) continue;
          await page.waitForFunction(() => [...document.querySelectorAll("canvas")].every((canvas) => canvas.width > 0));
          await page.screenshot({ path: `${pictures}/${view}-${width}-${scheme}.png`, fullPage: true });
        }
        await page.context().close();
      }
    }
  },
  async "a boat without telemetry says so in each card, and shows no empty chart"() {
    const page = await newPage(390);
    await page.goto(`${address}/#/boat/boat-0002`);
    for (const text of ["No error yet", "No model has been published", "No position has arrived yet", "No prediction yet",
                        "has not been diagnosed"]) {
      await page.getByText(text).first().waitFor();
    }
    await page.locator(".fact", { hasText: "Newest sample" }).getByText("none").waitFor();
    assert.equal(await page.locator("canvas:visible").count(), 0);
    await page.context().close();
  },
  async "a boat that is not there is named"() {
    const page = await open(1280);
    await page.goto(`${address}/#/boat/nobody`);
    await page.getByText("serves no boat named nobody").waitFor();
    await page.context().close();
  },
  async "the page comes back after a restart of the daemon"() {
    const page = await open(1280);
    const status = page.locator("header [role=status]");
    await status.getByText("Live", { exact: true }).waitFor();
    expectFaults(true);
    console.log("RESTART");
    await status.getByText("No connection; trying again").waitFor();
    console.log("START");
    const lines = createInterface({ input: process.stdin });
    for await (const line of lines) if (line === "restarted") break;
    await status.getByText("Live", { exact: true }).waitFor();
    await page.getByRole("link", { name: boat }).click();
    await page.waitForSelector("#coefficients table");
    await page.context().close();
    expectFaults(false);  // only now, since the browser may tell of a lost connection late
  },
});
