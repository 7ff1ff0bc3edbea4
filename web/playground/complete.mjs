// complete.mjs: what can be written at a place of a text, and what a word there means.
import words from 'krs-words';

const blocks = new RegExp(`\\b(${Object.keys(words.properties).join('|')})\\b[^;{}]*$`);

const called = ({ name, parameters }) => (parameters === null ? name : `${name}(${parameters})`);

// Puts a function with its parentheses, and the cursor between them.
function apply(view, { label }, from, to) {
    const next = view.state.sliceDoc(to, to + 1), insert = next === '(' ? label : `${label}()`;
    view.dispatch({ changes: { from, to, insert }, selection: { anchor: from + label.length + 1 }, userEvent: 'input.complete' });
}

function option(entry, boost = 0) {
    const { name, parameters, about, kind } = entry;
    return {
        label: name, boost, type: kind ?? 'function', info: about ? () => explained(entry) : undefined,
        detail: parameters === null ? undefined : `(${parameters})`,
        apply: parameters === null ? undefined : apply,
    };
}

const plain = (labels, boost) => labels.map(label => ({ label, boost, type: 'keyword' }));
const keywords = plain(Object.values(words.tokens).flat().filter(spelling => /^\w/.test(spelling)), 1);
const anywhere = [...keywords, ...words.names.map(entry => option(entry, entry.kind === 'value' && !entry.about ? -50 : 0))];
const methods = words.methods.map(entry => option(entry));

// Names that a text defines.
function defined(text) {
    const found = [];
    for (const [, doc, kind, name, parameters] of text.matchAll(
        /((?:^[ \t]*\/\/\/.*\n)*)^[ \t]*(let|def|shape|param|material)[ \t]+([A-Za-z]\w*)[ \t]*(?:\(([^()]*)\))?/gm))
        found.push({ name, kind, parameters: parameters ?? null, about: doc.replace(/^[ \t]*\/\/\/ ?/gm, '').trim() || `a ${kind} of this text` });
    for (const [, file] of text.matchAll(/\buse\s+"([^"]+)"/g))
        found.push(...(words.files[file] ?? []));
    return found;
}

// What opens the brace around the end of a text: the word of a block, or null.
function blockAround(before) {
    let depth = 0;
    for (let i = before.length - 1; i >= 0; i--) {
        if (before[i] === '}')
            depth++;
        else if (before[i] === '{' && depth-- === 0)
            return { name: blocks.exec(before.slice(0, i))?.[1], inside: before.slice(i + 1) };
    }
    return null;
}

// A property can begin behind the brace, or behind a comma that is in no parentheses.
function propertiesAt(before) {
    const block = blockAround(before);
    if (!block?.name)
        return null;
    let depth = 0, begun = 0;
    for (let i = 0; i < block.inside.length; i++) {
        depth += '([{'.includes(block.inside[i]) - ')]}'.includes(block.inside[i]);
        if (block.inside[i] === ',' && depth === 0)
            begun = i + 1;
    }
    return block.inside.slice(begun).includes(':') ? null : words.properties[block.name];
}

export function complete(context) {
    const before = context.state.sliceDoc(0, context.pos), word = context.matchBefore(/[A-Za-z_]\w*/);
    const line = before.slice(before.lastIndexOf('\n') + 1);
    if (/\/\//.test(line))
        return null;
    const file = /\buse\s+"([^"]*)$/.exec(line);
    if (file)
        return { from: context.pos - file[1].length, options: plain(Object.keys(words.files)), validFor: /^[^"]*$/ };
    if ((line.match(/"/g) ?? []).length % 2 === 1)
        return null;
    const from = word?.from ?? context.pos;
    if (before[from - 1] === '.')
        return /\d\.$/.test(before.slice(0, from)) ? null : { from, options: methods, validFor: /^\w*$/ };
    if (!word && !context.explicit)
        return null;
    const properties = propertiesAt(before.slice(0, from));
    if (properties)
        return { from, options: properties.map(label => ({ label, type: 'property', apply: `${label}: ` })), validFor: /^\w*$/ };
    const own = defined(context.state.doc.toString()).map(entry => option(entry, 2));
    const names = new Set(own.map(({ label }) => label));
    return { from, options: [...own, ...anywhere.filter(({ label }) => !names.has(label))], validFor: /^\w*$/ };
}

function explained(entry) {
    const dom = document.createElement('div'), code = document.createElement('code'), about = document.createElement('p');
    dom.className = 'explained';
    code.textContent = called(entry);
    about.textContent = entry.about;
    dom.append(code, about);
    return dom;
}

// What is known of the word at a place, for a tip.
export function describe(view, at) {
    const range = view.state.wordAt(at);
    if (!range)
        return null;
    const word = view.state.sliceDoc(range.from, range.to), text = view.state.doc.toString();
    const known = view.state.sliceDoc(range.from - 1, range.from) === '.' ? words.methods : [...defined(text), ...words.names];
    const entry = known.find(({ name, about }) => name === word && about);
    return entry ? { pos: range.from, end: range.to, above: true, create: () => ({ dom: explained(entry) }) } : null;
}
