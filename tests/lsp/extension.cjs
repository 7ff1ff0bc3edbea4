// extension.cjs: the extension for VS Code, in place of whose libraries stand small ones: what it starts is the server.
//
//     node extension.cjs KRS
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const Module = require('node:module');
const path = require('node:path');

const root = path.resolve(__dirname, '../..'), folder = path.join(root, 'editors/vscode'), krs = path.resolve(process.argv[2]);
const read = file => JSON.parse(fs.readFileSync(path.join(folder, file), 'utf8'));
let failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} - ${what}`);
    failed += !good;
};

const manifest = read('package.json'), { languages: [language], grammars: [grammar] } = manifest.contributes;
const wanted = fs.readFileSync(path.join(root, 'include/krs/krs.h'), 'utf8').match(/KRS_VERSION +"([^"]*)"/)[1];
report(manifest.version === wanted, 'the extension has the version of the program');
report(read('package-lock.json').packages[''].dependencies['vscode-languageclient'] === manifest.dependencies['vscode-languageclient'],
    'its packages are pinned');
const colours = JSON.parse(fs.readFileSync(path.join(root, 'grammar/editors', path.basename(grammar.path)), 'utf8'));
report(colours.scopeName === grammar.scopeName && grammar.language === language.id, 'it has the syntax colours');
const brackets = read(path.basename(language.configuration)).brackets.flat().sort().join('');
report(brackets === '()[]{}' && new RegExp(`^${read(path.basename(language.configuration)).wordPattern}$`).test('smooth_mirrors'),
    'it knows brackets and words');

let client;
const stands = {
    vscode: { workspace: { getConfiguration: () => ({ get: (name, otherwise) => (name === 'path' ? krs : otherwise) }),
        createFileSystemWatcher: pattern => ({ pattern }) } },
    'vscode-languageclient/node': { LanguageClient: class {
        constructor(id, name, server, options) { client = { server, options, running: false }; }
        start() { client.running = true; }
        stop() { client.running = false; }
    } },
};
const load = Module._load;
Module._load = (name, ...rest) => stands[name] ?? load(name, ...rest);
const extension = require(path.join(folder, manifest.main));
extension.activate();
report(client.running && client.options.documentSelector[0].language === language.id, 'it starts for scenes');
const hello = JSON.stringify({ jsonrpc: '2.0', id: 1, method: 'initialize', params: { capabilities: {} } });
const { stdout } = spawnSync(client.server.command, client.server.args, { input: `Content-Length: ${hello.length}\r\n\r\n${hello}`, encoding: 'utf8' });
report(stdout.includes('"hoverProvider":true'), 'what it starts is the server');
extension.deactivate();
report(!client.running, 'and ends it');
process.exit(failed ? 1 : 0);
