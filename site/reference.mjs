// reference.mjs: pages that are made of tables and comments: words of the language, commands, headers, diagnostics.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { block, escaped, highlighted, krs as highlight } from './code.mjs';
import { slugOf } from './markdown.mjs';

const lines = (...given) => given.flat(Infinity).filter(line => line !== '' && line != null).join('\n');
const heading = (level, title, id = slugOf(title), html = escaped(title)) =>
    `<h${level} id="${id}">${html} <a class="anchor" href="#${id}" aria-label="Link to ${escaped(title)}">#</a></h${level}>`;

// Of these the words are shapes; of others their pictures show shapes that are known already.
const FILES_OF_SHAPES = ['std/trees.krs', 'std/nature.krs', 'std/terrain.krs', 'std/surfaces.krs'];

export class Reference {
    // `words` is the program that lists the words of the language, `scene` shows a scene, `markdown` reads texts.
    constructor({ root, krs, words, scene, markdown, pictures }) {
        Object.assign(this, { root, krs, scene, markdown, pictures });
        this.words = JSON.parse(execFileSync(words, { encoding: 'utf8' }));
        this.scenes = new Map(this.read('site/scenes.txt').split('\n').filter(line => line.includes(' | ') && !line.startsWith('#'))
            .map(line => line.split(/ \| (.*)/s).slice(0, 2)));
        this.declared = this.#declared();
        this.shown = new Set();
    }

    read(file) { return fs.readFileSync(path.join(this.root, file), 'utf8'); }
    run(...args) { return execFileSync(this.krs, args, { encoding: 'utf8', stdio: ['pipe', 'pipe', 'pipe'] }); }

    // ---- words of the language ----

    // What declarations of shapes say: their properties, with the example.
    #declared() {
        const folder = path.join(this.root, 'compiler/library'), found = new Map();
        for (const file of fs.readdirSync(folder, { recursive: true }).filter(name => name.endsWith('.krs')))
            for (const [, name, body] of fs.readFileSync(path.join(folder, file), 'utf8').matchAll(/^shape ([a-z]\w*)\([^{]*\{\n(.*?)\n\}/gms))
                found.set(name, { properties: new Set([...body.matchAll(/^    (\w+):/gm)].map(match => match[1])),
                                  example: /^    example: +(.*)/ms.exec(body)?.[1].replace(/\s+/g, ' ') });
        return found;
    }

    // The text of a scene that shows a word; null: none does.
    sceneOf({ name, kind, file, parameters }) {
        const given = this.scenes.get(kind === 'method' ? `.${name}` : name) ?? this.declared.get(name)?.example;
        if (given)
            return /\bshow /.test(given) ? `${given.replace(/; (?=show|camera)/g, ';\n').replace(/} (?=show)/g, '}\n')}\n`
                : /color_by|paint/.test(given) ? `show ${given};\n` : /^[\w.]+\(/.test(given) && closes(given) ? `show ${given}.paint(#3f8f86);\n` : `show (${given}).paint(#3f8f86);\n`;
        if (!file || kind !== 'function' || file === 'std/patterns.krs' || file === 'std/mirrors.krs' || name === 'growth')
            return null;
        const view = this.words.some(word => word.name === `${name}_view`) ? `camera { eye: ${name}_view }\n` : '';
        const paint = file === 'std/surfaces.krs' ? '.paint(#3f8f86)' : '';
        return parameters.every(({ optional }) => optional) ? `use "${file}";\nshow ${name}()${paint};\n${view}` : null;
    }

    #signature({ name, kind, parameters = [] }) {
        const written = parameters.map(({ name, many, optional, default: value, takes, range }) =>
            name + (many ? '...' : '') + (takes ? `: ${takes}` : '') + (value ? ` = ${value}` : optional && !many ? ' = ...' : '') + (range ? ` in ${range}` : ''));
        const line = `${kind === 'method' ? '.' : ''}${name}(${written.join(', ')})`;
        return line.length < 76 ? line : `${kind === 'method' ? '.' : ''}${name}(\n    ${written.join(',\n    ')}\n)`;
    }

    // What is known of a shape: of its example, and what its declaration has.
    #facts(word, text) {
        const declared = this.declared.get(word.name);
        if (!text || !(word.kind === 'shape' || this.place === 'reference/shapes.html' || FILES_OF_SHAPES.includes(word.file)))
            return '';
        const { components } = JSON.parse(execFileSync(this.krs, ['info', '--json', '--quiet', '-'], { input: text, encoding: 'utf8', maxBuffer: 1 << 26 }));
        const [{ exact, estimate, slope, low, high }] = components;
        const shape = components[0].shapes.find(part => part.name === word.name) ?? components[0], number = value => String(Number(value.toPrecision(3)));
        const size = low.every((value, i) => Number.isFinite(value) && Number.isFinite(high[i])) && low[0] !== null
            ? `${low.map((value, i) => number(high[i] - value)).join(' × ')}` : 'endless';
        const facts = [
            word.kind === 'shape' ? (shape.exact ? 'exact distance' : 'a bound on the distance') : exact ? 'exact distance' : estimate ? 'an estimate' : 'a bound on the distance',
            `slope ${number(slope)}`, `size here ${size}`,
            ...(declared ? [['core', 'keeps its size when rounded'], ['hull', 'can be in a hull'], ['uv', 'has u and v'], ['figure', 'a plane figure'], ['ball', 'can be a mirror'], ['plane', 'can be a mirror']]
                .filter(([property]) => declared.properties.has(property)).map(([, says]) => says) : []),
        ];
        return `<ul class="facts">${facts.map(fact => `<li${fact === 'exact distance' ? ' class="good"' : ''}>${escaped(fact)}</li>`).join('')}</ul>`;
    }

    #entry(word) {
        this.shown.add(word);
        const text = this.sceneOf(word), name = `${word.kind === 'method' ? '.' : ''}${word.name}`, id = word.kind === 'method' ? `method-${word.name}` : word.name;
        const told = lines(`<pre class="signature" tabindex="0"><code>${highlight(this.#signature(word))}</code></pre>`,
                           word.about ? this.markdown.blocks(sentence(word.about)) : '', this.#facts(word, text));
        return lines(heading(3, name, id, `<code>${name}</code>`),
                     text ? this.scene(text, { place: this.place }, { name: `word-${word.name}`, told, alt: `A picture of ${name}` }) : `<div class="told">${told}</div>`);
    }

    #group(title, words, about = '') { return words.length === 0 ? '' : lines(heading(2, title), about, words.map(word => this.#entry(word))); }

    #listed(title, words, about = '') {
        return lines(heading(2, title), about, '<dl class="listed">', words.map(word =>
            `<dt id="${word.name}"><code>${highlight(word.kind === 'value' ? word.name : this.#signature(word))}</code></dt><dd>${this.markdown.inline(sentence(word.about ?? ''))}</dd>`), '</dl>');
    }

    #page(title, about, ...parts) { return { title, html: lines(heading(1, title), `<p class="lead">${about}</p>`, parts) }; }

    shapes(place) {
        this.place = place;
        const own = this.words.filter(({ file }) => !file), named = (...names) => names.map(name => own.find(word => word.name === name && word.kind !== 'method'));
        const shapes = own.filter(({ kind }) => kind === 'shape'), is = (word, what) => this.declared.get(word.name).properties.has(what);
        const coils = ['helix', 'thread'], paths = ['bezier_capsule', 'bezier'];
        return this.#page('Shapes', 'Every shape of the library, with its parameters and their defaults. Each picture is the example that stands below it: turn it, or open it in the playground.',
            this.#group('Solids', shapes.filter(word => !is(word, 'figure') && ![...coils, ...paths].includes(word.name))),
            this.#group('Plane figures', [...shapes.filter(word => is(word, 'figure')), ...named('text')],
                '<p>Figures lie in x and y. <code>.extrude</code> and <code>.revolve</code> make solids of them.</p>'),
            this.#group('Coils and threads', named(...coils, 'trapezoid_thread')),
            this.#group('Paths', named('bezier_capsule', 'polyline', 'spline', 'cubic', 'bow', 'winding', 'tube', 'sweep', 'repeat_along')),
            this.#group('Equations and fractals', named('algebraic', 'field', 'julia', 'mandelbulb')),
            this.#group('Joined and cut', named('union', 'intersection', 'difference', 'xor', 'morph', 'meta', 'hull', 'loft', 'scatter')));
    }

    // What the page of shapes does not have, which is made before.
    functions(place) {
        this.place = place;
        const own = this.words.filter(({ file }) => !file), functions = own.filter(word => word.kind === 'function' && !this.shown.has(word));
        return this.#page('Functions and methods', 'What can be done with shapes, and with numbers. <a href="../docs/language.html#functions">The language</a> says more of each.',
            this.#group('Methods of shapes', own.filter(({ kind }) => kind === 'method')),
            this.#group('Functions with a picture', functions.filter(word => this.sceneOf(word))),
            this.#listed('Other functions', functions.filter(word => !this.sceneOf(word))),
            this.#listed('Values', own.filter(({ kind, about }) => kind === 'value' && about)));
    }

    files(place) {
        this.place = place;
        const titles = { 'std/trees.krs': 'Trees', 'std/nature.krs': 'Plants, fish and rocks', 'std/terrain.krs': 'Landscapes', 'std/surfaces.krs': 'Algebraic surfaces',
                         'std/patterns.krs': 'Patterns', 'std/mirrors.krs': 'Mirrors' };
        const others = [...new Set(this.words.map(({ file }) => file).filter(Boolean))];
        return this.#page('Trees, plants, surfaces, patterns', 'Files of the library that a scene asks for by <code>use</code>. All parameters have defaults, but for those that are said to be needed.',
            Object.entries(titles).concat(others.filter(file => !titles[file]).map(file => [file, file]))
                .map(([file, title]) => this.#group(title, this.words.filter(word => word.file === file && word.kind !== 'value'), `<pre tabindex="0"><code>${highlight(`use "${file}";`)}</code></pre>`)));
    }

    colours() {
        const colours = [...this.read('compiler/library/colours.krs').matchAll(/^let ([a-z]+) *= (#[0-9a-f]{6});/gm)];
        return this.#page('Colours', 'The colours of CSS have its names and values. All but <code>tan</code>, which is the tangent in the language: <code>#d2b48c</code> is that colour.',
            heading(2, 'Names'), `<ul class="colours">${colours.map(([, name, value]) =>
                `<li id="${name}"><span style="background: ${value}"></span><code>${name}</code><small>${value}</small></li>`).join('\n')}</ul>`);
    }

    // ---- diagnostics ----

    diagnostics() {
        const groups = { 1: 'Text and grammar', 2: 'Names', 3: 'Types and arguments', 4: 'Geometry', 5: 'Files and limits' };
        const list = this.run('explain').trim().split('\n').map(line => /^(\w+) +(.*)/.exec(line).slice(1));
        const examples = fs.readdirSync(path.join(this.root, 'tests/errors'));
        const entry = ([code, title]) => {
            const explained = this.run('explain', code).split('\n').slice(2).join('\n').trim(), example = examples.find(file => file.startsWith(`${code}-`) && file.endsWith('.krs'));
            const said = example ? this.read(`tests/errors/${example.replace('.krs', '.err')}`).split(/\n\n(?=\w+\[|\d+ )/)[0].replaceAll(`tests/errors/${example}`, 'scene.krs').replace(/ *\/\/~ \w+/g, '') : '';
            return lines(heading(3, `${code}: ${title}`, code, `<code>${code}</code> ${escaped(title)}`), this.markdown.blocks(explained), said ? `<pre tabindex="0" class="said"><code>${marked(said)}</code></pre>` : '');
        };
        const severities = { E: 'Errors', W: 'Warnings', N: 'Notes' };
        return this.#page('Diagnostics', 'What the compiler says of a scene. <code>krs explain CODE</code> prints the same. Codes keep their meaning for ever.',
            Object.entries(severities).flatMap(([letter, severity]) => Object.entries(groups).map(([digit, title]) => {
                const here = list.filter(([code]) => code.startsWith(`${letter}0${digit}`));
                return here.length ? lines(heading(2, letter === 'E' ? title : `${severity}: ${title.toLowerCase()}`), here.map(entry)) : '';
            })));
    }

    // ---- commands ----

    commands() {
        const names = [...this.run('help').matchAll(/^ {4}(\w+) {2,}(\w.*)$/gm)].map(match => match[1]).filter(name => name !== 'krs');
        return this.#page('Commands', 'All commands with their options, as <code>krs help COMMAND</code> tells them.', names.map(name => this.#command(name)));
    }

    #command(name) {
        const [head, ...rest] = this.run('help', name).trimEnd().split('\n\n'), summary = head.replace(/^krs \w+: /, '');
        const groups = rest.filter(part => /^[A-Z][^\n]*:\n {4}-/.test(part)), prose = rest.slice(0, rest.indexOf(groups[0]));
        const shown = prose.map(part => (/^( {4}|usage:)/.test(part) || /\n {2,}/.test(part) ? block(part.replace(/^ {4}/gm, ''), /^ {4}/.test(part) ? 'sh' : '')
            : this.markdown.blocks(part)));
        return lines(heading(2, `krs ${name}`), `<p>${escaped(summary[0].toUpperCase() + summary.slice(1))}.</p>`, shown, groups.map(group => {
            const [title, ...options] = group.split('\n');
            return lines(`<div class="table options"><table><caption>${escaped(title.replace(/:$/, ''))}</caption>`, joined(options).map(([option, text]) =>
                `<tr id="${name}${(/--[a-z-]+/.exec(option) ?? [option])[0]}"><th scope="row"><code>${escaped(option)}</code></th><td>${escaped(text)}</td></tr>`), '</table></div>');
        }));
    }

    // ---- headers, declarations of types, Python ----

    // A text of declarations: comments as text, what they stand before as code.
    #declarations(text, language, { comment, nameOf }) {
        const parts = [];
        for (const piece of text.split(/\n{2,}(?=\S)/)) {
            const found = comment.exec(piece), code = found ? piece.slice(found[0].length) : piece;
            parts.push({ comment: found ? found[1].replace(/^ *\* ?/gm, '').trim() : '', code: code.trim(), name: nameOf(code) });
        }
        return parts.map(({ comment, code, name }) => lines(name ? heading(3, name, name, `<code>${escaped(name)}</code>`) : '',
            comment ? this.markdown.blocks(comment.replace(/\n {4,}/g, match => match)) : '', code ? block(code, language) : ''));
    }

    c() {
        const headers = ['krs', 'camera', 'light', 'mesh', 'grid', 'slice', 'measure', 'vulkan', 'film'];
        const nameOf = code => (/^typedef (?:struct|enum) (\w+) \{/m.exec(code) ?? /\b(krs_\w+)\(/.exec(code) ?? /^typedef .*?\b(Krs\w+)[;(]/m.exec(code) ?? [])[1];
        return this.#page('C reference', 'The public headers with their comments. <a href="../docs/library.html">krs from C</a> shows how they are used.', headers.map(header => {
            const text = this.read(`include/krs/${header}.h`), [, about] = /^\/\*\n \* \w+\.h: (.*?)\*\//s.exec(text);
            const body = text.slice(text.indexOf('*/') + 2).replace(OF_ALL_HEADERS, '');
            return lines(heading(2, `krs/${header}.h`), this.markdown.blocks(about.replace(/^ \* ?/gm, '')),
                this.#declarations(body, 'c', { comment: /^\/\*\s(.*?)\*\/\n?/s, nameOf }));
        }));
    }

    javascript() {
        const text = this.read('web/package/krs.d.ts'), [intro] = /^\/\*\*.*?\*\//s.exec(text);
        const nameOf = code => (/^(?:export )?(?:declare )?(?:interface|type|class|function|global) ?(\w+)?/m.exec(code) ?? [])[1];
        return this.#page('JavaScript reference', 'What the package <code>krs</code> has for pages, with its types. <a href="../docs/javascript.html">krs in pages</a> shows how it is used.',
            heading(2, 'Types and functions'), this.#declarations(text.slice(intro.length).trim(), 'ts', { comment: /^\/\*\*\s(.*?)\*\/\n?/s, nameOf }));
    }

    python() {
        const modules = JSON.parse(execFileSync('python3', [path.join(this.root, 'site/python.py'), path.join(this.root, 'python/krs')], { encoding: 'utf8' }));
        const doc = text => (text ? this.markdown.blocks(text.replace(/((?:^|\n\n))((?:>>> .*\n?|(?:.+\n)*?(?=>>> ))+(?:.*\n?)*)/g, '$1```python\n$2\n```\n')) : '');
        const entry = ({ name, signature, doc: text, fields, members }) => lines(heading(3, name, name, `<code>${name}</code>`), `<pre class="signature" tabindex="0"><code>${highlighted(members ? signature : `def ${signature}`, 'python')}</code></pre>`, doc(text),
            fields?.length ? block(fields.join('\n'), 'python') : '',
            members?.length ? `<dl class="listed">${members.map(member => `<dt><code>${highlighted(member.signature, 'python')}</code></dt><dd>${doc(member.doc)}</dd>`).join('\n')}</dl>` : '');
        return this.#page('Python reference', 'What <code>from krs import *</code> has, with its comments. Shapes and functions of <a href="functions.html">the language</a> are functions here as well.',
            modules.filter(({ has }) => has.length).map(({ name, doc: text, has }) => lines(heading(2, `krs.${name}`), doc(text), has.map(entry))));
    }
}

// What tables say in few words, as a sentence; a formula stays what it is.
const sentence = about => about.replace(/\n/g, ' ').replace(/^[a-z](?=[a-z]* )/, letter => letter.toUpperCase()).replace(/[^.]$/, '$&.');

// What is for the preprocessor and for C++ alone.
const OF_ALL_HEADERS = /^#ifn?def (?:__cplusplus|__GNUC__|KRS_\w+_H)\n(?:#define KRS_\w+_H\n|extern "C" \{\n#endif\n|\}\n#endif\n|#pragma .*\n#endif\n)|^#include .*\n|^#endif\n*$(?![^])/gm;

// Whether the parenthesis that a text opens first is closed by its last sign, so that a method can follow.
function closes(text) {
    let depth = 0;
    for (const [at, sign] of [...text].entries()) {
        depth += sign === '(' ? 1 : sign === ')' ? -1 : 0;
        if (depth === 0 && /[|&]| - /.test(text.slice(at, at + 3)))
            return false;
    }
    return true;
}

// A message of the compiler with its marks, as a terminal shows them.
const marked = said => escaped(said).replace(/^(?:error|warning|note)(?=\[)/gm, word => `<span class="t-string">${word}</span>`)
    .replace(/^( *\|[ -]*)(\^+.*)/gm, '$1<span class="t-string">$2</span>').replace(/^( *= )(\w+:)/gm, '$1<span class="t-call">$2</span>');

// Options with their texts, of which a line of help is a part.
function joined(help) {
    const options = [];
    for (const line of help) {
        const found = /^ {4}(-.*?)(?: {2,}(.*))?$/.exec(line);
        if (found)
            options.push([found[1], found[2] ?? '']);
        else
            options.at(-1)[1] += ` ${line.trim()}`;
    }
    return options.map(([option, text]) => [option, text.trim()]);
}
