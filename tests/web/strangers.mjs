// strangers.mjs: what scenes of strangers may take, and what is told when something fails, in Chromium.
//
//     node strangers.mjs build/web
import { launch, serve } from './browser.mjs';

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

const server = await serve({ '/': 'tests/web/pages', '/krs/': process.argv[2], '/examples/': 'examples' });
const browser = await launch();
// A text with this word breaks the compiler.
const breaking = `{
    const { encode } = TextEncoder.prototype;
    TextEncoder.prototype.encode = function (text) {
        if (text?.includes('PLANTED'))
            throw new WebAssembly.RuntimeError('unreachable');
        return encode.call(this, text);
    };
}`;
const page = await browser.open(`${server.url}/package.html`, { inWorkers: breaking });
await page.until('window.krs');

// ---- the compiler ----

const endless = 'def f(n) = if n < 2 then n else f(n - 1) + f(n - 2);\nshow sphere(f(60));';
const timed = await page.evaluate(async endless => {
    const kept = await krs.compile('param radius = 1; show sphere(radius);');
    await kept.set('radius', 2);
    krs.limits.seconds = 2;
    const told = await Promise.all([krs.compile(endless).then(() => 'compiled', error => error.message), krs.compile('show sphere(3);'), kept.distance([0, 5, 0]),
        krs.ask('textDocument/hover', endless, { position: { line: 0, character: 4 } })]);
    krs.limits.seconds = 60;
    return [told[0], told[1].ok, ...told[2], told[3] !== undefined];
}, endless);
report(timed.join() === 'the scene takes more than 2 s,true,3,true', `an endless compilation is ended, and what waits behind it is answered (${timed})`);

const large = await page.evaluate(async () => {
    const { memory } = krs.limits, text = 'show union([sphere(0.1).move([random(i), random(i + 0.5), 0]) for i in 0..20000]);';
    krs.limits.memory = 2 ** 21;
    const told = await krs.compile(text).then(() => 'compiled', error => error.message);
    krs.limits.memory = memory;
    return [told, (await krs.compile(text)).ok];
});
report(large.join() === 'the scene takes more than 2 MiB,true', `memory is limited (${large})`);

const broken = await page.evaluate(async () => {
    const kept = await krs.compile('show sphere(2);');
    const [told, distance] = await Promise.all([krs.compile('show sphere(1); // PLANTED').then(() => 'compiled', error => error.message), kept.distance([0, 5, 0])]);
    return [told, distance[0]];
});
report(broken.join() === 'the compiler has failed: unreachable,3', `a compiler that fails is replaced (${broken})`);

const files = async options => {
    server.asked.length = 0;
    const told = await page.evaluate(async (texts, options) => {
        const scenes = await Promise.all(texts.map(text => krs.compile(text, options)));
        return scenes.map(scene => scene.ok);
    }, ['use "parts/noise.krs"; show sphere(1);', 'use "../package.html"; show sphere(1);', 'use "//127.0.0.1:9/x.krs"; show sphere(1);', `use "${server.url}/package.html"; show sphere(1);`], options);
    return `${told} ${server.asked}`;
};
const near = await files({ base: '/examples/' }), above = await files({ base: '/examples/', root: '/' });
report(near === 'true,false,false,false /examples/parts/noise.krs', `files are those of a scene's folder (${near})`);
report(above === 'true,false,false,false /package.html', `or of a folder that the page names (${above})`);
const sized = await page.evaluate(async () => {
    const { bytes } = krs.limits, text = 'use "parts/frieze.krs"; show sphere(1);';
    krs.limits.bytes = 100;
    const refused = !(await krs.compile(text, { base: '/examples/' })).ok;
    krs.limits.bytes = bytes;
    return [refused, (await krs.compile(text, { base: '/examples/' })).ok];
});
report(sized.join() === 'true,true', `files are as large as is permitted (${sized})`);
server.missing.add('/examples/parts/frieze.krs');
const late = () => page.evaluate(async () => (await krs.compile('use "parts/frieze.krs"; show sphere(2);', { base: '/examples/late/../' })).ok);
await page.evaluate(() => krs.stop());
const absent = await late();
server.missing.clear();
report(!absent && await late(), 'a file that was not there is fetched later');
const whole = await page.evaluate(async () => (await krs.compile(`// ${'x'.repeat(1 << 20)}\nshow sphere(1);`)).ok);
report(whole, 'a text of a megabyte is compiled');

// ---- views ----

const two = await browser.open(`${server.url}/view.html`, { inWorkers: `addEventListener('message', ({ data }) => { self.canvas ??= data.canvas; });` });
await two.until('window.krs');
const shown = await two.evaluate(async () => {
    view.samples = 1;
    view.style.cssText = 'width: 64px; height: 36px';
    const others = [1, 2].map(() => view.parentNode.appendChild(Object.assign(document.createElement('krs-view'), { samples: 1 })));
    others.forEach(other => { other.style.cssText = 'width: 64px; height: 36px'; });
    const scene = await krs.compile('show sphere(1);');
    for (const each of [view, ...others])
        each.scene = scene;
    await new Promise(resolve => others[0].addEventListener('krs-frame', resolve, { once: true }));
    others[0].remove(); // while it draws
    await Promise.all([view, others[1]].map(each => each.ready));
    const [first, second] = await Promise.all([view, others[1]].map(async each => (await each.snapshot(32, 18)).size));
    const detached = document.createElement('krs-view');
    return [first === second && first > 100, await detached.snapshot().catch(error => error.message)];
});
report(shown[0] && /not in a page/.test(shown[1]), `several views show a scene while another is taken away (${shown})`);

// The context of a view is lost, as by a driver that gives up.
const lose = () => {
    const worker = two.workers.find(each => each.drawing);
    return worker.evaluate(async () => {
        const losing = self.canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        losing.loseContext();
        await new Promise(resolve => setTimeout(resolve, 100));
        losing.restoreContext();
    });
};
for (const worker of two.workers)
    worker.drawing = await worker.evaluate('self.canvas !== undefined');
await two.evaluate(() => {
    view.samples = 1e6; // it is never finished
    window.failures = [];
    view.addEventListener('krs-error', ({ detail }) => failures.push(detail));
    return view.update('show box([1, 1, 1]);', {});
});
const frame = () => two.evaluate(() => new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true })).then(() => failures.length));
await frame();
await lose();
report(await frame() === 0, 'a context that was lost comes back');
await lose();
await frame();
await lose();
await two.until('failures.length > 0');
report((await two.evaluate('failures')).join() === 'the graphics card has given up on this scene', 'a scene by which it is lost again and again is given up');
await two.evaluate(() => { failures.length = 0; return view.update('show box([1, 2, 1]);', {}); });
report(await frame() === 0, 'another is drawn');
two.errors = two.errors.filter(error => !/given up/.test(error));
report(two.errors.length === 0, `nothing else is an error ${two.errors.join('; ').slice(0, 300)}`);

const none = await browser.open(`${server.url}/view.html`, { inWorkers: 'OffscreenCanvas.prototype.getContext = () => null;' });
await none.until('window.krs');
const untold = await none.evaluate(async () => {
    const failure = new Promise(resolve => view.addEventListener('krs-error', ({ detail }) => resolve(detail), { once: true }));
    const { ok } = await view.update('show sphere(1);', {});
    return [ok, await failure, view.shadowRoot.querySelector('p').textContent, await view.snapshot(8, 8).catch(error => error.message)];
});
const why = 'this browser has no WebGL2 with pixels of floats';
report(untold.join() === `true,${why},No picture: ${why},${why}`, `where there is no WebGL2, that is told (${untold})`);

const refused = await browser.open(`${server.url}/view.html`);
await refused.until('window.krs');
const named = await refused.evaluate(async () => {
    const told = src => new Promise(resolve => {
        view.addEventListener('krs-error', ({ detail }) => resolve(detail), { once: true });
        view.src = src;
    });
    return told('/examples/none.krs');
});
report(/none\.krs: Not Found/.test(named), `a scene that is not there is told (${named})`);

await browser.close();
server.close();
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
