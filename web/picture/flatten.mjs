// flatten.mjs: the shaders of pages as a module of texts: what they include of the runtime is put in place.
//
//     node flatten.mjs >shaders.mjs
//
// Conditions and macros stay, as ESSL has them too, but for `##`, which it has not.
import fs from 'node:fs';
import path from 'node:path';

const here = path.dirname(new URL(import.meta.url).pathname), root = path.join(here, '../..');
const folders = [here, root, ...['runtime/shaders', 'runtime/shared', 'include', 'compiler/print/glsl'].map(f => path.join(root, f))];
// The text of a scene may have functions of these names.
const renamed = /\bkrs_(sin|cos|tan|reduce|sine_small)\b|\bKRS_SINES\b/g;

const locate = name => folders.map(folder => path.join(folder, name)).find(file => fs.existsSync(file));
const withoutComments = text => text.replace(/\/\*[^]*?\*\/|\/\/.*/g, ' ').replace(/\\\n\s*/g, ' ');

function include(name) {
    const file = locate(name);
    if (!file)
        throw new Error(`no file ${name}`);
    return withoutComments(fs.readFileSync(file, 'utf8'))
        .replace(/^ *# *include *"(.*)" *$/gm, (_, other) => include(other))
        .replace(/^ *# *(version|extension).*$/gm, '');
}

// The arguments of a call whose opening parenthesis is at `at`, and where it ends.
function argumentsAt(text, at) {
    const found = [];
    let depth = 0, from = at + 1;
    for (let i = at; ; i++) {
        if (text[i] === '(' || text[i] === '[')
            depth++;
        const ends = (text[i] === ')' || text[i] === ']') && --depth === 0;
        if (ends || (text[i] === ',' && depth === 1)) {
            found.push(text.slice(from, i).trim());
            from = i + 1;
        }
        if (ends)
            return { found, end: from };
    }
}

// Macros whose bodies join words are taken out, and their calls expanded.
function expandJoins(text) {
    const start = /^ *# *define +(\w+)\(([^)]*)\)(.*##.*)$/m.exec(text);
    if (!start)
        return text;
    const [line, name, parameters, body] = start, names = parameters.split(',').map(word => word.trim());
    const after = text.slice(start.index + line.length), undef = new RegExp(`^ *# *undef +${name} *$`, 'm').exec(after);
    let rest = after.slice(undef.index + undef[0].length), inside = after.slice(0, undef.index), call;
    const calls = new RegExp(`^ *${name}\\(`, 'm');
    while ((call = calls.exec(inside))) {
        const { found, end } = argumentsAt(inside, call.index + call[0].length - 1);
        const made = body.replace(/\b\w+\b/g, word => (names.includes(word) ? found[names.indexOf(word)] : word)).replace(/ *## */g, '');
        inside = `${inside.slice(0, call.index)}${made}${inside.slice(end)}`;
    }
    return expandJoins(text.slice(0, start.index) + inside + rest);
}

const flatten = name => expandJoins(include(name)).replace(/\bprecise +/g, '')
    .replace(renamed, word => word.replace(/krs/i, found => (found === 'krs' ? 'page' : 'PAGE')))
    .split('\n').map(line => line.replace(/[ \t]+/g, ' ').trimEnd()).filter(line => line.trim()).join('\n');

const stages = fs.readdirSync(here).filter(name => name.endsWith('.frag')).sort();
console.log('// Made by web/picture/flatten.mjs of the shaders in web/picture and runtime/shaders.');
for (const stage of stages)
    console.log(`export const ${path.basename(stage, '.frag')} = ${JSON.stringify(`${flatten(stage)}\n`).replace(/\\n/g, '\\n\\\n')};`);
