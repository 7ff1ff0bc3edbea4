// session.mjs: a session of an editor, by vscode-languageserver-protocol: with `krs lsp`, and with the core of pages.
//
//     node session.mjs MODULES KRS [CORE]
//
// MODULES has the packages of package.json, CORE the module for pages.  What both answer must be equal.  Prints TAP.
import assert from 'node:assert';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { PassThrough } from 'node:stream';
import { pathToFileURL } from 'node:url';

const [modules, krs, wasm] = process.argv.slice(2);
const require = createRequire(path.resolve(modules, 'package.json'));
const lsp = require('vscode-languageserver-protocol/node');

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

// ---- two servers ----

function startNative() {
    const child = spawn(krs, ['lsp'], { stdio: ['pipe', 'pipe', 'inherit'] });
    const ended = new Promise(resolve => child.on('exit', resolve));
    return { reader: new lsp.StreamMessageReader(child.stdout), writer: new lsp.StreamMessageWriter(child.stdin), ended };
}

// The core behind two streams, as a worker of a page has it.
async function startCore() {
    const { loadCore } = await import(pathToFileURL(path.resolve(wasm, 'core.mjs')));
    const core = await loadCore({ wasm: fs.readFileSync(path.join(wasm, 'krs.wasm')) });
    const there = new PassThrough(), back = new PassThrough();
    const server = lsp.createProtocolConnection(new lsp.StreamMessageReader(there), new lsp.StreamMessageWriter(back));
    let leave;
    const ended = new Promise(resolve => (leave = resolve));
    const tell = uri => server.sendNotification('textDocument/publishDiagnostics', { uri, diagnostics: core.mistakes({ name: uri }) });
    server.onRequest('initialize', () => ({ capabilities: core.capabilities(), serverInfo: { name: 'krs' } }));
    server.onRequest('shutdown', () => null);
    server.onNotification('exit', () => leave(0));
    server.onNotification('textDocument/didOpen', ({ textDocument: { uri, text } }) => (core.open(text, { name: uri }), tell(uri)));
    server.onNotification('textDocument/didChange', ({ textDocument: { uri }, contentChanges }) => {
        for (const { range, text } of contentChanges)
            range ? core.edit(range, text, { name: uri }) : core.open(text, { name: uri });
        tell(uri);
    });
    server.onNotification('textDocument/didClose', ({ textDocument: { uri } }) => core.close({ name: uri }));
    server.onRequest((method, params) => {
        try {
            return core.ask(method, params, { name: params.textDocument.uri });
        } catch (error) {
            return new lsp.ResponseError(error.message.startsWith('there is no') ? -32601 : -32803, error.message);
        }
    });
    server.listen();
    return { reader: new lsp.StreamMessageReader(back), writer: new lsp.StreamMessageWriter(there), ended };
}

// ---- the session ----

const uri = 'untitled:scene.krs', other = 'untitled:part.krs';
const text = `// A scene with \u{1F30D} and é.
/// How large.
param size = 1 in [0.5, 2];
let blue = #3366cc;
material skin { color: blue, roughness: 0.4 }
def ball(r, at = [0, 0, 0]) = sphere(r).move(at);
let row = [ball(0.2 * i, at: [i, 0, 0]) for i in 1..4];
show union(row).paint(skin); /* \u{1F30D} */ show ball(size);
camera {
    eye: [3, 2, 5],
    target: [0, 0, 0]
}
`;

// Where the nth `needle` begins, and `skip` units behind.
function at(needle, { skip = 0, nth = 0, of = text } = {}) {
    let index = -1;
    for (let i = 0; i <= nth; i++)
        index = of.indexOf(needle, index + 1);
    const before = of.slice(0, index + skip).split('\n');
    return { line: before.length - 1, character: before.at(-1).length };
}

// Answers that name files of the library, which pages have by name.
const plain = value => JSON.parse(JSON.stringify(value ?? null).replaceAll(/"[^"]*\/(\w+\.krs)"/g, '"library:$1"'));

async function run(name, started) {
    const connection = lsp.createProtocolConnection(started.reader, started.writer), answers = [], found = [];
    let heard = () => {};
    connection.onNotification('textDocument/publishDiagnostics', told => (found.push(told), heard()));
    connection.listen();
    const told = async wanted => {
        while (!found.some(wanted))
            await new Promise(resolve => (heard = resolve));
        return found.find(wanted);
    };
    const ask = async (method, params) => {
        const answer = await connection.sendRequest(method, { textDocument: { uri }, ...params }).catch(error => ({ refused: error.code, why: error.message }));
        answers.push([method, plain(answer)]);
        return answer;
    };
    const check = (good, what) => report(good, `${name}: ${what}`);

    const { capabilities } = await connection.sendRequest('initialize', { processId: null, rootUri: null, capabilities: {} });
    connection.sendNotification('initialized', {});
    check(capabilities.hoverProvider && capabilities.completionProvider.triggerCharacters.includes('.') &&
        capabilities.semanticTokensProvider.legend.tokenTypes.length > 10, 'it says what it can');
    connection.sendNotification('textDocument/didOpen', { textDocument: { uri, languageId: 'krs', version: 1, text } });

    // What names mean.
    const definition = await ask('textDocument/definition', { position: at('ball(size)', { skip: 2 }) });
    check(definition.uri === uri && assert.deepEqual(definition.range.start, at('ball(r')) === undefined, 'a definition is found');
    const sphere = await ask('textDocument/definition', { position: at('sphere(r)', { skip: 2 }) });
    check(sphere.uri.endsWith('solids.krs') && sphere.range.start.line > 10, 'a definition is found in the library');
    if (sphere.uri.startsWith('file:'))
        check(fs.readFileSync(new URL(sphere.uri), 'utf8').split('\n')[sphere.range.start.line].startsWith('shape sphere('), 'that is a file');
    const references = await ask('textDocument/references', { position: at('ball(r', { skip: 1 }), context: { includeDeclaration: true } });
    check(references.length === 3, 'references are found');
    const highlights = await ask('textDocument/documentHighlight', { position: at('size') });
    check(highlights.length === 2, 'the same name is marked');
    const rename = await ask('textDocument/rename', { position: at('at = [', { skip: 1 }), newName: 'place' });
    check(rename.changes[uri].length === 3, 'a parameter is renamed, with the names of arguments');
    check((await ask('textDocument/rename', { position: at('at = ['), newName: 'r' })).refused === -32803, 'a name that is taken is refused');
    check((await ask('textDocument/prepareRename', { position: at('size') })).placeholder === 'size', 'a name can be changed');
    const hover = await ask('textDocument/hover', { position: at('size', { nth: 1, skip: 1 }) });
    check(hover.contents.value.includes('How large.') && hover.contents.value.includes('from 0.5 to 2'), 'hover tells documentation and range');
    check((await ask('textDocument/hover', { position: at('blue') })).contents.value.includes('%233366cc'), 'hover shows a colour');
    check((await ask('textDocument/hover', { position: at('union') })).contents.value.startsWith('```krs\nunion('), 'hover tells what is built in');

    // What may stand at a place.
    const position = at('ball(size)', { skip: 5 });
    const items = await ask('textDocument/completion', { position });
    check(['size', 'r:', 'blue', 'torus', 'sin'].every(label => items.some(item => item.label === label)), 'names are completed');
    const signature = await ask('textDocument/signatureHelp', { position });
    check(signature.signatures[0].label === 'ball(r, at = [0, 0, 0])' && signature.activeParameter === 0, 'a signature is told');

    // Lists.
    const symbols = await ask('textDocument/documentSymbol', {});
    check(symbols.map(symbol => symbol.name).join() === 'size,blue,skin,ball,row,show union(row).paint(skin),show ball(size),camera', 'symbols are listed');
    check((await ask('textDocument/foldingRange', {})).some(({ startLine, endLine }) => startLine === 8 && endLine === 10), 'blocks can be folded');
    const { data } = await ask('textDocument/semanticTokens/full', {});
    check(data.length % 5 === 0 && data[2] === '// A scene with \u{1F30D} and é.'.length, 'words have colours, in UTF-16 units');
    check((await ask('textDocument/selectionRange', { positions: [position, at('size')] })).filter(({ parent }) => parent).length === 2, 'selections grow');

    // Changes.
    const [colour] = await ask('textDocument/documentColor', {});
    check(Math.abs(colour.color.blue - 0.8) < 1e-12, 'colours are found');
    const presentations = await ask('textDocument/colorPresentation', { color: { red: 1, green: 0.5, blue: 0, alpha: 1 }, range: colour.range });
    check(presentations[0].label === '#ff8000', 'colours are picked');
    const range = { start: at('0.4', { skip: 1 }), end: at('0.4', { skip: 1 }) };
    const [action] = await ask('textDocument/codeAction', { range, context: { diagnostics: [] } });
    check(action.edit.changes[uri][0].newText === 'param roughness = 0.4 in [0, 0.8];\n', 'a number becomes a param');
    const [extracted] = await ask('textDocument/codeAction', {
        range: { start: at('ball(0.2'), end: at(' for i') }, context: { diagnostics: [] } });
    check(extracted.edit.changes[uri][0].newText === 'def part(i) = ball(0.2 * i, at: [i, 0, 0]);\n', 'an expression becomes a def');
    check((await ask('textDocument/formatting', { options: { tabSize: 4, insertSpaces: true } })).length === 0, 'what is laid out stays');

    // While typing: a mistake, and the rest stays alive.
    connection.sendNotification('textDocument/didChange', {
        textDocument: { uri, version: 2 },
        contentChanges: [
            { range: { start: at('show ball(size)', { skip: 10 }), end: at('show ball(size)', { skip: 14 }) }, text: 'sise' },
            { range: { start: at('let blue'), end: at('let blue') }, text: 'let half = size / 2;\nlet bad = ;\n' },
        ],
    });
    const { diagnostics } = await told(({ diagnostics: [first] }) => first?.code === 'E0101');
    answers.push(['diagnostics', plain(diagnostics)]);
    check(diagnostics.length === 2, 'mistakes are told');
    const wrong = diagnostics.find(({ code }) => code === 'E0201');
    check(wrong.data.replacement === 'size', 'and what is meant');
    const [fix] = await ask('textDocument/codeAction', { range: wrong.range, context: { diagnostics: [wrong] } });
    check(fix.kind === 'quickfix' && fix.edit.changes[uri][0].newText === 'size', 'a quick fix');
    check((await ask('textDocument/hover', { position: { line: 3, character: 5 } })).contents.value.includes('from 0.25 to 1'), 'a new value');
    check((await ask('textDocument/documentSymbol', {})).length === 10, 'all else is there');

    // Several documents.
    connection.sendNotification('textDocument/didOpen', { textDocument: { uri: other, languageId: 'krs', version: 1, text: '/// A part.\ndef part(n) = box([n, n, n]);\n' } });
    connection.sendNotification('textDocument/didChange', { textDocument: { uri, version: 3 }, contentChanges: [{ text: `use "${other}";\nshow part(2);\n` }] });
    check((await ask('textDocument/hover', { position: { line: 1, character: 6 } })).contents.value.includes('A part.'), 'open documents are used');
    const renamed = await ask('textDocument/rename', { position: { line: 1, character: 6 }, newName: 'piece' });
    check(Object.keys(renamed.changes).sort().join() === [other, uri].sort().join(), 'names change in several documents');
    check((await ask('textDocument/nothing', {})).refused === -32601, 'an unknown question is refused');
    if (name === 'native') {
        connection.sendNotification('textDocument/didChange', { textDocument: { uri, version: 4 }, contentChanges: [{ text: 'show sphere(1) + 1;\n' }] });
        check((await told(({ diagnostics: [first] }) => first?.code === 'E0301')).version === 4, 'a whole check follows');
    }
    await connection.sendRequest('shutdown');
    connection.sendNotification('exit');
    check(await started.ended === 0, 'it ends');
    connection.dispose();
    return answers;
}

const native = await run('native', startNative());
if (wasm) {
    const core = await run('page', await startCore());
    const different = native.filter(([, answer], i) => JSON.stringify(answer) !== JSON.stringify(core[i][1]));
    for (const [method] of different)
        console.log(`# ${method} is other`);
    report(different.length === 0 && native.length === core.length, `both give the same ${native.length} answers`);
}
console.log(`1..${number}`);
process.exit(failed ? 1 : 0);
