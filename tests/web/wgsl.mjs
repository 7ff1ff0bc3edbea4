// wgsl.mjs: scenes as WGSL, in Chromium's WebGPU.
//
//     node wgsl.mjs FOLDER
//
// FOLDER has what points.c has written.  Prints TAP, and what was found of each scene if TIMES is set.  Where `npm install
// --no-save web-naga@1.0.1` has been called, or NAGA is its folder, naga reads the texts as well, and what it writes is compared.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch, serve } from './browser.mjs';

const folder = process.argv[2];
let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what.replaceAll('\n', ' ')}`);
    failed += !good;
};

const server = await serve({ '/': 'tests/web/pages', '/scenes/': folder });
const browser = await launch({ args: ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'] });
const page = await browser.open(`${server.url}/wgsl.html`);
const close = async () => {
    await browser.close();
    server.close();
};
if (await page.until('window.ready') === 'no adapter') {
    console.log('ok 1 - scenes as WGSL # SKIP Chromium has no WebGPU here');
    await close();
    process.exit(0);
}

const numbers = (Type, name, ending) => {
    const bytes = fs.readFileSync(path.join(folder, `${name}.${ending}`));
    return new Type(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};

const limited = number => Math.min(Math.max(number, 0), 1);
// Of what is far away in a table there is only a bound that is nearer to 0; within NEAR of a surface there is none.
const NEAR = 0.004;

// What is wrong of a scene, or nothing.  Distances differ by a ten-thousandth at most of the numbers that are added, and both
// functions have the same sign.  Colors are compared near surfaces; where solids touch, and where they jump, single precision may choose
// the other.
async function difference(name, text) {
    const answer = await page.evaluate((scene, own) => run(scene, own), name, text ?? null);
    if (answer.error)
        return answer.error;
    const points = numbers(Float32Array, name, 'points'), wanted = numbers(Float64Array, name, 'distances');
    const surfaces = numbers(Float32Array, name, 'surfaces'), tables = numbers(Uint8Array, name, 'cells').length > 0;
    let wrong = '', count = 0, equal = 0, near = 0, worst = 0, colors = 0;
    for (const [i, distance] of wanted.entries()) {
        const [found, lod, surface] = answer.found.slice(8 * i), place = points.slice(4 * i, 4 * i + 3);
        const size = 1 + place.reduce((sum, x) => sum + Math.abs(x), Math.abs(distance)), off = Math.abs(found - distance) / size;
        const bounds = tables && Math.abs(distance) > NEAR && found / distance > 0 && found / distance < 1;
        const good = (off <= 1e-4 || bounds) && Math.abs(surface - found) <= 1e-4 * size && (Math.abs(distance) < 1e-5 * size || lod > 0 === distance > 0);
        near += Math.abs(distance) <= NEAR;
        equal += off <= 1e-4;
        worst = Math.max(worst, bounds ? 0 : off);
        colors += Math.abs(distance) > 1e-6 && Math.abs(distance) <= 3 * NEAR && [0, 1, 2, 3].some(k => !(Math.abs(limited(answer.found[8 * i + 4 + k]) - surfaces[4 * i + k]) <= 1e-3));
        count += !good;
        wrong ||= good ? '' : `at ${[...place]} ${found}, ${lod}, ${surface} for ${distance}`;
    }
    if (process.env.TIMES)
        console.log(`# ${name}: compiled in ${answer.parse.toFixed(0)} and ${answer.pipeline.toFixed(0)} ms, ${near} near, ${equal} equal, ${colors} other colors, ${worst.toExponential(1)}`);
    if (count > 0 || equal < wanted.length / 2)
        return `${count} of ${wanted.length} distances differ, ${equal} are equal; ${wrong}`;
    return colors > wanted.length / 50 ? `${colors} of ${wanted.length} colors differ` : null;
}

const names = fs.readFileSync(path.join(folder, 'list'), 'utf8').trim().split('\n'), of = kind => names.filter(name => name.startsWith(kind));
const kinds = { field: 'functions of fields', color: 'functions of colors', solid: 'solids', instances: 'scenes of parts that are alike', random: 'random scenes' };

// ---- faults are found ----

const edited = async (name, from, to) => await difference(name, await page.evaluate((...edit) => whole(edit[0], edit.slice(1)), name, from, to)) ?? '';
report(/[0-9]{2,} of 1024 distances/.test(await edited('csg.krs', 'max(', 'min(')), 'a wrong phrase is found');
report(/distances differ/.test(await edited('field-3', '0.5 - 0.5', '0.5 - 0.49')), 'so is a wrong number in a helper');
report(/colors differ/.test(await edited('color-1', 'select(0.0, 1.0', 'select(1.0, 0.0')), 'and a choice of colors the other way round');
report(/expected|unresolved/.test(await edited('csg.krs', 'let ', 'float ')), 'and what is no WGSL');

// ---- scenes ----

for (const name of names.filter(n => n.endsWith('.krs'))) {
    const what = await difference(name);
    report(!what, `${name}${what ? `: ${what}` : ''}`);
}
for (const [kind, about] of Object.entries(kinds)) {
    let wrong = 0;
    for (const name of of(kind)) {
        const what = await difference(name);
        wrong += !!what;
        if (what)
            console.log(`# ${name}: ${what.replaceAll('\n', ' ')}`);
    }
    report(wrong === 0 && of(kind).length > 0, `${of(kind).length} ${about}`);
}

const refused = [];
for (const name of of('variant')) {
    const error = await page.evaluate(variant => check(variant), name);
    if (error)
        refused.push(`${name}: ${error}`);
}
report(refused.length === 0 && of('variant').length > 10, `${of('variant').length} variants are WGSL ${refused[0] ?? ''}`);

// ---- naga reads the same ----

const nagaFolder = path.resolve(process.env.NAGA ?? 'node_modules/web-naga');
if (fs.existsSync(nagaFolder)) {
    const naga = await import(pathToFileURL(path.join(nagaFolder, 'web_naga.js')));
    naga.initSync({ module: fs.readFileSync(path.join(nagaFolder, 'web_naga_bg.wasm')) });
    const read = [...of('field'), ...of('color'), ...of('solid'), ...of('random')], others = [];
    for (const name of read) {
        const text = await page.evaluate(scene => whole(scene), name);
        const what = await difference(name, naga.WgslFrontend.new().parse(text).to_wgsl());
        if (what)
            others.push(`${name}: ${what}`);
    }
    report(others.length === 0 && read.length > 60, `what naga makes of ${read.length} texts is the same ${others[0] ?? ''}`);
} else {
    report(true, `naga reads the same # SKIP ${nagaFolder} is not here`);
}

// ---- each helper is in some text ----

// No part of the language makes OP_cell.
const unmade = ['krs_cell'], helpers = fs.readdirSync('compiler/print/glsl').filter(name => name.endsWith('.glsl'))
    .flatMap(name => [...fs.readFileSync(`compiler/print/glsl/${name}`, 'utf8').matchAll(/^[\w]+ (krs_\w+)\(/gm)].map(match => match[1]));
const texts = names.filter(n => !n.startsWith('variant')).map(name => fs.readFileSync(path.join(folder, `${name}.wgsl`), 'utf8')).join('');
const variants = of('variant').map(name => fs.readFileSync(path.join(folder, `${name}.wgsl`), 'utf8')).join('');
const never = helpers.filter(name => !unmade.includes(name) && !(texts + variants).includes(`fn ${name.replace(/_N$/, '_1')}(`));
report(helpers.length > 60 && never.length === 0, `${helpers.length} helpers have been called ${never}`);
if (process.env.TIMES)
    console.log(`# not evaluated: ${helpers.filter(name => !texts.includes(`fn ${name}(`))}`);
console.log(`1..${number}`);
await close();
process.exit(failed ? 1 : 0);
