// extension.js: starts `krs lsp` for scenes.
const { workspace } = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');

let client;

exports.activate = () => {
    const server = { command: workspace.getConfiguration('krs').get('path', 'krs'), args: ['lsp'] };
    client = new LanguageClient('krs', 'krs', server, {
        documentSelector: [{ language: 'krs' }],
        synchronize: { fileEvents: workspace.createFileSystemWatcher('**/*.krs') },
    });
    return client.start();
};

exports.deactivate = () => client?.stop();
