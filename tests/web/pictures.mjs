// pictures.mjs: pictures of a page beside those of `krs render`: all examples are drawn without an error, a coarse picture
// first, by tiles that begin small; rays of some hit what its rays hit, and colours differ by little.
//
//     node pictures.mjs build/web build/krs [EXAMPLE...]
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { launch, serve } from './browser.mjs';
import { readExr } from './exr.mjs';
import { counting, isTile, loggedBy } from './work.mjs';

const width = 160, height = 90, samples = 8;
const [, , built, krs, ...chosen] = process.argv;
// Depths and components of these are compared; and colours, with the largest mean difference of a channel, of 255.
const compared = { '01-hello': 1.5, '02-gear': 3, '03-machined-part': 2.5, '04-school': 2.5, '05-rock': 2.5, '09-palm': 1.5, '14-inversion': 3, '15-town': 6,
    '22-lattice': 3, '26-gasket': 3, '30-bolt': 1.5, '31-spring': 2 };
const names = chosen.length ? chosen : fs.readdirSync('examples').filter(file => file.endsWith('.krs')).map(file => file.slice(0, -4));
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'krs-pictures-'));

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

const server = await serve({ '/': 'tests/web/pages', '/krs/': built, '/examples/': 'examples', '/work/': work });
const browser = await launch();

// In the page: shows an example, and returns when something of it is there.
async function show(file) {
    const text = await (await fetch(file)).text(), update = await view.update(text, { name: file.split('/').at(-1), base: '/examples/' });
    await Promise.race(['krs-frame', 'krs-error'].map(name => new Promise(resolve => view.addEventListener(name, resolve, { once: true }))));
    return { ok: update.ok && frames.length > 0, said: update.diagnostics.map(d => d.message).join('; '), first: frames[0]?.samples };
}

// The same in this size, with a sample; the last frame tells whether it is there.
async function finish(width, height) {
    Object.assign(view.style, { width: `${width}px`, height: `${height}px` });
    view.samples = 1;
    frames.length = 0;
    while (!(frames.at(-1)?.samples >= 1 && frames.at(-1).width === width))
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    await view.ready;
    return frames.at(-1).samples >= 1;
}

// ---- work ----

const MOST_COPIED = 2 << 20; // bytes in a message: some milliseconds
const FIRST_PIXELS = 128, FIRST_TILE = 16, GROWTH = 4; // of a first picture, with draws that tell what a draw costs; of its tiles

// What a page does until something is seen, counted: no clock decides.
function reportWork(name, first, log, work) {
    const shown = log.findIndex(what => what.frame !== undefined), tiles = log.slice(0, shown).filter(isTile).map(({ tile }) => tile);
    const pixels = tiles.reduce((sum, tile) => sum + tile, 0), copied = Math.max(work.copied, ...log.map(what => what.copied ?? 0));
    report(first < 0.01 && shown > 0 && pixels <= FIRST_PIXELS, `${name}: a coarse picture comes first (${pixels} pixels)`);
    const most = i => Math.max(FIRST_TILE, GROWTH * Math.max(0, ...tiles.slice(0, i)));
    report(tiles.length > 0 && tiles.every((tile, i) => tile <= most(i)), `${name}: its tiles begin small (${tiles.join(' ')})`);
    report(work.drawn === 0 && work.compiled === 0 && copied < MOST_COPIED, `${name}: the page draws and compiles nothing itself, and copies ${copied} bytes at most`);
}

// ---- pictures beside those of krs render ----

// Where rays hit: depth along the view, and the component there, or 0.  Which way rays go is found here once more.
async function hits(width, height) {
    const rays = await view.rays(width, height), { camera } = view, depths = [], points = [];
    const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0), unit = a => a.map(x => x / Math.sqrt(dot(a, a)));
    const cross = (a, b) => [0, 1, 2].map(k => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
    const forward = unit(camera.target.map((x, k) => x - camera.eye[k])), right = unit(cross(forward, camera.up)), up = cross(right, forward);
    const flat = camera.projection === 'orthographic', half = flat ? camera.height / 2 : Math.tan(camera.fov / 2);
    for (let i = 0; i < width * height; i++) {
        const [t, , state] = rays.subarray(4 * i, 4 * i + 3), x = 2 * (i % width + 0.5) - width, y = height - 2 * (Math.floor(i / width) + 0.5);
        const beside = right.map((r, k) => half / height * (x * r + y * up[k]));
        const origin = camera.eye.map((e, k) => e + (flat ? beside[k] : 0)), ahead = unit(forward.map((f, k) => f + (flat ? 0 : beside[k])));
        const point = origin.map((o, k) => o + t * ahead[k]);
        depths.push(state === 1 ? dot(point.map((p, k) => p - camera.eye[k]), forward) : null);
        if (state === 1)
            points.push(point);
    }
    const found = points.length ? await view.scene.query(points) : [];
    let next = 0;
    return { depths, components: depths.map(depth => (depth === null ? 0 : found[next++].component)) };
}

// The mean difference of a channel from a picture of `krs render`.
async function difference(file, width, height, samples) {
    view.samples = samples;
    const read = async blob => {
        const canvas = new OffscreenCanvas(width, height), context = canvas.getContext('2d');
        context.drawImage(await createImageBitmap(blob), 0, 0);
        return context.getImageData(0, 0, width, height).data;
    };
    const own = await read(await view.snapshot(width, height)), other = await read(await (await fetch(file)).blob());
    return own.reduce((sum, value, i) => sum + Math.abs(value - other[i]), 0) / (3 * width * height);
}

let last = null; // depths and picture of another example

async function compare(page, name) {
    const rendered = path.join(work, name);
    const options = ['--size', `${width}x${height}`, '--integrator', 'preview', '--quiet'];
    execFileSync(krs, ['render', `examples/${name}.krs`, ...options, '--samples', '1', '--aov', 'Z,id', '-o', `${rendered}.exr`]);
    execFileSync(krs, ['render', `examples/${name}.krs`, ...options, '--samples', `${samples}`, '-o', `${rendered}.png`]);
    const { Z, 'id.component': components } = readExr(fs.readFileSync(`${rendered}.exr`)), own = await page.evaluate(hits, width, height);
    const isNear = (depth, i, all = Z) => (depth === null ? all[i] === Infinity : Math.abs(depth - all[i]) <= 0.01 * all[i]);
    const near = own.depths.map((depth, i) => isNear(depth, i)), same = near.filter(Boolean).length;
    // At silhouettes either may be hit; elsewhere there is no other component.
    const other = near.filter((is, i) => is && own.components[i] !== components[i]).length;
    report(same >= 0.995 * Z.length, `${name}: ${(100 * same / Z.length).toFixed(2)} % of the depths are those of krs render`);
    report(other === 0, `${name}: of these ${other} of ${Z.length} are of another component`);
    const mean = await page.evaluate(difference, `/work/${name}.png`, width, height, samples);
    report(mean < compared[name], `${name}: colours differ by ${mean.toFixed(2)} of 255 in the mean`);
    if (last) { // what is compared tells pictures apart
        const alike = own.depths.filter((depth, i) => isNear(depth, i, last.Z)).length;
        const apart = await page.evaluate(difference, `/work/${last.name}.png`, width, height, 1);
        report(alike < 0.9 * Z.length && apart > 10, `${name}: ${last.name} is another picture (${alike} depths, ${apart.toFixed(0)} of 255)`);
    }
    last = { Z, name };
}

async function draw(name) {
    const page = await browser.open(`${server.url}/view.html`, counting);
    await page.until('window.krs');
    const { ok, said, first } = await page.evaluate(show, `/examples/${name}.krs`), log = await loggedBy(page, 'scene'), counted = await page.evaluate('work');
    const done = ok && await page.evaluate(finish, width, height);
    report(done && page.errors.length === 0, `${name} is drawn ${said} ${page.errors.join('; ').slice(0, 300)}`);
    reportWork(name, first, log, counted);
    if (done && name in compared)
        await compare(page, name);
    await page.close();
}

for (const name of names)
    await draw(name);

// ---- how a picture is shown, and where the rays of a pixel go ----

const BARS = 'show box([0.06, 3, 0.1]).repeat([0.14, 0, 0], [40, 1, 1]).rotate([0, 0, 1], 10deg).paint(#d0a040);\n' +
    'camera { eye: [0, 0, 7], target: [0, 0, 0], fov: 35deg }\nlight { direction: [0, 0, 1], intensity: 3 }\nsky { zenith: black, horizon: black, ground: black }\n';

async function compareShown(page, name, image) {
    const file = path.join(work, name);
    fs.writeFileSync(`${file}.krs`, `${BARS}image { ${image} }\n`);
    execFileSync(krs, ['render', `${file}.krs`, '--size', `${width}x${height}`, '--quiet', '--samples', `${samples}`, '-o', `${file}.png`]);
    await page.evaluate(show, `/work/${name}.krs`);
    await page.evaluate(finish, width, height);
    const [own, plain] = [await page.evaluate(difference, `/work/${name}.png`, width, height, samples), await page.evaluate(difference, '/work/plain.png', width, height, samples)];
    report(own < 0.5 && (name === 'plain' || plain > 4 * own + 1), `${name}: colours differ by ${own.toFixed(2)} of 255 from those of krs render, by ${plain.toFixed(2)} from plain ones`);
}

if (chosen.length === 0) {
    const page = await browser.open(`${server.url}/view.html`);
    await page.until('window.krs');
    for (const [name, image] of Object.entries({ plain: '', balanced: 'white_balance: [3200, 20]', blackman: 'pixel_filter: "blackman-harris"', gaussian: 'pixel_filter: "gaussian"' }))
        await compareShown(page, name, image);
    await page.close();
}
await browser.close();
server.close();
fs.rmSync(work, { recursive: true });
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
