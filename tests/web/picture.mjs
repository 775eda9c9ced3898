// A picture of the fleet on the page, once it is live:  node picture.mjs ADDRESS FILE BROWSER
import { chromium } from "playwright-core";

const [address, file, executablePath] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 560 } });
await page.goto(address);
await page.getByText("Live").waitFor({ timeout: 90_000 });
await page.getByText("the model no longer matches the boat").waitFor();
await page.screenshot({ path: file });
await browser.close();
