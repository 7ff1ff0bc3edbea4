// playground.mjs: the playground in Chromium, as somebody uses it.
//
//     node playground.mjs build/playground KRS [PART]...
//
// KRS is the command, with whose meshes downloads are compared.  Parts: what is not named is left out; `usual` is all but `long`.
// Prints TAP.  KRS_SHOTS is a folder for pictures of the page.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { createRequire } from 'node:module';
import { spawnSync } from 'node:child_process';
import { launch, serve } from './browser.mjs';

const [site, krs, ...chosen] = process.argv.slice(2);
const require = createRequire(path.resolve(site, '../npm/package.json'));
const downloads = fs.mkdtempSync(path.join(os.tmpdir(), 'krs-playground-'));
const shots = process.env.KRS_SHOTS;

let number = 0, failed = 0;
const report = (good, what, why) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
    if (!good && why !== undefined)
        console.log(`# ${String(why).slice(0, 600).replaceAll('\n', '\n# ')}`);
};
const wait = milliseconds => new Promise(resolve => setTimeout(resolve, milliseconds));

let server = await serve(site);
const browser = await launch();
await browser.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: downloads });
const page = await browser.open(null, { width: 1280, height: 800 });

await page.send('Emulation.setFocusEmulationEnabled', { enabled: true });
// What the page asks of the compiler and of the worker that draws.
await page.send('Page.addScriptToEvaluateOnNewDocument', { source: `
    window.asked = [];
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, ...more) { asked.push(message.call); return post.call(this, message, ...more); };` });

// ---- what a user does ----

const BALL = '/// How large it is.\nparam radius = 1 in [0.5, 2];\nparam tint = #c8553d;\nshow sphere(radius).paint(tint);\n';

// With these keys held: 1 is Alt, 2 Ctrl, 8 Shift.
const codes = { Enter: 13, Escape: 27, Tab: 9, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40, Home: 36, ' ': 32 };
async function key(name, modifiers = 0, code = name) {
    const text = name === 'Enter' ? '\r' : name.length === 1 && !(modifiers & 3) ? name : undefined;
    const event = { key: name, code, modifiers, windowsVirtualKeyCode: codes[name] ?? name.toUpperCase().charCodeAt(0), ...(text && { text }) };
    await page.send('Input.dispatchKeyEvent', { type: text ? 'keyDown' : 'rawKeyDown', ...event });
    await page.send('Input.dispatchKeyEvent', { type: 'keyUp', ...event, text: undefined });
}

// The middle of what a selector finds, where it is seen; what has just appeared may not have come to its place.
const middle = selector => page.evaluate(async selector => {
    const element = document.querySelector(selector);
    element.scrollIntoView({ block: 'nearest' });
    await new Promise(resolve => setTimeout(resolve, 60));
    const { left, top, width, height } = element.getBoundingClientRect();
    return { x: left + width / 2, y: top + height / 2 };
}, selector);

async function click(selector) {
    const { x, y } = await middle(selector);
    await page.mouse('mouseMoved', x, y, { button: 'none' });
    await page.mouse('mousePressed', x, y);
    await page.mouse('mouseReleased', x, y);
}

const start = async (fragment = '') => {
    await page.go('about:blank');
    await page.go(`${server.url}/${fragment}`);
    await page.until('document.documentElement.dataset.ready !== undefined');
    if (!shots)
        await page.evaluate(() => { document.querySelector('krs-view').samples = 1; });
};
// The text as it is seen; the editor shows all of what is short.
const text = () => page.evaluate(() => [...document.querySelectorAll('.cm-line')].map(line => line.textContent).join('\n'));
const answered = () => page.until('document.documentElement.dataset.waiting === undefined');
async function write(whole) {
    await page.evaluate(() => document.querySelector('.cm-content').focus());
    await key('a', 2, 'KeyA');
    await page.type(whole);
    await answered();
}
const picture = () => page.evaluate(() => document.querySelector('krs-view').snapshot(64, 36).then(async blob => {
    const bitmap = await createImageBitmap(blob), canvas = new OffscreenCanvas(64, 36).getContext('2d');
    canvas.drawImage(bitmap, 0, 0);
    return Array.from(canvas.getImageData(0, 0, 64, 36).data);
}));
const difference = (a, b) => a.reduce((sum, number, i) => sum + Math.abs(number - b[i]), 0) / a.length;
const shot = async name => shots && page.screenshot(path.join(shots, `${name}.png`));
const quiet = what => {
    report(page.errors.length === 0, `${what} without an exception`, page.errors.join('\n'));
    page.errors.length = 0;
};

async function downloaded(ending, seconds = 60) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await wait(50)) {
        const file = fs.readdirSync(downloads).find(name => name.endsWith(ending));
        if (file)
            return { name: file, bytes: fs.readFileSync(path.join(downloads, file)) };
    }
    throw new Error(`no ${ending} was downloaded: ${await page.evaluate(() => document.querySelector('#failure').textContent)}`);
}

async function download(kind, fields = {}) {
    await click('#open-download');
    await click(`#download [value=${kind}]`);
    await page.evaluate(fields => {
        for (const [name, value] of Object.entries(fields)) {
            const field = document.querySelector(`#download [name=${name}]`);
            typeof value === 'boolean' ? field.checked = value : field.value = value;
        }
    }, fields);
    await click('#save');
    return downloaded(`.${kind}`);
}

// ---- what is tested ----

const parts = {
    async first() {
        await start();
        report(await page.evaluate(() => document.querySelector('krs-view').scene.ok), 'a first scene is there');
        report(new Set((await picture()).map(String)).size > 40, 'its picture is one');
        report(await page.evaluate(() => document.querySelector('.t-statement')?.textContent) === 'param', 'words have the class of token.def');
        quiet('it is shown');
        await shot('wide');
    },

    async mistakes() {
        await start();
        await write(BALL);
        const before = await picture();
        await write(BALL.replace('sphere', 'spere'));
        const marked = await page.evaluate(() => document.querySelector('.cm-lintRange-error')?.textContent);
        report(marked === 'spere', 'a mistake is marked where it is', marked);
        report(await page.evaluate(() => document.querySelector('#problems .place').textContent.startsWith('4:6')), 'it is in the list, with its place');
        report(difference(before, await picture()) < 2 && await page.evaluate(() => !document.querySelector('#stale').hidden), 'the last picture stays, and that is said');
        await shot('mistake');
        await click('#problems .fix');
        await answered();
        report(await text() === BALL && await page.evaluate(() => document.querySelector('#problems').hidden), 'a click mends it', await text());
        await write(BALL.replace('tint)', 'tnt)'));
        const { x, y } = await middle('.cm-lintRange-error');
        await page.mouse('mouseMoved', x, y, { button: 'none' });
        await page.until('document.querySelector(".cm-diagnosticAction")');
        await shot('tip');
        await click('.cm-diagnosticAction');
        await answered();
        report(await text() === BALL, 'so does one in the tip', await text());
        quiet('mistakes are shown');
    },

    async parameters() {
        await start();
        await write(BALL);
        const before = await picture();
        await page.evaluate(() => { asked.length = 0; });
        await page.evaluate(() => {
            const slider = document.querySelector('.parameter input[type=range]');
            slider.value = 2;
            slider.dispatchEvent(new Event('input'));
        });
        await page.until('document.querySelector("krs-view").scene.parameters[0].value[0] === 2');
        report(difference(before, await picture()) > 2, 'a slider changes the picture');
        const asked = await page.evaluate(() => asked);
        report(!['compile', 'update', 'shader', 'scene'].some(call => asked.includes(call)), 'nothing is compiled for it', asked);
        report(asked.includes('set') && asked.includes('state'), 'the compiler is told the value', asked);
        report(await page.evaluate(() => document.querySelector('.parameter .doc').textContent) === 'How large it is.', 'the comment of a parameter is shown');
        await page.evaluate(() => {
            const well = document.querySelector('.parameter input[type=color]');
            well.value = '#00ff00';
            well.dispatchEvent(new Event('input'));
        });
        await page.until('document.querySelector("krs-view").scene.parameters[1].value[1] === 1');
        await page.evaluate(() => [...document.querySelectorAll('#parameters .all button')].at(-1).click());
        await answered();
        report(await text() === BALL.replace('= 1', '= 2').replace('#c8553d', '#00ff00'), 'values are written into the text', await text());
        await key('z', 2, 'KeyZ');
        await answered();
        report(await text() === BALL, 'and taken back');
        quiet('parameters are changed');
    },

    async layout() {
        await start();
        await write('show   sphere( 1 );');
        await click('#format');
        await page.until('document.querySelector(".cm-content").textContent === "show sphere(1);"');
        report(await text() === 'show sphere(1);\n', 'a text is laid out');
        await write('show sphere(;');
        await click('#format');
        await page.until('document.querySelector("#said").textContent');
        report(await text() === 'show sphere(;', 'one with mistakes stays');
        quiet('that is done');
    },

    async share() {
        await start();
        await write(BALL);
        await page.evaluate(() => document.querySelector('krs-view').focus());
        await key('ArrowRight');
        await page.evaluate(() => {
            const slider = document.querySelector('.parameter input[type=range]');
            slider.value = 1.5;
            slider.dispatchEvent(new Event('input'));
        });
        await page.until('document.querySelector("krs-view").scene.parameters[0].value[0] === 1.5');
        const camera = () => page.evaluate(() => document.querySelector('krs-view').camera.eye);
        const eye = await camera();
        await click('#share');
        await page.until('document.querySelector("#shared").open');
        const link = await page.evaluate(() => document.querySelector('#link').value);
        await shot('share');
        await page.evaluate(() => localStorage.clear());
        await start(link.slice(link.indexOf('#')));
        report(await text() === BALL, 'a link has the text');
        report(await page.evaluate(() => document.querySelector('krs-view').scene.parameters[0].value[0]) === 1.5, 'and values of parameters');
        const now = await camera();
        report(eye.every((number, k) => Math.abs(number - now[k]) < 1e-9), 'and the camera', `${eye} ${now}`);
        await start('#1.broken');
        report(/broken/.test(await page.evaluate(() => document.querySelector('#said').textContent)), 'a broken link is told');
        report(await text() === BALL, 'what was there last comes instead');
        await start('#example=02-gear');
        report((await text()).startsWith('// Functions, figures and time'), 'a link to an example opens it');
        await page.evaluate(() => document.querySelector('.cm-content').focus());
        await page.type('// mine\n');
        await answered();
        await start(await page.evaluate('location.hash'));
        report((await text()).startsWith('// mine'), 'what was written after that is there when one comes again', (await text()).slice(0, 40));
        await start('#example=none');
        report(/There is no example none/.test(await page.evaluate(() => document.querySelector('#said').textContent)), 'an example that is not there is told');
        quiet('links are opened');
        const refused = await page.evaluate(() => new Promise(resolve => {
            addEventListener('securitypolicyviolation', event => resolve(event.effectiveDirective));
            fetch('http://127.0.0.1:9/').catch(() => {});
        }));
        report(refused === 'connect-src', 'the page may ask no other host');
        page.errors.length = 0;
    },

    async stop() {
        await start();
        await write(BALL);
        await page.evaluate(() => document.querySelector('.cm-content').focus());
        await key('a', 2, 'KeyA');
        await page.type('def f(n) = if n < 2 then n else f(n - 1) + f(n - 2); show sphere(f(40));');
        await page.until('!document.querySelector("#busy").hidden');
        await shot('busy');
        await click('#stop');
        await answered();
        report(/ended/.test(await page.evaluate(() => document.querySelector('#said').textContent)), 'a compilation is stopped');
        await write(BALL.replace('= 1', '= 2'));
        report(await page.evaluate(() => document.querySelector('krs-view').scene.parameters[0].value[0]) === 2, 'and others go on');
        quiet('that is done');
    },

    async downloads() {
        await start();
        await write(BALL);
        report((await download('krs')).bytes.toString() === BALL, 'the text is downloaded');
        const png = (await download('png', { width: 333, height: 217, samples: 1 })).bytes;
        report(png.readUInt32BE(16) === 333 && png.readUInt32BE(20) === 217, 'a picture has the size that was asked for');
        const { data } = require('pngjs').PNG.sync.read(png), centre = 4 * (108 * 333 + 166);
        report(data[centre] > 1.5 * data[centre + 2], 'and the ball in its middle', data.subarray(centre, centre + 4).join());
        const stl = (await download('stl', { error: 0.02, quality: 'proven', simplify: true })).bytes;
        report(stl.length === 84 + 50 * stl.readUInt32LE(80), 'STL has as many triangles as it says');
        const points = Array.from({ length: 3 * stl.readUInt32LE(80) }, (_, i) =>
            [0, 4, 8].map(k => stl.readFloatLE(84 + 50 * Math.floor(i / 3) + 12 * (1 + i % 3) + k)));
        report(points.length > 300 && points.every(point => Math.abs(Math.hypot(...point) - 1) < 0.02), 'all their corners are on the ball');
        const edges = new Map();
        points.forEach((point, i) => {
            const next = points[i % 3 === 2 ? i - 2 : i + 1], name = `${point}:${next}`;
            edges.set(name, (edges.get(name) ?? 0) + 1);
        });
        report([...edges].every(([name, count]) => count === 1 && edges.has(name.split(':').reverse().join(':'))), 'they close');
        if (fs.existsSync(krs)) {
            const scene = path.join(downloads, 'ball-scene'), mesh = path.join(downloads, 'native.stl');
            fs.writeFileSync(scene, BALL);
            fs.rmSync(path.join(downloads, 'scene.stl'));
            const { stderr } = spawnSync(krs, ['mesh', scene, '--error', '0.02', '--simplify', '-o', mesh]);
            report(fs.existsSync(mesh) && fs.readFileSync(mesh).equals(stl), 'it is the file of `krs mesh`', stderr);
        }
        await write('show (box([2, 1, 1]).paint(#ff0000) | box([1, 2, 1]).move([0.3, 0.4, 0]).paint(#0000ff));\nshow sphere(0.5).paint(mix(#000000, #ffffff, 0.5 + x)).move([3, 0, 0]);');
        const glb = (await download('glb')).bytes, { issues, info } = await require('gltf-validator').validateBytes(glb);
        report(issues.numErrors === 0 && issues.numWarnings === 0, 'GLB is glTF', JSON.stringify(issues.messages));
        const json = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)));
        const colours = json.materials.map(({ pbrMetallicRoughness }) => pbrMetallicRoughness.baseColorFactor.slice(0, 3).map(Math.round).join(' '));
        report(json.nodes.length === 2 && colours.includes('1 0 0') && colours.includes('0 0 1'), 'with a node for each component and its colours', JSON.stringify(json.materials));
        report(json.meshes[1].primitives[0].attributes.COLOR_0 !== undefined && info.totalTriangleCount > 100, 'and colours of vertices where they change evenly');
        const vectors = accessor => {
            const { bufferView, count } = json.accessors[accessor], at = 28 + glb.readUInt32LE(12) + json.bufferViews[bufferView].byteOffset;
            return Array.from({ length: count }, (_, i) => [0, 4, 8].map(k => glb.readFloatLE(at + 12 * i + k)));
        };
        const [boxes, ball] = json.meshes.map(({ primitives: [{ attributes }] }) => ({ at: vectors(attributes.POSITION), normals: vectors(attributes.NORMAL) }));
        report(boxes.normals.every(normal => Math.max(...normal.map(Math.abs)) > 0.999), 'normals of boxes are along the axes, also at edges');
        report(ball.normals.every((n, i) => (n[0] * (ball.at[i][0] - 3) + n[1] * ball.at[i][1] + n[2] * ball.at[i][2]) / 0.5 > 0.98), 'those of a ball lead away from its middle');
        await click('#open-download');
        await shot('download');
        await key('Escape');
        await write('show plane([0, 1, 0], 0);');
        await click('#open-download');
        await click('#download [value=stl]');
        await click('#save');
        await page.until('document.querySelector("#failure").textContent');
        report(true, 'a scene without an end has no mesh, and that is said');
        quiet('downloads are made');
    },

    async keys() {
        await start();
        await write(BALL);
        await start();
        const seen = [], unseen = [];
        for (let i = 0; i < 60; i++) {
            await key('Tab');
            await wait(100); // the editor tells it a little later
            const focus = await page.evaluate(() => {
                const element = document.activeElement, style = getComputedStyle(element);
                const marked = style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) > 1 || Boolean(element.closest('.cm-focused'));
                return { name: element === document.body ? 'BODY' : element.id || element.getAttribute('aria-label') || element.title || element.textContent.trim(), marked,
                         inText: Boolean(element.closest('.cm-content')) };
            });
            if (focus.name === 'BODY' || seen.includes(focus.name))
                break;
            seen.push(focus.name);
            if (!focus.marked)
                unseen.push(focus.name);
            if (focus.inText)
                await key('Escape');
        }
        const wanted = ['open-examples', 'format', 'share', 'open-download', 'theme', 'open-help', 'Text of the scene', 'divider', 'view', 'radius', 'tint'];
        report(wanted.every(name => seen.includes(name)), 'Tab reaches all', `missing: ${wanted.filter(name => !seen.includes(name))}; seen: ${seen}`);
        report(unseen.length === 0, 'one sees where it is', unseen);
        report(wanted.every((name, i) => i === 0 || seen.indexOf(name) > seen.indexOf(wanted[i - 1])), 'in the order of the page', seen);
        await page.evaluate(() => document.querySelector('.cm-content').focus());
        await key('End', 2);
        await key('Tab');
        report(/\t|    $/.test(await text()), 'in the text Tab indents');
        await key('z', 2, 'KeyZ');
        await page.evaluate(() => { asked.length = 0; });
        await key('Enter', 2);
        await page.until('asked.includes("update")', { seconds: 5 });
        report(await text() === BALL, 'Ctrl Enter compiles, and writes nothing');
        await page.evaluate(() => document.querySelector('krs-view').focus());
        await key('Home');
        const before = await page.evaluate(() => document.querySelector('krs-view').camera.eye);
        await key('ArrowLeft');
        const turned = await page.evaluate(() => document.querySelector('krs-view').camera.eye);
        await key('Home');
        const back = await page.evaluate(() => document.querySelector('krs-view').camera.eye);
        report(before.some((number, k) => Math.abs(number - turned[k]) > 0.01) && before.every((number, k) => Math.abs(number - back[k]) < 1e-9), 'arrows turn the picture, Home goes back');
        await page.evaluate(() => document.querySelector('#open-examples').focus());
        await key('Enter');
        await key('Tab');
        await key('Enter');
        await page.until('!document.querySelector("#examples").open');
        await answered();
        report((await text()).startsWith('// The smallest scene'), 'an example is opened by keys');
        await page.evaluate(() => document.querySelector('#divider').focus());
        const width = await page.evaluate(() => document.querySelector('#text').clientWidth);
        await key('ArrowRight');
        report(await page.evaluate(() => document.querySelector('#text').clientWidth) > width, 'the divider is moved by keys');
        quiet('keys are pressed');
    },

    async words() {
        await start();
        await write('');
        await page.evaluate(() => document.querySelector('.cm-content').focus());
        await page.type('show sph');
        await page.until('document.querySelector(".cm-tooltip-autocomplete li")');
        await shot('completion');
        await wait(150);
        await key('Enter');
        report(await text() === 'show sphere()', 'words are completed', await text());
        await page.type('1');
        await key('ArrowRight');
        await page.type('.mo');
        await page.until('[...document.querySelectorAll(".cm-tooltip-autocomplete li")].some(item => item.textContent.startsWith("move"))');
        report(true, 'methods are behind a dot');
        await key('Escape');
        await write('material clay { rou');
        await page.until('[...document.querySelectorAll(".cm-tooltip-autocomplete li")].some(item => item.textContent.startsWith("roughness"))');
        report(true, 'properties are in blocks');
        await key('Escape');
        await write('def ring(width, height = 2) = torus(width, height);\nshow ring(1, ');
        await page.until('document.querySelector(".call b")?.textContent === "height = 2"');
        await shot('call');
        report(true, 'the parameter that comes next is shown');
        await write('/// As it is.\ndef ring(width) = torus(width);\nshow ring(1);');
        const { x, y } = await page.evaluate(() => {
            const { left, top } = [...document.querySelectorAll('.t-call')].at(-1).getBoundingClientRect();
            return { x: left + 8, y: top + 8 };
        });
        await page.mouse('mouseMoved', x, y, { button: 'none' });
        await page.until('document.querySelector(".explained")?.textContent.includes("As it is.")');
        await shot('hover');
        report(true, 'a tip tells what a name means');
        quiet('words are offered');
    },

    async access() {
        const axe = fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
        await start();
        await write(BALL.replace('sphere', 'spere'));
        await page.evaluate(`${axe}; undefined`);
        const look = async what => {
            const found = await page.evaluate(() => axe.run().then(({ violations }) => violations.map(({ id, nodes }) => `${id}: ${nodes.map(node => node.html.slice(0, 160)).join('\n')}`)));
            report(found.length === 0, `axe finds nothing: ${what}`, found.join('\n'));
        };
        for (const scheme of ['light', 'dark'])
            for (const [width, height] of [[1280, 800], [360, 720]]) {
                await page.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }] });
                await page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
                await wait(200);
                await look(`${scheme}, ${width} wide`);
                if (width === 360)
                    report(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the page');
                await shot(`${scheme}-${width}`);
                for (const dialog of ['examples', 'download', 'help'])  {
                    await click(`#open-${dialog}`);
                    await wait(100);
                    await look(`${dialog}, ${scheme}, ${width} wide`);
                    if (width === 360)
                        report(await page.evaluate(dialog => document.getElementById(dialog).scrollWidth <= document.getElementById(dialog).clientWidth, dialog), `${dialog} fits`);
                    await shot(`${dialog}-${scheme}-${width}`);
                    await key('Escape');
                }
            }
        await page.send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 800, deviceScaleFactor: 1, mobile: false });
        await page.send('Emulation.setEmulatedMedia', { features: [] });
        const colour = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
        const system = await colour(), seen = new Set();
        for (let i = 0; i < 3; i++) {
            await click('#theme');
            seen.add(await colour());
        }
        report(seen.size === 2 && await colour() === system, 'a button goes from light to dark and back to the system');
        quiet('that is done');
    },

    // What a finger does on phones, upright and not.
    async phones() {
        const phone = (width, height) => page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: true });
        await page.send('Emulation.setTouchEmulationEnabled', { enabled: true });
        await start();
        await write(`${BALL}param turn = 3deg in [0deg, 9deg];\nparam place = [0, 0, 0];\nparam shown = 1 in 0..2;\n${'// more\n'.repeat(20)}`);
        // Wells in the text and links in sentences are as high as lines.
        const small = () => page.evaluate(() => [...document.querySelectorAll('button, select, label:has(input), input')].filter(element => {
            const { width, height } = element.getBoundingClientRect(), dialog = document.querySelector('dialog[open]');
            return width > 1 && (width < 44 || height < 44) && element.checkVisibility({ visibilityProperty: true }) && !element.matches('.swatch, label input') &&
                (!dialog || dialog.contains(element));
        }).map(element => `${element.tagName} ${element.id || element.name || element.textContent.slice(0, 20)} ${element.className}`));
        const fits = selector => page.evaluate(selector => {
            const element = document.querySelector(selector), { left, top, right, bottom } = element.getBoundingClientRect();
            return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight && element.scrollWidth <= element.clientWidth;
        }, selector);
        // What is at the middle of an element, where it is scrolled into view.
        const reached = selector => page.evaluate(async selector => {
            const element = document.querySelector(selector);
            element.scrollIntoView({ block: 'nearest' });
            await new Promise(resolve => setTimeout(resolve, 60));
            const { left, top, width, height } = element.getBoundingClientRect();
            return element.contains(document.elementFromPoint(left + width / 2, top + height / 2));
        }, selector);
        const caretSeen = () => page.evaluate(() => {
            const { left, bottom } = document.querySelector('.cm-cursor-primary').getBoundingClientRect();
            return Boolean(document.elementFromPoint(left + 1, bottom - 2)?.closest('.cm-editor')) && bottom <= innerHeight;
        });
        for (const [width, height] of [[360, 740], [390, 844], [740, 360], [844, 390]]) {
            const at = `${width} by ${height}`;
            await page.evaluate(() => document.activeElement.blur()); // browsers scroll to it when the size changes
            await phone(width, height);
            await wait(100);
            report(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `nothing is wider than ${at}`);
            const few = await small();
            report(few.length === 0, `fingers meet all: ${at}`, few.join('\n'));
            for (const [button, dialog, last] of [['open-examples', 'examples', 'li:last-child button'], ['share', 'shared', '#copy'], ['open-help', 'help', 'a:last-of-type'], ['open-download', 'download', '#save']]) {
                await click(`#${button}`);
                await page.until(`document.getElementById('${dialog}').open`);
                const kinds = dialog === 'download' ? ['krs', 'png', 'stl', 'glb'] : [''];
                for (const kind of kinds) {
                    await page.evaluate(kind => kind && document.querySelector(`#download [value=${kind}]`).click(), kind);
                    const tooSmall = await small();
                    report(await fits(`#${dialog}`) && await reached(`#${dialog} ${last}`) && tooSmall.length === 0, `${dialog} ${kind} is all there: ${at}`, tooSmall.join('\n'));
                    await shot(`phone-${dialog}${kind}-${width}`);
                }
                await page.evaluate(dialog => document.getElementById(dialog).close(), dialog);
            }
            await page.evaluate(() => document.querySelector('.cm-content').focus());
            await key('Home', 2);
            for (let i = 0; i < 24; i++)
                await key('ArrowDown');
            await wait(200);
            report(await caretSeen(), `the cursor is seen at the end: ${at}`);
            for (let i = 0; i < 24; i++)
                await key('ArrowUp');
            await wait(200);
            report(await caretSeen(), `and at the beginning: ${at}`);
        }
        // A keyboard leaves so much of an upright phone.
        await phone(360, 400);
        await wait(200);
        report(await page.evaluate(() => document.activeElement.matches('.cm-content')), 'the text is still written in when a phone is turned');
        await write('');
        await page.type('show sph');
        await page.until('document.querySelector(".cm-tooltip-autocomplete li")?.getBoundingClientRect().top >= 0');
        report(await caretSeen(), 'beside a keyboard the cursor is seen');
        report(await page.evaluate(() => {
            const { left, top, right, bottom } = document.querySelector('.cm-tooltip-autocomplete').getBoundingClientRect();
            return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
        }), 'so are words');
        await shot('phone-keyboard');
        report(await page.evaluate(() => document.querySelector('.cm-tooltip-autocomplete li').getBoundingClientRect().height >= 43), 'fingers meet words');
        await page.send('Emulation.setTouchEmulationEnabled', { enabled: false });
        await page.send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 800, deviceScaleFactor: 1, mobile: false });
        quiet('phones are used');
    },

    // A megabyte is pasted, by lines and in one.
    async large() {
        for (const [what, whole] of [['lines', `show sphere(2);\n${`// ${'word '.repeat(10)}\n`.repeat(19000)}`], ['one line', `show sphere(3); // ${'word '.repeat(200000)}`]]) {
            await start();
            await page.evaluate(() => document.querySelector('.cm-content').focus());
            await key('a', 2, 'KeyA');
            await page.evaluate(whole => {
                const clipboardData = new DataTransfer();
                clipboardData.setData('text/plain', whole);
                document.querySelector('.cm-content').dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true, cancelable: true }));
            }, whole);
            await answered();
            report(await page.evaluate(whole => document.querySelector('krs-view').scene.text === whole, whole), `a megabyte is pasted: ${what}`);
            await click('#share');
            await page.until('document.querySelector("#shared").open');
            const link = await page.evaluate(() => document.querySelector('#link').value);
            await page.evaluate(() => localStorage.clear());
            await start(link.slice(link.indexOf('#')));
            report(await page.evaluate(whole => document.querySelector('krs-view').scene.text === whole, whole), 'and shared');
        }
        await page.evaluate(() => localStorage.clear());
        quiet('large texts are written');
    },

    // Nothing answers any more.
    async offline() {
        await start();
        await page.evaluate(() => navigator.serviceWorker.ready.then(() => true));
        await page.evaluate(() => localStorage.clear());
        const { port } = new URL(server.url);
        server.close();
        const refused = await fetch(server.url).then(() => false, () => true);
        await start();
        report(refused && await page.evaluate(() => document.querySelector('krs-view').scene.ok), 'it works without a network once it was loaded');
        await click('#open-examples');
        await page.evaluate(() => [...document.querySelectorAll('#examples button b')].find(title => title.textContent === 'Sign').click());
        await page.until('document.querySelector("krs-view").scene.text.includes("text(")');
        report(await page.evaluate(() => document.querySelector('#problems').hidden), 'examples with files and fonts, too');
        page.errors.length = 0;
        server = await serve(site, Number(port));
        await page.go(`${server.url}/service.js`);
        report(server.url.endsWith(`:${port}`) && await page.evaluate(() => document.body.textContent.includes('VERSION')), 'a server comes back at its port');
    },

    // Whatever comes to mind, in any order.
    async actions() {
        await start();
        await write(BALL);
        await randomActions(Number(process.env.KRS_ACTIONS ?? 25));
        quiet('random actions are done');
    },

    // The walk above finds an exception in an action.
    async fault() {
        await start();
        await write(BALL);
        await page.evaluate(() => document.querySelector('header').addEventListener('click', () => { throw new Error('planted'); }));
        for (let i = 0; i < 20 && page.errors.length === 0; i++)
            await randomActions(10);
        report(page.errors.some(error => error.includes('planted')), 'an exception that was planted is found');
        page.errors.length = 0;
    },

    async examples() {
        await start();
        const titles = await page.evaluate(() => [...document.querySelectorAll('#examples li b')].map(title => title.textContent));
        report(titles.length === fs.readdirSync('examples').filter(name => name.endsWith('.krs')).length, 'all examples are there');
        for (const title of titles) {
            await click('#open-examples');
            await page.evaluate(title => [...document.querySelectorAll('#examples li b')].find(one => one.textContent === title).click(), title);
            await answered();
            const told = await page.evaluate(() => [...document.querySelectorAll('#problems li')].map(row => row.textContent).join('\n'));
            report(told === '', `${title} opens`, told);
            await shot(`example-${title}`);
        }
        quiet('they are opened');
    },
};

let seed = Number(process.env.KRS_SEED ?? 1);
const random = below => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return Math.floor(seed / 2 ** 32 * below);
};

async function randomActions(count) {
    const words = ['show ', 'sphere(1)', '.round(0.1)', ';', '\n', 'param a = 1 in [0, 2];\n', '(', ')', 'material m { color: #123456 }\n', '"', 'bx', ' | box()', '🐟', '// '];
    const buttons = await page.evaluate(() => [...document.querySelectorAll('header button, .play button')].map(button => `#${button.id}`));
    const actions = [
        () => page.type(words[random(words.length)]),
        () => key('z', random(3) ? 2 : 10, 'KeyZ'),
        () => key(Object.keys(codes)[random(9)], random(4) ? 0 : 2),
        async () => {
            const button = buttons[random(buttons.length)];
            if (await page.evaluate(selector => Boolean(document.querySelector(selector).offsetParent), button))
                await click(button);
        },
        () => page.evaluate(choice => {
            const inputs = [...document.querySelectorAll('#parameters input')], input = inputs[choice % Math.max(inputs.length, 1)];
            if (!input)
                return;
            if (input.type === 'checkbox')
                input.click();
            else {
                input.value = input.type === 'color' ? '#336699' : input.min || String(choice % 7);
                input.dispatchEvent(new Event('input'));
            }
        }, random(1000)),
        async () => {
            const { x, y } = await middle('krs-view');
            await page.mouse('mousePressed', x, y);
            await page.mouse('mouseMoved', x + random(200) - 100, y + random(100) - 50);
            await page.mouse('mouseReleased', x + 9, y);
        },
        async () => {
            const { x, y } = await middle('krs-view');
            await page.mouse('mouseWheel', x, y, { deltaX: 0, deltaY: random(400) - 200 });
        },
        () => page.evaluate(choice => {
            const all = [...document.querySelectorAll('#problems button, #parameters button, dialog[open] button:not(#save)')];
            all[choice % Math.max(all.length, 1)]?.click();
        }, random(1000)),
        () => page.send('Emulation.setDeviceMetricsOverride', { width: 320 + random(1000), height: 500 + random(400), deviceScaleFactor: 1, mobile: false }),
        () => page.evaluate(() => document.querySelector('.cm-content').focus()),
        async () => {
            await key('Escape');
            await page.evaluate(() => document.querySelectorAll('dialog[open]').forEach(dialog => dialog.close()));
        },
        () => wait(random(500)),
    ];
    for (let i = 0; i < count; i++)
        await actions[random(actions.length)]();
    await page.evaluate(() => document.querySelectorAll('dialog[open]').forEach(dialog => dialog.close()));
    await answered();
    await page.send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 800, deviceScaleFactor: 1, mobile: false });
}

for (const name of chosen.length > 0 ? chosen : Object.keys(parts)) {
    try {
        await parts[name]();
    } catch (error) {
        report(false, `${name}: ${error.message}`, [error.stack, ...page.errors].join('\n'));
        page.errors.length = 0;
    }
}
console.log(`1..${number}`);
await browser.close();
server.close();
fs.rmSync(downloads, { recursive: true });
process.exitCode = failed ? 1 : 0;
