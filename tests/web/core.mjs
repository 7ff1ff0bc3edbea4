// core.mjs: the core of pages makes of scenes what the native compiler makes of them, byte for byte.
//
//     node core.mjs MODULE FOLDER
//
// FOLDER has what texts.c has written.  Prints TAP, and how long compilations take.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [module, folder] = process.argv.slice(2);
const { loadCore, loadLetters } = await import(pathToFileURL(path.resolve(module, 'core.mjs')));
const read = file => {
    try {
        return fs.readFileSync(file);
    } catch {
        return null;
    }
};
const fonts = { 'DejaVu Serif': 'DejaVuSerif.ttf', 'DejaVu Serif:bold': 'DejaVuSerif-Bold.ttf' };
const letters = await loadLetters({ wasm: fs.readFileSync(path.join(module, 'letters.wasm')) });
const core = await loadCore({
    letters: () => letters,
    wasm: fs.readFileSync(path.join(module, 'krs.wasm')),
    load: read,
    font: name => ({ bytes: read(path.join('/usr/share/fonts/truetype/dejavu', fonts[name] ?? 'DejaVuSans.ttf')) }),
});

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

// The points of texts.c.
const lattice = Array.from({ length: 64 }, (_, i) => [i % 4, Math.floor(i / 4) % 4, Math.floor(i / 16)].map(k => 0.7 * (k - 1.5))).flat();

// What is different of a scene, or nothing.
function difference(name, file) {
    const wanted = ending => read(path.join(folder, `${name}.${ending}`));
    const begun = performance.now();
    const { scene, diagnostics } = core.compile(wanted('scene').toString(), { name: file });
    const took = performance.now() - begun;
    if (process.env.TIMES)
        console.log(`# ${name} ${took.toFixed(1)}`);
    if (!scene)
        return wanted('glsl') ? `${name}: ${diagnostics[0]?.message}` : null;
    const state = scene.state(), text = scene.text() ?? '', { rows, cells } = state.tables();
    const numbers = Buffer.concat([state.parameters(), rows, cells].map(part => Buffer.from(part.buffer)));
    const distances = Buffer.from(state.distance(lattice).buffer);
    state.free();
    scene.free();
    if (!wanted('glsl'))
        return `${name}: compiled, and not by the native compiler`;
    if (!wanted('glsl').equals(Buffer.from(text)))
        return `${name}: another text`;
    if (!wanted('numbers').equals(numbers))
        return `${name}: other numbers`;
    return wanted('distances').equals(distances) ? null : `${name}: other distances`;
}

const lines = fs.readFileSync(path.join(folder, 'list'), 'utf8').trim().split('\n').map(line => line.split(' '));
const random = lines.filter(([name]) => name.startsWith('random')), named = lines.filter(line => !random.includes(line));
for (const [name, file] of named) {
    const what = difference(name, file);
    report(!what, what ?? `${name} is the same`);
}
const others = random.map(([name, file]) => difference(name, file)).filter(what => what);
for (const what of others)
    console.log(`# ${what}`);
report(others.length === 0, `${random.length} random scenes are the same`);

// ---- what else a page asks ----

const text = '/// Of the ball.\nparam radius = 1 in [0.5, 2];\nlet ball = sphere(radius);\nshow ball;\n';
const { scene, status } = core.compile(text);
const about = scene.describe(), state = scene.state();
report(status === 0 && about.parameters[0].name === 'radius' && about.parameters[0].doc === 'Of the ball.', 'parameters are told');
report(state.set('radius', 2) && !state.set('radius', 3) && state.distance([4, 0, 0])[0] === 2, 'parameters are set in their range');
const studio = core.compile(text, { studio: true, pictures: true }).scene, pictured = studio.state();
report(pictured.view().cameras.length === 1 && pictured.view().lights.length > 0 && studio.describe().components[1].name === 'floor',
    'a picture has a camera, lights and a floor');
const hit = state.raycast([5, 0, 0], [-1, 0, 0]).hits[0];
report(hit.hit && Math.abs(hit.t - 3) < 1e-6 && hit.component === 1, 'rays hit');
report(Math.abs(state.probe([0, 3, 0]).hits[0].normal[1] - 1) < 1e-9, 'points are known');
const { vertices, triangles } = state.mesh({ component: 1, error: 0.05 });
report(triangles.length / 3 === 2 * (vertices.length / 3) - 4, 'a mesh of a ball is a sphere');
report(Array.from(vertices).every((_, i) => i % 3 || Math.abs(Math.hypot(...vertices.slice(i, i + 3)) - 2) < 0.05), 'it is within its error');
const edited = scene.update(text.replace('1 in', '1.5 in'));
report(edited.changes.kind === 'values' && edited.scene.describe().parameters[0].value[0] === 1.5, 'an edit is told');
const refused = core.compile('show spere(1);');
report(refused.scene === null && refused.status === 1 && refused.diagnostics[0].message.includes('spere'), 'mistakes are told');
report(core.compile('use "no.krs"; show sphere(1);').status === 1, 'there are no files but those that are supplied');
report(core.format('show   sphere( 1 );').text === 'show sphere(1);\n', 'texts are laid out');
report(core.compile(`show ${'-'.repeat(40)}sphere(1);`).scene === null, 'nothing ends the core');
for (const made of [pictured, studio, state, scene, edited.scene])
    made.free();

// ---- what an editor asks ----

core.open('let radius = 2;\nshow sphere(rad);\n');
report(core.complete({ line: 1, character: 15 }).some(item => item.label === 'radius'), 'names are completed');
report(core.hover({ line: 1, character: 7 }).contents.value.includes('A ball around the origin.'), 'hover tells documentation');
report(core.mistakes()[0].code === 'E0201', 'mistakes of an open text are told');
report(core.edit({ start: { line: 1, character: 12 }, end: { line: 1, character: 15 } }, 'radius') && core.mistakes().length === 0, 'open texts are edited');
report(core.hover({ line: 1, character: 13 }).contents.value.includes('= 2'), 'hover tells a value');
const [link] = [core.ask('textDocument/definition', { position: { line: 1, character: 7 } })];
report(link.uri === 'library:solids.krs' && core.library('solids.krs').split('\n')[link.range.start.line].startsWith('shape sphere('),
    'definitions lead into the library');
let why = '';
try {
    core.ask('textDocument/rename', { position: { line: 0, character: 5 }, newName: 'let' });
} catch (error) {
    why = error.message;
}
report(why.includes('not a name'), 'refusals have a reason');
core.close();
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
