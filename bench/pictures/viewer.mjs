// viewer.mjs - a picture of the viewer's page in headless Chromium with software WebGL, as the tests open it.
// usage: viewer.mjs DIST MODEL OUT.jpg     DIST: the built pages (./run web --build); MODEL: a .glb file
import path from 'node:path';
import { serve_page } from '../../tests/clients/browser.mjs';

const [dist, model, out] = process.argv.slice(2);
const VIEW = 'orbit=-38deg,72deg,125%25&background=%23e4e6ea';
const { page, messages, close } = await serve_page(`/index.html#model=models/${path.basename(model)}&${VIEW}`,
    (url) => url.startsWith('/models/') ? model : path.join(dist, url));
try {
    page.setDefaultTimeout(200000); // a frame of software WebGL takes long on a busy machine
    await page.setViewportSize({ width: 1120, height: 680 });
    await page.waitForFunction(() => document.querySelector('facet-viewer')?.loaded);
    await page.evaluate(() => document.getElementById('tab-material').click());
    const { x, y, width, height } = await page.locator('facet-viewer').boundingBox();
    await page.mouse.click(x + width / 2, y + height / 2); // selects the material there
    await page.waitForTimeout(8000); // the frame of the whole resolution
    await page.screenshot({ path: out, type: 'jpeg', quality: 88 });
    if (messages.length) console.error(messages.join('\n'));
} finally {
    await close();
}
