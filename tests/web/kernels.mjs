// kernels.mjs: shaders of the runtime as WGSL, in Chromium's WebGPU.
//
//     node kernels.mjs KERNELS SCENES
//
// KERNELS is what `make kernels` has made; SCENES has what points.c has written.  Prints TAP.
import fs from 'node:fs';
import path from 'node:path';
import { withScene } from '../../web/tracer/scene.mjs';
import { launch, serve } from './browser.mjs';

const [kernels, scenes] = process.argv.slice(2);
let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what.replaceAll('\n', ' ')}`);
    failed += !good;
};

const server = await serve({ '/': 'tests/web/pages' });
const browser = await launch({ args: ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'] });
const page = await browser.open(`${server.url}/kernels.html`);
const close = async () => {
    await browser.close();
    server.close();
};
if (await page.until('window.ready') === 'no adapter') {
    console.log('ok 1 - shaders as WGSL # SKIP Chromium has no WebGPU here');
    await close();
    process.exit(0);
}
const read = name => fs.readFileSync(path.join(kernels, `${name}.wgsl`), 'utf8');
const check = code => page.evaluate(text => check(text), code);

// ---- faults are found ----

const twice = read('shadow.comp').replace('fn main_1() {', '@group(1) @binding(2) var<storage, read_write> again: array<u32>;\nfn main_1() {\n    again[0] = 1u;');
report(/binding/.test(await check(twice) ?? ''), 'a binding that is declared twice is found');
const plain = read('shadow.comp').replace(/atomicAdd\(\(&(\S+)\), 1u\)/, '$1 + 1u');
report(/atomic/.test(await check(plain) ?? ''), 'and a plain access to what is counted');

// ---- all shaders ----

const names = fs.readdirSync(kernels).filter(name => name.endsWith('.wgsl')).map(name => name.slice(0, -5));
const wrong = [];
for (const name of names) {
    const error = await check(read(name));
    if (error)
        wrong.push(`${name}: ${error}`);
}
const sources = fs.readdirSync('runtime/shaders').filter(name => name.endsWith('.comp'));
report(wrong.length === 0 && sources.every(name => names.includes(name)), `${names.length} shaders are WGSL ${wrong[0] ?? ''}`);

// ---- points of scenes, as point_query.comp answers ----

const numbers = (Type, name, ending) => {
    const bytes = fs.readFileSync(path.join(scenes, `${name}.${ending}`));
    return new Type(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};
// Words of an answer, and where its distance and that of its surface are (runtime/shared/answers.h).
const rows = fs.readFileSync('include/krs/surface.def', 'utf8').match(/^KRS_(MATERIAL|IDENTITY)\(/gm).length;
const ANSWER = 8 + 4 * rows, DISTANCE = 3, SURFACE = 7;

// What is wrong of a scene, or nothing: distances are in double precision by the evaluator.
async function difference(name, edit = text => text) {
    const code = withScene(read('point_query.comp'), edit(fs.readFileSync(path.join(scenes, `${name}.wgsl`), 'utf8')));
    const places = numbers(Float32Array, name, 'points'), wanted = numbers(Float64Array, name, 'distances'), count = wanted.length;
    const points = new Float32Array(8 * count);
    for (let i = 0; i < count; i++)
        points.set(places.slice(4 * i, 4 * i + 3), 8 * i);
    const words = data => [...new Uint32Array(data.buffer)];
    // Scenes without numbers of a state declare a block that they never read.
    const parameters = code.includes('krs_parameter[') ? [[0, 0, words(numbers(Uint8Array, name, 'parameters')), 'uniform']] : [];
    const buffers = [...parameters, [1, 18, [count, 1, ...Array(14).fill(0)], 'uniform'], [1, 1, words(points)], [1, 2, Array(ANSWER * count).fill(0)]];
    const answer = await page.evaluate((...given) => run(...given), code, Math.ceil(count / 64), buffers);
    if (answer.error)
        return answer.error;
    const found = new Float32Array(new Uint32Array(answer.words).buffer);
    const off = [...wanted].filter((distance, i) => {
        const size = 1 + Math.abs(distance) + places.slice(4 * i, 4 * i + 3).reduce((sum, x) => sum + Math.abs(x), 0);
        return [DISTANCE, SURFACE].some(at => !(Math.abs(found[ANSWER * i + at] - distance) <= 1e-4 * size));
    });
    return off.length > 0 ? `${off.length} of ${count} distances differ` : null;
}

report(/[0-9]{2,} of 1024/.test(await difference('csg.krs', text => text.replaceAll('max(', 'min(')) ?? ''), 'a wrong phrase of a scene is found');
for (const name of fs.readFileSync(path.join(scenes, 'list'), 'utf8').trim().split('\n').filter(n => n.endsWith('.krs'))) {
    const what = await difference(name);
    report(!what, `${name} at 1024 points ${what ?? ''}`);
}

await close();
console.log(`1..${number}`);
process.exit(failed > 0 ? 1 : 0);
