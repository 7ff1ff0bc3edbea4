// package.mjs: the package for pages, in Chromium: scenes, parameters, mistakes, questions, meshes.
//
//     node package.mjs build/web
//
// Prints TAP.
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { launch, serve } from './browser.mjs';

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

// What a page waits for.  Servers compress, the better ones by brotli.
const size = names => zlib.brotliCompressSync(Buffer.concat(names.map(name => fs.readFileSync(path.join(process.argv[2], name))))).length / 1000;
const core = ['krs.wasm', 'krs.mjs', 'core.mjs', 'worker.mjs'], letters = ['letters.wasm', 'letters.mjs'];
report(size(core) <= 600 && size(core) + size(letters) <= 800, `the compiler has at most 600 kB, with fonts 800 (${size(core)}, ${size(letters)})`);

const server = await serve({ '/': 'tests/web/pages', '/krs/': process.argv[2], '/examples/': 'examples' });
const browser = await launch();
const page = await browser.open(`${server.url}/package.html`);
await page.until('window.krs');

const told = await page.evaluate(async () => {
    const scene = await krs.compile('/// Of the ball.\nparam radius = 1 in [0.5, 2];\nparam turn = 30deg in [0deg, 90deg];\n' +
        'param shown = 1 in 0..2;\nparam tint = #c8553d;\nshow (if shown > 0.5 then sphere(radius) else box([1, 1, 1])).paint(tint).rotate([0, 1, 0], turn);');
    window.scene = scene;
    return { ok: scene.ok, kinds: scene.parameters.map(p => p.kind), doc: scene.parameters[0].doc, high: scene.parameters[0].high[0],
        open: scene.parameters[3].high[0] === Infinity, cameras: scene.cameras.length, names: scene.components.map(c => c.name),
        messages: scene.diagnostics.map(d => d.message) };
});
report(told.ok && told.kinds.join() === 'number,angle,switch,color', `kinds of parameters are told (${told.kinds} ${told.messages})`);
report(told.doc === 'Of the ball.' && told.high === 2 && told.cameras === 1 && told.names.includes('floor'), 'so are ranges, comments, cameras and components');

report(await page.evaluate(async () => {
    let changes = 0;
    scene.addEventListener('change', () => changes++);
    const why = (...call) => scene.set(...call).then(() => 'it was set', error => error.message);
    await scene.set('radius', 2);
    const said = [await why('radius', 3), await why('width', 1), await why('tint', 1)];
    const [distance] = await scene.distance([0, 5, 0]);
    return said.join('; ') === 'radius cannot be 3: it is from 0.5 to 2; there is no parameter width: the scene has radius, turn, shown, tint; ' +
        'tint cannot be 1: it has 3 numbers' && changes === 1 && Math.abs(distance - 3) < 1e-9 && scene.parameters[0].value[0] === 2;
}), 'parameters are set in their range, and what is refused has a reason');

report(await page.evaluate(async () => {
    const text = scene.text, first = await scene.update(text.replace('1 in [0.5', '1.2 in [0.5'));
    const same = await scene.update(text.replace('1 in [0.5', '1.5 in [0.5'));
    const kept = (await scene.distance([0, 5, 0]))[0], refused = await scene.update('show spere(1);');
    const still = (await scene.distance([0, 5, 0]))[0];
    await scene.reset();
    const now = (await scene.distance([0, 5, 0]))[0];
    const comment = await scene.update(`${scene.text} // nothing`);
    return first.change === 'values' && same.change === 'values' && comment.change === 'nothing' && kept === 3 && !refused.ok && refused.diagnostics[0].data.replacement === 'sphere' &&
        still === 3 && now === 3.5 && scene.text !== 'show spere(1);';
}), 'an edit keeps values that were set, and a mistake keeps the scene');

report(await page.evaluate(async () => {
    const [first, second, third] = await Promise.all(['show sphere(1);', 'show sphere(2);', 'show sphere(3);'].map(text => scene.update(text)));
    return first.ok && second.ok && third.ok && (await scene.distance([0, 5, 0]))[0] === 2;
}), 'of edits that come at once the last counts');

report(await page.evaluate(async () => {
    const kept = await krs.compile('param radius = 1 in [0.5, 2]; show sphere(radius);');
    await kept.set('radius', 2);
    const long = 'def f(n) = if n < 2 then n else f(n - 1) + f(n - 2); show sphere(f(40));';
    const ended = kept.update(long).then(() => 'was compiled', error => error.message);
    setTimeout(krs.stop, 100);
    return /ended/.test(await ended) && (await kept.distance([0, 5, 0]))[0] === 3 && (await kept.update('show sphere(1);')).ok;
}), 'a compilation is ended, and its scene is there again');

report(await page.evaluate(async () => {
    const text = 'param radius = 1;\nshow sph', position = { line: 1, character: 8 };
    const offered = await krs.ask('textDocument/completion', text, { position });
    const { contents } = await krs.ask('textDocument/hover', text, { position: { line: 0, character: 8 } });
    return offered.some(item => item.label === 'sphere') && offered.some(item => item.label === 'radius') && /radius/.test(contents.value);
}), 'editors are answered, also about texts with mistakes');

report(await page.evaluate(async () => {
    const [hit] = await scene.query([[0, 4, 0]]), [ray] = await scene.raycast([[0, 9, 0]], [[0, -1, 0]]);
    const normals = await scene.normal([[0, 4, 0], [4, 0, 0]]);
    return normals.every((x, i) => Math.abs(x - [0, 1, 0, 1, 0, 0][i]) < 1e-9) && Math.abs(hit.normal[1] - 1) < 1e-9 && Math.abs(ray.t - 6) < 1e-6 && ray.component === 1;
}), 'points and rays are answered');

report(await page.evaluate(async () => {
    const told = [], mesh = await scene.mesh({ error: 0.05, progress: done => told.push(done) });
    return mesh.triangles.length / 3 === 2 * (mesh.vertices.length / 3) - 4 &&
        mesh.vertices.every((_, i) => i % 3 || Math.abs(Math.hypot(...mesh.vertices.slice(i, i + 3)) - 3) < 0.05);
}), 'a mesh of a ball is a sphere, within its error');

report(await page.evaluate(async () => {
    const many = await krs.compile('show union([sphere(0.3).move(random_direction(i) * 4) for i in 0..60], blend: 0.1);');
    const ending = new AbortController(), begun = performance.now();
    setTimeout(() => ending.abort(new Error('enough')), 300);
    const error = await many.mesh({ error: 0.0005, signal: ending.signal }).catch(e => e.message);
    return error === 'enough' && performance.now() - begun < 1000;
}), 'a mesh can be ended');

const unmade = await page.evaluate(async () => {
    const why = async (text, how) => (await krs.compile(text)).mesh(how).then(() => 'it was made', error => error.message);
    return [await why('show plane([0, 1, 0], 0);'), await why('show sphere(1);', { component: 2 }), await why('show sphere(1);', { error: 1e-9 })];
});
report(['component 1 has no end', 'there is no component 2: the scene has 1', 'the error is too small: it is at least a 500,000th of the size']
    .every((reason, i) => unmade[i] === `no mesh is made: ${reason}`), `why there is no mesh is told (${unmade})`);

const deep = { 'within itself': 'def f(n) = f(n + 1);\nshow sphere(f(0));', deeply: 'def f(n) = if n > 0 then (f(n + 1) + 1) * 2 else 1;\nshow sphere(f(1));' };
for (const [what, text] of Object.entries(deep)) {
    const said = await page.evaluate(async text => (await krs.compile(text)).diagnostics.map(d => [d.code, d.message, d.range.start.line]), text);
    report(said.length === 1 && said[0][0] === 'E0503' && /within itself/.test(said[0][1]) && said[0][2] === 0, `endless recursion is told (${said})`);
}

report(!server.asked.some(name => /letters|ttf/.test(name)), 'what reads fonts is not fetched for scenes without texts');
server.missing.add('/krs/letters.wasm');
report(/^fonts cannot be read: .*404|^fonts cannot be read: .*Not Found/.test(await page.evaluate(() =>
    krs.compile('show text("krs").extrude(0.2);').catch(error => error.message))) && await page.evaluate(async () => (await krs.compile('show sphere(1);')).ok),
'where it cannot be fetched, that is told, and other scenes are compiled');
server.missing.clear();

report(await page.evaluate(async () => {
    const parts = await krs.compile('use "part.krs"; show part();', { files: { 'part.krs': 'def part() = sphere(2);' } });
    const none = await krs.compile('use "none.krs"; show sphere(1);');
    const fetched = await krs.compile(await (await fetch('/examples/15-town.krs')).text(), { name: '15-town.krs', base: '/examples/' });
    const written = await krs.compile('show text("krs").extrude(0.2);');
    return parts.ok && !none.ok && fetched.ok && written.ok;
}), 'files are given or fetched, and fonts are there');

report(await page.evaluate(async () => {
    const moving = await krs.compile('show sphere(1 + 0.2 * sin(time));'), still = await krs.compile('show sphere(1);');
    const formatted = await krs.format('show   sphere( 1 );'), wrong = await krs.format('show (');
    return moving.animated && !still.animated && formatted.text === 'show sphere(1);\n' && wrong.text === null &&
        wrong.diagnostics.length > 0 && (await krs.check('show spere(1);'))[0].code === 'E0201' && /^\d+\.\d+\.\d+$/.test(await krs.version());
}), 'texts are laid out and checked; what moves is told');

report(page.errors.filter(error => !/404|none\.krs/.test(error)).length === 0, `the console has no errors ${page.errors.join('; ')}`);
await browser.close();
server.close();
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
