// site.mjs: the static site: its files, and its pages in Chromium.
//
//     node site.mjs FOLDER KRS BUILD RENDERED
//
// RENDERED matches the names of scenes of which there are pictures.  Prints TAP.  Faults are planted in pages first, which the checks must report.  KRS_SHOTS is a folder for pictures of pages.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import zlib from 'node:zlib';
import { launch, serve } from './browser.mjs';

const [site, krs, build, pattern] = process.argv.slice(2), rendered = new RegExp(pattern), shots = process.env.KRS_SHOTS;
let number = 0, failed = 0;
const report = (good, what, why = []) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
    if (!good)
        for (const line of [why].flat().slice(0, 12))
            console.log(`# ${String(line).slice(0, 400).replaceAll('\n', '\n# ')}`);
};
const none = (faults, what) => report(faults.length === 0, what, faults);

// ---- files ----

const entities = { amp: '&', lt: '<', gt: '>', quot: '"' };
const decoded = text => text.replace(/&(\w+);/g, (whole, name) => entities[name] ?? whole);
const read = file => fs.readFileSync(path.join(site, file), 'utf8');
const pages = new Map(fs.readdirSync(site, { recursive: true }).filter(file => file.endsWith('.html')).map(file => [file, read(file)]));
const own = [...pages].filter(([file]) => !file.startsWith('playground/'));
const idsOf = new Map();
const idsIn = file => {
    if (!idsOf.has(file))
        idsOf.set(file, [...pages.get(file).matchAll(/ id="([^"]*)"/g)].map(match => match[1]));
    return idsOf.get(file);
};
const examples = new Set(JSON.parse(read('playground/examples.json')).map(({ name }) => name));

// Where each link of a page and each of its files should be, and is not.
function brokenLinks(file, html) {
    return [...html.matchAll(/ (?:href|src)="([^"]*)"/g)].map(match => decoded(match[1])).filter(link => !/^(?:https?|mailto):/.test(link)).filter(link => {
        const [target, fragment] = link.split('#'), to = target === '' ? file : path.join(path.dirname(file), decodeURIComponent(target)).replace(/\/$/, '/index.html');
        const [, name] = /^pictures\/(.*)-[0-9a-f]{12}\.jpg$/.exec(to) ?? [];
        if (name && !rendered.test(name) && !fs.existsSync(`docs/pictures/${name}.png`))
            return false;
        if (!fs.statSync(path.join(site, to === '.' ? 'index.html' : to), { throwIfNoEntry: false })?.isFile())
            return true;
        if (fragment === undefined)
            return false;
        if (to === 'playground/index.html')
            return fragment.startsWith('example=') ? !examples.has(fragment.slice(8)) : !sceneOf(fragment) && !idsIn(to).includes(fragment);
        return !idsIn(to).includes(decodeURIComponent(fragment));
    }).map(link => `${file}: ${link}`);
}

// The scene in a link to the playground; undefined: it holds none.
function sceneOf(fragment) {
    const [, packed] = /^1\.(.*)$/.exec(fragment) ?? [];
    return packed && JSON.parse(zlib.inflateRawSync(Buffer.from(packed, 'base64url'))).text;
}

// What a page would ask another host for: all but where a reader may go to.
const foreign = (file, text) => [...text.matchAll(/<(?!a\b)[^>]*(?:https?:)?\/\/[\w-]+\.[^>]*>|(?:url|import)\(["']?https?:[^)]*|\bfetch\(["'`]https?:/g)]
    .map(match => match[0]).filter(tag => !/xmlns|^<\/?(?:code|pre|span)/.test(tag)).map(tag => `${file}: ${tag}`);

const ways = ['index', 'docs/tutorial', 'docs/language', 'reference/shapes', 'gallery'].map(name => `href="../${name}.html"`);
none(ways.filter(way => !read('playground/index.html').includes(way)), 'the playground leads back to the site');
none([...own, ['playground/index.html', read('playground/index.html')]].flatMap(([file, html]) => brokenLinks(file, html)), 'every link leads to a page, to a heading in it, or to a scene');
report(brokenLinks('index.html', '<a href="docs/none.html"><a href="docs/tutorial.html#none"><img src="none.png"><a href="playground/index.html#example=none">').length === 4,
       'a link that leads nowhere would be found');
none([...own, ...['style.css', 'site.js', 'theme.js'].map(file => [file, read(file)])].flatMap(([file, text]) => foreign(file, text)), 'no page names a file of another host');
report(foreign('', '<script src="//a.example/x.js"></script><img src="https://a.example/x.png">url(https://a.example/f.woff2)').length === 3, 'such a file would be found');
none(own.flatMap(([file]) => idsIn(file).filter((id, i, all) => all.indexOf(id) !== i).map(id => `${file}: ${id}`)), 'no page has an id twice');

// ---- scenes ----

const blocks = own.filter(([file]) => !file.startsWith('source/')).flatMap(([file, html]) => [...html.matchAll(/<pre[^>]* data-language="krs"[^>]*><code>(.*?)<\/code>/gs)].map(match => ({ file, text: decoded(match[1].replace(/<[^>]*>/g, '')) })));
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'krs-site-'));
const checked = list => spawnSync(krs, ['check', '--color', 'never', ...list.map(({ text }, i) => {
    const file = path.join(work, `${i}.krs`);
    fs.writeFileSync(file, text);
    return file;
})], { encoding: 'utf8' });
report(blocks.length > 150, `pages have ${blocks.length} scenes and pieces`);
const { status, stderr } = checked(blocks);
report(status === 0 && stderr === '', 'each is compiled without an error or a warning', stderr.split('\n'));
report(checked([{ text: 'show spere(1);' }]).status === 1, 'a mistake in one would be found');
fs.rmSync(work, { recursive: true });
none(own.flatMap(([file, html]) => [...html.matchAll(/<figure class="scene.*?<\/figure>/gs)].flatMap(([figure]) => {
    const link = /playground\/index\.html#([^"]*)"/.exec(figure), text = /data-language="krs"[^>]*><code>(.*?)<\/code>/s.exec(figure);
    return link && sceneOf(link[1]).trim() !== decoded(text[1].replace(/<[^>]*>/g, '')).trim() ? [`${file}: ${text[1]}`] : [];
})), 'links to the playground hold the scene beside them');
const library = ['solids', 'figures', 'coils', 'curves', 'threads'].flatMap(name => [...fs.readFileSync(`compiler/library/${name}.krs`, 'utf8').matchAll(/^shape ([a-z]\w*)/gm)].map(match => match[1]));
none(library.filter(name => !new RegExp(`<h3 id="${name}">[\\s\\S]*?<img src="\\.\\./pictures/word-${name}-`).test(pages.get('reference/shapes.html'))),
     `each of the library's ${library.length} shapes has its place and its picture`);
const codes = [...fs.readFileSync('compiler/base/diag.def', 'utf8').matchAll(/^DIAG\((\w+),/gm)].map(match => match[1]);
none(codes.filter(code => !idsIn('reference/diagnostics.html').includes(code)), `each of ${codes.length} diagnostics has its place`);
const functions = [...fs.readFileSync('include/krs/krs.h', 'utf8').matchAll(/^(?:KRS_SIZED )?\w[\w ]*?[ *](krs_\w+)\(/gm)].map(match => match[1]);
none(functions.filter(name => !pages.get('reference/c.html').includes(name)), `the reference of C has the ${functions.length} functions of krs.h`);

// ---- in a browser ----

const axe = fs.readFileSync(path.join(build, 'npm/node_modules/axe-core/axe.min.js'), 'utf8');
const server = await serve(site), browser = await launch();
const asked = [];
const page = await browser.open(null, { width: 1440, height: 900 });
const take = page.take.bind(page);
page.take = (method, params) => (method === 'Network.requestWillBeSent' ? asked.push(params.request.url) : take(method, params));
await page.send('Network.enable');
await page.send('Emulation.setFocusEmulationEnabled', { enabled: true });
const media = (scheme, ...more) => page.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }, { name: 'prefers-reduced-motion', value: 'reduce' }, ...more] });
const size = (width, height) => page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: width < 500 });
const violations = () => page.evaluate(async () => (await axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'], resultTypes: ['violations'] })).violations
    .filter(({ impact }) => impact === 'serious' || impact === 'critical').map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(node => node.html.slice(0, 160)).join(' | ')}`));

const seen = ['index.html', 'docs/tutorial.html', 'docs/coming-from.html', 'reference/shapes.html', 'reference/commands.html'];
for (const file of seen)
    for (const [scheme, width] of [['light', 1440], ['dark', 390]]) {
        await media(scheme);
        await size(width, width === 390 ? 844 : 900);
        await page.go(`${server.url}/${file}`);
        await page.evaluate(axe);
        none(await violations(), `axe has no serious complaint of ${file}, ${scheme}, ${width} pixels wide`);
        const wide = await page.evaluate('document.documentElement.scrollWidth');
        report(wide <= width, `${file} is not wider than its page`, `${wide} of ${width}`);
        if (shots)
            await page.screenshot(path.join(shots, `${file.replaceAll('/', '-')}-${scheme}.png`));
    }
await page.evaluate(() => document.querySelector('main').insertAdjacentHTML('afterbegin', '<img src="../logo.svg"><p style="color: #777; background: #666">faint</p>'));
report((await violations()).length === 2, 'axe complains of a picture without words and of a faint text');

await size(1440, 900);
await page.go(`${server.url}/docs/meshes.html`);
await page.send('Input.dispatchKeyEvent', { type: 'keyDown', key: '/', text: '/' });
await page.until('document.getElementById("finder").open');
await page.type('torus');
await page.until('document.querySelector("#finder li")');
report(await page.evaluate('document.querySelector("#finder a").href') === `${server.url}/reference/shapes.html#torus`, 'a search for torus finds the shape first',
       await page.evaluate('[...document.querySelectorAll("#finder a")].map(a => a.href)'));
await page.evaluate('document.querySelector("#finder a").click()');
await page.until('location.hash === "#torus" && document.readyState === "complete"');
report(await page.evaluate('(top => top > 0 && top < 200)(document.getElementById("torus").getBoundingClientRect().top)'), 'and goes there');
const first = async words => {
    await page.evaluate(words => {
        document.getElementById('search').click();
        const field = document.querySelector('#finder input');
        field.value = words;
        field.dispatchEvent(new Event('input'));
    }, words);
    await page.until('document.querySelector("#finder li") || document.querySelector("#finder p").textContent');
    return page.evaluate('document.querySelector("#finder a")?.getAttribute("href") ?? document.querySelector("#finder p").textContent');
};
for (const [words, place] of [['E0402', '../reference/diagnostics.html#E0402'], ['krs_raycast', '../reference/c.html#krs_raycast'], ['twist', '../reference/functions.html#method-twist']])
    report(await first(words) === place, `${words} is found`, await first(words));
report(/Nothing/.test(await first('wordthatisnowhere')), 'a word that is nowhere is told');

await media('light');
await page.evaluate('document.getElementById("finder").close(); document.getElementById("theme").click()');
await page.go(`${server.url}/docs/tutorial.html`);
report(await page.evaluate('document.documentElement.dataset.theme') === 'dark', 'who has chosen dark colours has them on the next page');

// A scene that is clicked, and the first page's, which comes by itself, with a slider.
await page.evaluate('document.querySelectorAll(".turn")[0].click()');
await page.until('document.querySelector(".view").dataset.state === "there"', { seconds: 120 });
report(await page.evaluate('document.querySelector(".view krs-view").scene.ok'), 'a click on the picture of the first scene makes it live');
await page.go(`${server.url}/index.html`);
await page.until('document.querySelector(".first input[type=range]")', { seconds: 120 });
await page.evaluate(() => {
    const slider = document.querySelector('.first input[type=range]');
    slider.value = 0.7;
    slider.dispatchEvent(new Event('input'));
});
report(await page.until('document.querySelector(".first krs-view").scene.parameters[0].value[0] === 0.7'), 'the scene of the first page comes by itself, and follows its slider');
none(asked.filter(url => !url.startsWith(server.url) && !/^(?:blob|data|about):/.test(url)), `none of ${asked.length} requests went to another host`);
const absent = error => rendered.test(/\/pictures\/(.*)-[0-9a-f]{12}\.jpg/.exec(error)?.[1] ?? 'first');
none(page.errors.filter(absent), 'the console has no error');
await browser.close();
server.close();
console.log(`1..${number}`);
process.exit(failed ? 1 : 0);
