// build.mjs: examples with their pictures, and the service worker, for the folder of the playground.
//
//     node build.mjs examples ROOT FOLDER     FOLDER/examples.json, and FOLDER/examples/ with texts, what they use, and pictures
//     node build.mjs licenses FOLDER          FOLDER/licenses.txt, of the packages that are in the bundle
//     node build.mjs service FOLDER SCRIPT    FOLDER/service.js, which knows all other files of the folder
//
// It is run where packages of npm are found (playground.mk).
import crypto from 'node:crypto';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { picturedScenes } from './pictured.mjs';
import { smaller } from './smaller.mjs';

const [task, ...args] = process.argv.slice(2);
const require = createRequire(path.join(process.cwd(), 'package.json'));
const filesOf = folder => fs.readdirSync(folder, { withFileTypes: true, recursive: true }).filter(entry => entry.isFile())
    .map(entry => path.relative(folder, path.join(entry.path, entry.name)));

// ---- examples ----

const WIDTH = 320, HEIGHT = 180, QUALITY = 82;

function examples(root, folder) {
    const { PNG } = require('pngjs'), jpeg = require('jpeg-js');
    const from = path.join(root, 'examples'), to = path.join(folder, 'examples'), shown = picturedScenes(root);
    fs.mkdirSync(path.join(to, 'parts'), { recursive: true });
    for (const file of ['frieze.png', 'relief.png', 'logo.svg', ...fs.readdirSync(path.join(from, 'parts')).map(name => `parts/${name}`)])
        fs.copyFileSync(path.join(from, file), path.join(to, file));
    const list = fs.readdirSync(from).filter(file => file.endsWith('.krs')).map(file => path.basename(file, '.krs')).map(name => {
        const { picture, title, about } = shown.get(name);
        const read = PNG.sync.read(fs.readFileSync(path.join(root, `docs/pictures/${picture}.png`)));
        fs.writeFileSync(path.join(to, `${name}.jpg`), jpeg.encode(smaller(read, WIDTH, HEIGHT), QUALITY).data);
        return { name, title, about, text: fs.readFileSync(path.join(from, `${name}.krs`), 'utf8') };
    });
    fs.writeFileSync(path.join(folder, 'examples.json'), JSON.stringify(list));
}

// ---- licenses ----

function licenses(folder) {
    const { packages } = JSON.parse(fs.readFileSync('package-lock.json', 'utf8'));
    const bundled = Object.entries(packages).filter(([place, { dev }]) => place !== '' && !dev).map(([place, { version }]) => {
        const file = fs.readdirSync(place).find(name => /^licen[cs]e/i.test(name));
        return `${place.replace('node_modules/', '')} ${version}\n\n${fs.readFileSync(path.join(place, file), 'utf8').trim()}\n`;
    });
    fs.writeFileSync(path.join(folder, 'licenses.txt'), bundled.join('\n----\n\n'));
}

// ---- the service worker ----

function service(folder, script) {
    const files = filesOf(folder).filter(file => file !== 'service.js').sort(), hash = crypto.createHash('sha256');
    for (const file of files)
        hash.update(file).update(fs.readFileSync(path.join(folder, file)));
    hash.update(fs.readFileSync(script));
    const wanted = ['./', ...files.map(file => `./${file}`)];
    fs.writeFileSync(path.join(folder, 'service.js'),
        `const VERSION = '${hash.digest('hex').slice(0, 16)}', FILES = ${JSON.stringify(wanted)};\n${fs.readFileSync(script, 'utf8')}`);
}

({ examples, licenses, service })[task](...args);
