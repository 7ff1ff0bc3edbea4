// words.mjs: the words of the language, from tables of the compiler and from itself, as JSON.
//
//     node words.mjs ROOT BUILD/wasm
//
// `tokens`: spellings by class; `names`: what can be called or named anywhere; `methods`: what stands behind a dot;
// `properties`: of each block; `files`: of the library, with what `use` makes visible.  Each has its parameters and a
// sentence.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [root, built] = process.argv.slice(2);
const { loadCore } = await import(pathToFileURL(path.resolve(built, 'core.mjs')));
const read = file => fs.readFileSync(path.join(root, file), 'utf8');
const rows = (file, pattern) => [...read(file).matchAll(pattern)].map(match => match.slice(1));

function tokens() {
    const classes = {};
    for (const [spelling, name] of rows('compiler/front/token.def', /^TOKEN\([A-Z_]+, *"([^"]+)", *([A-Z_]+)\)/gm))
        (classes[name] ??= []).push(spelling);
    return classes;
}

function properties() {
    const blocks = {};
    const add = (block, name) => (blocks[block] ??= new Set()).add(name);
    for (const [block, name] of rows('compiler/eval/properties.c', /\{SYNTAX_([A-Z]+), "([a-z_]+)", false\}/g))
        add(block.toLowerCase(), name);
    for (const [name] of rows('include/krs/surface.def', /^KRS_MATERIAL\((\w+),/gm))
        add('material', name);
    for (const [name] of rows('include/krs/camera.def', /^KRS_CAMERA(?:_FIXED)?\((\w+),/gm))
        add('camera', name);
    for (const named of rows('include/krs/lights.def', /^KRS_LIGHT\(\w+, *\w+, *(?:NULL|"(\w+)"), *"(\w+)"/gm))
        named.filter(Boolean).forEach(name => add('light', name));
    return Object.fromEntries(Object.entries(blocks).map(([block, names]) => [block, [...names].sort()]));
}

// As in a call: `?` marks what may be left out.
const parameter = ({ name, many, optional, default: value }) =>
    many ? `${name}...` : value !== undefined ? `${name} = ${value}` : optional ? `${name}?` : name;

function word({ kind, name, parameters, about = '', file }) {
    const flat = about.replace(/\s+/g, ' ').trim();
    return { kind, name, parameters: parameters ? parameters.map(parameter).join(', ') : null, about: flat, file };
}

const core = await loadCore({ wasm: fs.readFileSync(path.join(built, 'krs.wasm')) });
const known = core.vocabulary().map(word);
const files = {};
for (const { file = '', ...one } of known)
    (files[file] ??= []).push(one);
process.stdout.write(JSON.stringify({
    tokens: tokens(),
    names: files[''].filter(({ kind }) => kind !== 'method'),
    methods: files[''].filter(({ kind }) => kind === 'method'),
    properties: properties(),
    files: Object.fromEntries(Object.entries(files).filter(([name]) => name !== '')),
}));
