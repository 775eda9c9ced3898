// Tests the map of a real daemon's page while many boats send:
//   node fleet_map_test.mjs ADDRESS BROWSER BOATS PICTURES
// Exits 0 when all is well.
import assert from "node:assert/strict";
import { answerOf, names, namesOnMap, open, walk } from "./page_walk.mjs";

const [boats, pictures] = process.argv.slice(4);
const kRank = ["ERROR", "STALE", "WARN", "OK"];

await walk({
  async "names on the map cover no other, the worst come first, and the focus names any boat"() {
    for (const width of [1280, 390]) {
      const page = await open(width);
      await page.waitForFunction(() => document.querySelectorAll(".map-names span").length > 5);
      const named = new Set((await namesOnMap(page)).map(({ id }) => id));
      const { vehicles } = await answerOf(`/vehicles?limit=${boats}`);
      const onMap = vehicles.filter(({ position }) => position);
      const worst = onMap.map(({ verdict }) => verdict).sort((a, b) => kRank.indexOf(a) - kRank.indexOf(b))[0];
      assert.ok(onMap.some(({ vehicleId, verdict }) => verdict === worst && named.has(vehicleId)), `none that has a name is ${worst}`);
      const rows = await names(page);
      const other = onMap.map(({ vehicleId }) => vehicleId).find((id) => rows.includes(id) && !named.has(id));
      await page.locator(".boats tbody a").getByText(other, { exact: true }).focus();
      await page.locator(".map-names .pointed-at").getByText(other, { exact: true }).waitFor();
      await namesOnMap(page);
      await page.locator(".map-card").screenshot({ path: `${pictures}/fleet-map-${width}.png` });
      await page.context().close();
    }
  },
});
