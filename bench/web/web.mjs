// web.mjs: how large the package for pages is, and how fast a page follows.
//
//     node web.mjs build/web [EXAMPLE...]
//
// For each example, in Chromium, milliseconds: of the first compilation; until a first, coarse picture, of which drivers take
// most to compile shaders; until all pixels have a sample, if that takes less than half a minute; from an edit of a number, a
// parameter and the camera to its first picture; of the longest tile, after those that compile; and how long the page was held
// up at most.  Then the seconds of processors that drawing took until the first picture, and for the sample.
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { launch, serve } from '../../tests/web/browser.mjs';

const PATIENCE = 30000; // milliseconds for a sample of all pixels
// Milliseconds after which Chromium frees what it showed before a page was opened; the page's thread waits for the
// graphics process meanwhile, also where that compiles shaders for long.
const SETTLING = 1500;

const [, , built, ...chosen] = process.argv;
const names = chosen.length ? chosen : ['01-hello', '03-machined-part', '04-school', '12-fractals', '15-town', '22-lattice', '31-spring'];

const sizes = files => {
    const bytes = Buffer.concat(files.map(file => fs.readFileSync(path.join(built, file))));
    const kilobytes = part => `${Math.round(part.length / 1000)} kB`;
    return `${kilobytes(bytes)}, gzip ${kilobytes(zlib.gzipSync(bytes))}, brotli ${kilobytes(zlib.brotliCompressSync(bytes))}`;
};
console.log(`compiler: ${sizes(['krs.wasm', 'krs.mjs', 'core.mjs', 'worker.mjs'])}`);
console.log(`fonts, where a scene has texts: ${sizes(['letters.wasm', 'letters.mjs'])}`);
console.log(`view: ${sizes(['index.mjs', 'compiler.mjs', 'view.mjs', 'frame.mjs', 'painter.mjs', 'picture.mjs', 'tiles.mjs', 'display.mjs', 'programs.mjs', 'shaders.mjs'])}`);

// In the page: what follows is asked for by calls of `until`, which returns when something is seen of it; pictures of before
// may come first.
function prepare() {
    window.until = call => {
        const begun = performance.now();
        return new Promise(resolve => {
            const heard = ({ detail }) => {
                if (detail.elapsed > performance.now() - begun)
                    return;
                view.removeEventListener('krs-frame', heard);
                resolve(Math.round(performance.now() - begun));
            };
            view.addEventListener('krs-frame', heard);
            call();
        });
    };
    window.longest = 0;
    let last = performance.now();
    setInterval(() => {
        const now = performance.now();
        longest = Math.max(longest, now - last);
        last = now;
    }, 1);
    view.samples = 1;
}

async function begin(name) {
    const text = window.text = await (await fetch(`/examples/${name}.krs`)).text(), begun = performance.now();
    let compiled;
    const shown = await until(() => view.update(text, { name: `${name}.krs`, base: '/examples/' }).then(() => { compiled = Math.round(performance.now() - begun); }));
    return { compiled, shown };
}

async function finish(patience) {
    const begun = performance.now();
    return { sample: await Promise.race([view.ready.then(() => Math.round(performance.now() - begun)), new Promise(resolve => setTimeout(resolve, patience))]) };
}

async function change() {
    const number = /\b(roughness|intensity|fov|radius): *(\d+(\.\d+)?)/, edits = [];
    for (const factor of number.test(text) ? [0.99, 0.98] : [])
        edits.push(await until(() => view.update(text.replace(number, (_, name, value) => `${name}: ${value * factor}`))));
    const parameter = view.scene.parameters.find(p => p.kind === 'number' && isFinite(p.high[0]));
    const moved = parameter && await until(() => view.scene.set(parameter.name, (parameter.low[0] + parameter.high[0]) / 2));
    const turned = await until(() => { view.camera = { fov: 0.98 * view.camera.fov }; });
    return { 'first edit': edits[0], 'edit of a number': edits[1], parameter: moved, camera: turned, 'page held up': Math.round(longest) };
}

// In workers: how long each tile takes, which is waited for by reading a pixel.
const timed = `{
    const { prototype } = WebGL2RenderingContext, { useProgram, readPixels } = prototype;
    self.tiles = [];
    let begun = null;
    prototype.useProgram = function (...values) { begun ??= performance.now(); return useProgram.apply(this, values); };
    prototype.readPixels = function (...values) {
        readPixels.apply(this, values);
        tiles.push(performance.now() - begun);
        begun = null;
    };
}`;

const server = await serve({ '/': 'tests/web/pages', '/krs/': built, '/examples/': 'examples' }), browser = await launch();
// Seconds of processors that drawing took so far.
async function drawing() {
    const { processInfo } = await browser.send('SystemInfo.getProcessInfo');
    return processInfo.filter(({ type }) => type === 'GPU').reduce((sum, { cpuTime }) => sum + cpuTime, 0);
}

for (const name of names) {
    const page = await browser.open(`${server.url}/view.html`, { inWorkers: timed }), seconds = [await drawing()];
    await page.until('window.krs');
    await new Promise(resolve => setTimeout(resolve, SETTLING));
    await page.evaluate(prepare);
    const told = await page.evaluate(begin, name);
    seconds.push(await drawing());
    Object.assign(told, await page.evaluate(finish, PATIENCE));
    seconds.push(await drawing());
    Object.assign(told, await page.evaluate(change));
    const tiles = (await Promise.all(page.workers.map(worker => worker.evaluate('tiles')))).flat().slice(3);
    const all = { ...told, 'longest tile': Math.round(Math.max(...tiles)) };
    console.log(`${name}: ${Object.entries(all).map(([what, took]) => `${what} ${took ?? '-'}`).join(', ')} ms; ${tiles.length} tiles; ` +
        `processors ${[1, 2].map(i => (seconds[i] - seconds[i - 1]).toFixed(1)).join(' and ')} s`);
    await page.close();
}
await browser.close();
server.close();
