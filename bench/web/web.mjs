// web.mjs: how large the package for pages is, and how fast a page follows.
//
//     node web.mjs build/web [EXAMPLE...]
//
// For each example, in Chromium: milliseconds of the first compilation; until the first, coarse picture, of which drivers
// take most to compile shaders; from an edit of a number to its picture, after shaders have been compiled for edits; from
// a parameter to its picture; and how long the page was held up at most.
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { launch, serve } from '../../tests/web/browser.mjs';

const [, , built, ...chosen] = process.argv;
const names = chosen.length ? chosen : ['01-hello', '03-machined-part', '04-school', '12-fractals', '15-town', '22-lattice', '31-spring'];

const sizes = files => {
    const bytes = Buffer.concat(files.map(file => fs.readFileSync(path.join(built, file))));
    const kilobytes = part => `${Math.round(part.length / 1000)} kB`;
    return `${kilobytes(bytes)}, gzip ${kilobytes(zlib.gzipSync(bytes))}, brotli ${kilobytes(zlib.brotliCompressSync(bytes))}`;
};
console.log(`compiler: ${sizes(['krs.wasm', 'krs.mjs', 'core.mjs', 'worker.mjs'])}`);
console.log(`view: ${sizes(['index.mjs', 'compiler.mjs', 'view.mjs', 'frame.mjs', 'painter.mjs', 'picture.mjs', 'programs.mjs', 'shaders.mjs'])}`);

// In the page.
async function measure(name) {
    const next = () => new Promise(resolve => view.addEventListener('krs-frame', event => resolve(event.detail), { once: true }));
    const until = async call => {
        const begun = performance.now(), frame = next();
        await call();
        await frame;
        return Math.round(performance.now() - begun);
    };
    view.samples = 1;
    const text = await (await fetch(`/examples/${name}.krs`)).text(), options = { name: `${name}.krs`, base: '/examples/' };
    const begun = performance.now(), first = next();
    await view.update(text, options);
    const compiled = Math.round(performance.now() - begun);
    await first;
    const shown = Math.round(performance.now() - begun);
    const number = /\b(roughness|intensity|fov|radius): *(\d+(\.\d+)?)/, edit = factor => view.update(text.replace(number, (_, name, value) => `${name}: ${value * factor}`));
    await view.ready;
    let longest = 0, last = performance.now();
    const clock = setInterval(() => {
        const now = performance.now();
        longest = Math.max(longest, now - last);
        last = now;
    }, 1);
    const edits = [];
    for (const factor of number.test(text) ? [0.99, 0.98] : []) {
        edits.push(await until(() => edit(factor)));
        await view.ready;
    }
    const parameter = view.scene.parameters.find(p => p.kind === 'number' && isFinite(p.high[0]));
    const moved = parameter ? await until(() => view.scene.set(parameter.name, (parameter.low[0] + parameter.high[0]) / 2)) : null;
    const turned = await until(async () => { view.camera = { fov: 0.98 * view.camera.fov }; });
    clearInterval(clock);
    return { compiled, shown, 'first edit': edits[0], 'edit of a number': edits[1], parameter: moved, camera: turned, 'page held up': Math.round(longest) };
}

const server = await serve({ '/': 'tests/web/pages', '/krs/': built, '/examples/': 'examples' }), browser = await launch();
for (const name of names) {
    const page = await browser.open(`${server.url}/view.html`);
    await page.until('window.krs');
    console.log(`${name}: ${Object.entries(await page.evaluate(measure, name)).map(([what, took]) => `${what} ${took ?? '-'}`).join(', ')} ms`);
    await page.close();
}
await browser.close();
server.close();
