// view.mjs: <krs-view> in Chromium: a picture appears, follows values, the camera and edits, survives mistakes and a lost
// context, and never holds the page up.
//
//     node view.mjs build/web
import { launch, serve } from './browser.mjs';

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

const server = await serve({ '/': 'tests/web/pages', '/krs/': process.argv[2], '/examples/': 'examples' });
const browser = await launch();
// What workers do is logged: messages, programs that are linked, tiles that are read, pictures that begin.
const page = await browser.open(`${server.url}/view.html`, { inWorkers: `
    self.log = [];
    for (const [name, what] of Object.entries({ linkProgram: 'program', readPixels: 'tile', clearBufferfv: 'begin' })) {
        const call = WebGL2RenderingContext.prototype[name];
        WebGL2RenderingContext.prototype[name] = function (...values) { log.push(what); return call.apply(this, values); };
    }
    addEventListener('message', ({ data }) => log.push(data.call));` });
await page.until('window.krs');

// The mean colour of a part of the picture as it is shown, from 0 to 255.
await page.evaluate(() => {
    window.mean = async (x, y, width, height) => {
        const bitmap = await createImageBitmap(await view.snapshot(160, 90)), canvas = new OffscreenCanvas(160, 90), context = canvas.getContext('2d');
        context.drawImage(bitmap, 0, 0);
        const { data } = context.getImageData(x, y, width, height), sums = [0, 0, 0];
        data.forEach((value, i) => { if (i % 4 < 3) sums[i % 4] += value; });
        return sums.map(sum => sum / (width * height));
    };
    window.settled = () => view.ready;
    // How long the page was held up at most, in milliseconds.
    window.longest = 0;
    let last = performance.now();
    setInterval(() => {
        const now = performance.now();
        longest = Math.max(longest, now - last);
        last = now;
    }, 1);
});
const scene = 'param radius = 1 in [0.2, 1.5];\nparam tint = #d02020;\nmaterial matte { color: tint, roughness: 1 }\n' +
    'show sphere(radius).paint(matte);\ncamera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }\n' +
    'camera side { eye: [0, 20, 0.1], target: [0, 18, 0] }\nlight { direction: [0, 0, 1], intensity: 3 }\nsky { zenith: black, horizon: black, ground: black }\n';
const started = await page.evaluate(async text => {
    view.samples = 2;
    view.style.width = '160px';
    view.style.height = '90px';
    const update = await view.update(text, { name: 'scene.krs' });
    await settled();
    return { ok: update.ok, frames: frames.length, middle: await mean(75, 40, 10, 10), corner: await mean(0, 0, 10, 10) };
}, scene);
report(started.ok && started.middle[0] > 100 && started.middle[0] > 2 * started.middle[1] && started.corner.every(c => c < 8),
    `a red ball is in the middle (${started.middle.map(Math.round)}), and black around it`);

// The log of the worker that draws, since it was asked last.
async function logged() {
    const logs = await Promise.all(page.workers.map(worker => worker.evaluate('log.splice(0)')));
    return logs.find(log => log.some(what => what === 'state' || what === 'scene')) ?? [];
}
await logged();
const followed = await page.evaluate(async text => {
    const first = await view.update(text.replace('[0, 0, 5]', '[0, 0, 4.5]')), { change } = await view.update(text);
    await settled();
    return [first.change, change];
}, scene);
const edited = await logged();
report(followed.join() === 'values,values' && edited.includes('state') && !edited.includes('program'),
    `an edit of a number, also the first, links no program (${followed})`);
await page.evaluate(async text => {
    await view.update(text.replace('sphere(radius)', '(sphere(radius) | box([0.5, 2, 0.5]))'));
    await settled();
    await view.update(text);
    await settled();
}, scene);
report((await logged()).filter(what => what === 'program').length >= 4, 'an edit of the structure links some');

report(await page.evaluate(async text => {
    const wide = text.replace('fov: 40deg', 'fov: 100deg');
    await view.update(wide);
    await view.update(wide.replace('radius = 1 in [0.2, 1.5]', 'radius = 4 in [3, 4.5]'));
    await settled();
    const large = await mean(30, 40, 10, 10);
    await view.update(text.replace('camera {', 'image { exposure: -20 } camera {'));
    await settled();
    const dark = await mean(75, 40, 10, 10);
    await view.update(text);
    await settled();
    return large[0] > 30 && dark[0] < 8;
}, scene), 'edits of numbers make things larger, and pictures darker');

report(await page.evaluate(async () => {
    await view.scene.set('radius', 0.2);
    await settled();
    const beside = await mean(95, 40, 10, 10);
    await view.scene.set('radius', 1);
    await view.scene.set('tint', [0, 0, 1]);
    await settled();
    const [red, , blue] = await mean(75, 40, 10, 10);
    return beside[0] < 8 && blue > 2 * red;
}), 'it follows parameters');

report(await page.evaluate(async text => {
    const refused = await view.update('show spere(1);');
    const kept = await mean(75, 40, 10, 10), edited = await view.update(text.replace('sphere(radius)', 'box([1.4, 1.4, 1.4])'));
    await settled();
    const [, , blue] = await mean(75, 40, 10, 10);
    return !refused.ok && kept[2] > 100 && edited.ok && blue > 100;
}, scene), 'a mistake keeps the last picture, and an edit is shown');

report(await page.evaluate(async () => {
    const seen = [];
    view.addEventListener('krs-camera', event => seen.push(event.detail));
    const hit = await view.pick(80, 45), none = await view.pick(2, 2);
    view.camera = 'side';
    await settled();
    const away = await mean(75, 40, 10, 10);
    view.camera = null;
    await settled();
    const canvas = view.shadowRoot.querySelector('canvas'), at = { pointerId: 1, bubbles: true };
    canvas.setPointerCapture = () => {};
    canvas.dispatchEvent(new PointerEvent('pointerdown', { ...at, clientX: 80, clientY: 45 }));
    canvas.dispatchEvent(new PointerEvent('pointermove', { ...at, clientX: 90, clientY: 40 }));
    canvas.dispatchEvent(new PointerEvent('pointerup', { ...at, clientX: 90, clientY: 40 }));
    const turned = view.camera.eye;
    view.camera = null;
    await settled();
    return Math.abs(hit.t - 4.3) < 1e-5 && none === null && away.every(c => c < 8) && seen.length === 1 &&
        Math.abs(Math.hypot(...turned) - 5) < 1e-9 && turned[0] < 0 && turned[1] < 0;
}), 'cameras are chosen by name, dragging turns about the target, and a place of the picture is a point of the scene');

report(await page.evaluate(async () => {
    const parent = view.parentNode;
    view.remove();
    parent.prepend(view);
    await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    view.remove();
    await new Promise(resolve => setTimeout(resolve, 200));
    frames.length = 0;
    parent.prepend(view);
    await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    await settled();
    const [, , blue] = await mean(75, 40, 10, 10);
    return blue > 100;
}), 'a context that was lost comes back');

report(await page.evaluate(async () => {
    await view.update('param speed = 1;\nshow sphere(0.5).move([sin(speed * time), 0, 0]);\nlight { direction: [0, 0, 1] }', {});
    view.playing = true;
    frames.length = 0;
    while (frames.length < 4 || frames.at(-1).time === frames[0].time)
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    view.playing = false;
    view.time = 2;
    await settled();
    return Math.abs(frames.at(-1).time - 2) < 1e-9;
}), 'time runs and stops');

const heavy = await page.evaluate(async () => {
    view.style.width = '640px';
    view.style.height = '360px';
    view.samples = 64;
    await view.update(await (await fetch('/examples/12-fractals.krs')).text(), { name: '12-fractals.krs', base: '/examples/' });
    frames.length = 0;
    while (!(frames.length > 0 && frames.at(-1).samples > 0))
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    const coarse = frames.at(-1);
    longest = 0;
    await new Promise(resolve => setTimeout(resolve, 1000));
    const page = longest;
    // The camera moves while a picture is drawn that takes much longer.
    const begun = performance.now();
    view.camera = { fov: 0.9 * view.camera.fov };
    await new Promise(resolve => {
        const heard = event => {
            if (event.detail.elapsed < performance.now() - begun + 1) {
                view.removeEventListener('krs-frame', heard);
                resolve();
            }
        };
        view.addEventListener('krs-frame', heard);
    });
    return { coarse, page, moved: performance.now() - begun };
});
report(heavy.coarse.samples < 1, `a scene that is heavy is coarse at first (${heavy.coarse.samples} of a sample, after ${Math.round(heavy.coarse.elapsed)} ms)`);
const light = 'show box([1, 1, 1]);';
await page.evaluate(async text => {
    view.samples = 100000;
    await view.update(text, { name: 'box.krs' });
    frames.length = 0;
    while (!(frames.at(-1)?.samples >= 2 && frames.at(-1).wanted === 100000))
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
}, light);
await logged();
await page.evaluate(() => new Promise(resolve => {
    view.camera = { fov: 0.9 * view.camera.fov };
    view.addEventListener('krs-frame', ({ detail }) => detail.samples < 1 && resolve());
}));
const moves = await logged(), moved = moves.indexOf('state'), old = moves.slice(moved, moves.indexOf('begin', moved)).filter(what => what === 'tile').length;
report(moved >= 0 && moves.slice(0, moved).includes('tile') && old <= 1, `a picture that goes on for long ends when the camera moves (${old} tiles later)`);
console.log(`# the page was held up for ${Math.round(heavy.page)} ms at most; a moved camera showed after ${Math.round(heavy.moved)} ms`);

report(page.errors.length === 0, `the console has no errors ${page.errors.join('; ').slice(0, 500)}`);
await browser.close();
server.close();
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
