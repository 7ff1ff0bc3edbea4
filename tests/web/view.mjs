// view.mjs: <krs-view> in Chromium: a picture appears, follows values, the camera and edits, survives mistakes and a lost
// context, and never holds the page up.
//
//     node view.mjs build/web
import { launch, serve } from './browser.mjs';
import { counting, isTile, loggedBy } from './work.mjs';

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

const server = await serve({ '/': 'tests/web/pages', '/krs/': process.argv[2], '/examples/': 'examples' });
const browser = await launch();
const page = await browser.open(`${server.url}/view.html`, counting);
await page.until('window.krs');

const MOST_COPIED = 2 << 20; // bytes in a message of the page: some milliseconds

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

// What the worker that draws has done since it was asked last.
const logged = () => loggedBy(page, 'state', 'scene');
// Moves the camera, and returns how many tiles of the picture before are drawn after it.
async function tilesAfterMove() {
    await logged();
    await page.evaluate(() => new Promise(resolve => {
        const begun = performance.now();
        view.addEventListener('krs-frame', ({ detail }) => detail.elapsed < performance.now() - begun && resolve());
        view.camera = { fov: 0.9 * view.camera.fov };
    }));
    const log = await logged(), moved = log.indexOf('state'), begun = log.indexOf('begin', moved);
    return moved >= 0 && begun > moved ? log.slice(moved, begun).filter(isTile).length : Infinity;
}
const reportDropped = (tiles, what) => report(tiles <= 1, `${what} is dropped when the camera moves (${tiles} tiles later)`);

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
    const text = 'show sphere(0.4).move([-2.6, 0, 0]); show sphere(0.4).move([0, 3, 0]);\ncamera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }\nlight { direction: [0, 0, 1], intensity: 3 }\n' +
        'sky { zenith: black, horizon: black, ground: black }\n', scene = view.scene;
    const wide = await view.update(text, { name: 'wide.krs' }).then(() => view.ready).then(() => view.pick(80, 3));
    view.style.width = '90px';
    view.samples = 1;
    await settled();
    const [side, above] = [await view.pick(9, 45), await view.pick(45, 3)];
    // The ball at the left is seen where it is picked.
    const bitmap = await createImageBitmap(await view.snapshot(90, 90)), canvas = new OffscreenCanvas(90, 90), context = canvas.getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const [seen] = context.getImageData(9, 45, 1, 1).data, [beside] = context.getImageData(45, 45, 1, 1).data;
    view.style.width = '160px';
    view.samples = 2;
    view.scene = scene;
    await settled();
    return wide === null && side !== null && above !== null && seen > 60 && beside < 20;
}), 'a narrow view shows as much to the sides as the image of the scene');

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

// What is not drawn as krs render draws it is said in the corner.
const noted = await page.evaluate(async () => {
    const scenes = {
        'nothing': 'show sphere(1);', 'two eyes': 'show sphere(1); camera { eye: [0, 0, 5], eyes: 0.1 }',
        'motion blur': 'show sphere(1); camera { eye: [0, 0, 5], shutter: [0, 0.5] }',
        'the light of the integrator "path"': 'show sphere(1); image { integrator: "path" }',
        'what is inside of glass, and light through it': 'material glass { transmission: 1, roughness: 0 } show sphere(1).paint(glass);',
    }, wrong = [], note = view.shadowRoot.querySelector('p');
    for (const [what, text] of Object.entries(scenes)) {
        await view.update(text, { name: 'noted.krs' });
        await settled();
        const wanted = what === 'nothing' ? '' : `Not shown here: ${what}. See \`krs render noted.krs\`.`;
        if (note.textContent !== wanted)
            wrong.push(`${what}: "${note.textContent}"`);
    }
    return wrong.join('; ');
});
report(noted === '', `what the preview does not show is said in the corner ${noted}`);

const heavy = await page.evaluate(async () => {
    view.style.width = '640px';
    view.style.height = '360px';
    view.samples = 64;
    await view.update(await (await fetch('/examples/12-fractals.krs')).text(), { name: '12-fractals.krs', base: '/examples/' });
    frames.length = 0;
    while (!(frames.length > 0 && frames.at(-1).samples > 0))
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    const coarse = frames.at(-1);
    while (frames.at(-1).samples <= coarse.samples)
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
    return { coarse, finer: frames.at(-1) };
});
report(heavy.coarse.samples < 1, `a scene that is heavy is coarse at first (${heavy.coarse.samples} of a sample, after ${Math.round(heavy.coarse.elapsed)} ms)`);
// The camera moves while a picture is drawn that takes much longer.
reportDropped(await tilesAfterMove(), 'a heavy picture');
const light = 'show box([1, 1, 1]);';
await page.evaluate(async text => {
    view.samples = 100000;
    await view.update(text, { name: 'box.krs' });
    frames.length = 0;
    while (!(frames.at(-1)?.samples >= 2 && frames.at(-1).wanted === 100000))
        await new Promise(resolve => view.addEventListener('krs-frame', resolve, { once: true }));
}, light);
reportDropped(await tilesAfterMove(), 'a picture of many samples');
const work = await page.evaluate('work');
report(work.drawn === 0 && work.compiled === 0 && work.copied < MOST_COPIED, `the page itself draws and compiles nothing, and copies ${work.copied} bytes at most`);

report(page.errors.length === 0, `the console has no errors ${page.errors.join('; ').slice(0, 500)}`);
await browser.close();
server.close();
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
