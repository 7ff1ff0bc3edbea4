// install.mjs: what a bundle of an installed package shows in Chromium.
//
//     node install.mjs FOLDER
//
// FOLDER has the bundle `app.js` and the package as `krs/`.
import fs from 'node:fs';
import path from 'node:path';
import { launch, serve } from './browser.mjs';

const folder = process.argv[2];
fs.writeFileSync(path.join(folder, 'index.html'), '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><script type="module" src="app.js"></script><krs-view style="width: 96px; height: 54px"></krs-view>');
const server = await serve(folder), browser = await launch(), page = await browser.open(`${server.url}/index.html`);
const [middle, corner] = await page.until('window.shown', { seconds: 60 }).catch(error => [error.message]);
const good = middle[0] > 2 * middle[2] && corner[2] >= corner[0] && page.errors.length === 0;
console.log(`${good ? 'ok' : 'not ok'} 3 - the bundle shows a red ball before the sky: ${middle}, ${corner} ${page.errors.join('; ')}`);
await browser.close();
server.close();
process.exitCode = good ? 0 : 1;
