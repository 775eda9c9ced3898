// Times the page of a daemon in Chromium: node page_speed.mjs ADDRESS SECONDS BROWSER, in a folder with playwright-core.
// Prints the first paint, when the first boats stand in the table, and the frames while the page follows the daemon.
import { chromium } from "playwright-core";

const [address, seconds, executablePath] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
await page.addInitScript(() => {
  window.tasks = [];
  new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map(({ duration }) => duration)))
    .observe({ type: "longtask", buffered: true });
});

/** Milliseconds of the processor that the tasks of the page's main thread take, by the trace. */
function taskTimes(trace) {
  const { traceEvents } = JSON.parse(trace);
  const frames = traceEvents.flatMap(({ name, args }) =>
    name === "TracingStartedInBrowser" ? args.data.frames : name === "FrameCommittedInBrowser" ? [args.data] : []);
  const pid = frames.find(({ url }) => url.startsWith(address)).processId;
  const { tid } = traceEvents.find((event) => event.pid === pid && event.args?.name === "CrRendererMain");
  return traceEvents.filter((event) => event.pid === pid && event.tid === tid && event.name === "RunTask")
    .map(({ tdur }) => (tdur ?? 0) / 1000);
}
const trace = () =>
  browser.startTracing(page, { categories: ["devtools.timeline", "disabled-by-default-devtools.timeline"] });
const traced = async () => taskTimes((await browser.stopTracing()).toString());

await trace();
await page.goto(`${address}/`);
await page.waitForSelector("tbody a");
const boatsAt = await page.evaluate(() => performance.now());
const paint = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime);
const loading = await traced();
const longLoading = await page.evaluate(() => window.tasks.splice(0));
const sum = loading.reduce((total, time) => total + time, 0);
console.log(`first paint ${paint.toFixed(0)} ms, boats in the table ${boatsAt.toFixed(0)} ms after the start; ` +
  `longest task until then ${Math.max(0, ...longLoading).toFixed(0)} ms, of which it takes ` +
  `${Math.max(...loading).toFixed(0)} ms of the processor, and all ${sum.toFixed(0)} ms`);

// The time that the main thread works for a frame, not how long the frame waits for a processor.
const session = await page.context().newCDPSession(page);
await session.send("Performance.enable", { timeDomain: "threadTicks" });
const work = async () => {
  const { metrics } = await session.send("Performance.getMetrics");
  return Object.fromEntries(metrics.map(({ name, value }) => [name, value]));
};
await trace();
const before = await work();
const gaps = await page.evaluate((ms) => new Promise((resolve) => {
  const found = [];
  const begun = performance.now();
  let last = begun;
  const frame = (now) => {
    found.push(now - last);
    last = now;
    if (now - begun < ms) requestAnimationFrame(frame);
    else resolve(found);
  };
  requestAnimationFrame(frame);
}), 1000 * Number(seconds));
const after = await work();
const longest = Math.max(...await traced());
const tasks = await page.evaluate(() => window.tasks);
gaps.sort((a, b) => a - b);
console.log(`live for ${seconds} s: main thread busy ${(1000 * (after.TaskDuration - before.TaskDuration) / seconds).toFixed(0)} ms a second ` +
  `(script ${(1000 * (after.ScriptDuration - before.ScriptDuration) / seconds).toFixed(0)}, layout ` +
  `${(1000 * (after.LayoutDuration - before.LayoutDuration) / seconds).toFixed(0)}); between frames: median ` +
  `${gaps[Math.floor(gaps.length / 2)].toFixed(0)} ms, 99 % ${gaps[Math.floor(0.99 * gaps.length)].toFixed(0)} ms, ` +
  `longest ${gaps.at(-1).toFixed(0)} ms; ${tasks.length} tasks over 50 ms, longest ${Math.max(0, ...tasks).toFixed(0)} ms; ` +
  `the longest task takes ${longest.toFixed(0)} ms of the processor`);
await browser.close();
