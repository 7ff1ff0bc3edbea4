// build.mjs: the static site, in a folder for any web server.
//
//     node site.mjs ROOT BUILD FOLDER [--small PATTERN]
//
// ROOT is the repository, BUILD has the command, the playground and kept pictures.  For tests --small makes pictures of few
// pixels, and of those that are rendered only such whose names match.  Pages are those of pages.mjs and those that they link to.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { picturedScenes } from '../web/playground/pictured.mjs';
import { pack } from '../web/playground/share.mjs';
import { block, escaped } from './code.mjs';
import { frame, way } from './frame.mjs';
import { landing } from './landing.mjs';
import { Markdown } from './markdown.mjs';
import { chapters } from './pages.mjs';
import { Pictures } from './pictures.mjs';
import { Reference } from './reference.mjs';

const [root, build, out, small, pattern] = process.argv.slice(2);
const read = file => fs.readFileSync(path.join(root, file), 'utf8');
const pages = chapters.flatMap(chapter => chapter.pages), placeOf = new Map(pages.filter(page => page.document).map(page => [page.document, page.place]));

fs.rmSync(out, { recursive: true, force: true });
fs.mkdirSync(out, { recursive: true });
const [, renderer] = /fingerprint_film\[\] = "(\w+)"/.exec(fs.readFileSync(path.join(build, 'fingerprints.c'), 'utf8'));
const pictures = new Pictures({ krs: path.join(build, 'krs'), kept: path.join(build, 'site-pictures'), out, renderer,
    ...(small === '--small' && { scale: 0.1, chosen: new RegExp(pattern) }) });

// ---- links ----

// Files of the repository that pages name, which become pages below source/.
const sources = new Map();
function sourcePlace(file) {
    if (!sources.has(file)) {
        if (!fs.existsSync(path.join(root, file)))
            throw new Error(`a page names ${file}, which is not there`);
        sources.set(file, `source/${file}.html`);
    }
    return sources.get(file);
}

const fileOf = (target, document) => path.join(path.dirname(document), decodeURIComponent(target)).replace(/\/$/, '');

function link(href, { place, document }) {
    if (/^[a-z]+:/.test(href) || href.startsWith('#') || !document)
        return href;
    const [target, fragment] = href.split('#'), file = fileOf(target, document);
    return way(place, (placeOf.get(file) ?? sourcePlace(file)) + (fragment ? `#${fragment}` : ''));
}

const titleOf = (href, { document }) => {
    const [target, fragment] = href.split('#');
    return fragment || !document ? null : pages.find(page => page.document === fileOf(target, document))?.title;
};

// ---- pictures and scenes ----

const image = ({ file, width, height }, alt, place, more = '') =>
    `<img src="${way(place, file)}" alt="${escaped(alt)}" width="${width}" height="${height}" loading="lazy" decoding="async"${more}>`;

function picture(src, alt, { place, document }) {
    const found = pictures.ofFile(path.join(root, path.dirname(document), src));
    return image(found, alt, place);
}

// Links to the playground hold a scene, which is packed when all pages are there.
const packed = new Map();
function playgroundLink(text, place) {
    const mark = `@scene-${packed.size}@`;
    packed.set(mark, text);
    return `${way(place, 'playground/index.html')}${mark}`;
}

const shows = text => /(^|[;}\n])\s*show\b/.test(text.replace(/\/\/.*/g, ''));
let numberOfScenes = 0;
// Texts of such lines have the picture beside them.
const SHORT_LINE = 52;

// A scene: its text, beside what another program wrote for it, its picture, and the way to the playground.  What is `told` of a
// word stands beside a small picture.
function scene(text, env, { other, picture: given, name, told, alt } = {}) {
    const code = other ? `<div class="both">${block(other.text, other.language)}${block(text, 'krs')}</div>` : block(text, 'krs');
    if (!shows(text))
        return code;
    const stem = name ?? path.basename(env.document ?? env.place).replace(/\.\w+$/, '');
    const shown = given ? pictures.ofFile(path.join(root, path.dirname(env.document), given.src), { width: 640 })
        : pictures.scene(stem, text, told ? { width: 288, height: 192, density: 1.5 } : {});
    const title = given?.alt ?? alt ?? 'A picture of this scene', lines = text.split('\n');
    const form = told ? ' little' : !other && Math.max(...lines.map(line => line.length)) <= SHORT_LINE ? ' short' : '';
    return `<figure class="scene${form}" data-scene="${++numberOfScenes}">
${told ? `<div class="told">${told}${code}</div>` : code}
<div class="shown"><div class="view">${image(shown, title, env.place)}<button type="button" class="turn">Turn it</button></div>
<div class="beside"><a class="open" href="${playgroundLink(text, env.place)}">Open in the playground</a><div class="sliders"></div></div></div>
</figure>`;
}

const markdown = new Markdown({ link, titleOf, picture, scene });

// ---- pages ----

const entities = { amp: '&', lt: '<', gt: '>', quot: '"' };
const unescaped = html => html.replace(/&(\w+);/g, (whole, name) => entities[name] ?? whole);

const firstSentences = html => {
    const text = /<p[^>]*>(.*?)<\/p>/s.exec(html)?.[1].replace(/<[^>]+>/g, '').replace(/\s+/g, ' ').replace(/&(?!\w+;)/g, 'and') ?? '';
    return unescaped(text.length < 170 ? text : `${text.slice(0, 170).replace(/\s+\S*$/, '')} ...`);
};

const examples = [...picturedScenes(root).values()];

function gallery(place) {
    const cards = examples.map(({ picture, name, title, about }) => `<li><a class="card" href="${way(place, 'playground/index.html')}#example=${name}">
${image(pictures.ofFile(path.join(root, `docs/pictures/${picture}.png`), { width: 800 }), '', place)}<b>${escaped(title)}</b><span>${escaped(about)}</span></a>
<a class="text" href="${way(place, sourcePlace(`examples/${name}.krs`))}">Its text</a></li>`);
    return { title: 'Gallery', wide: true, html: `<h1>Gallery</h1>\n<p class="lead">A click opens the scene in the playground, where it is compiled and drawn by your browser.</p>\n<ul class="cards">${cards.join('\n')}</ul>` };
}

const reference = new Reference({ root, krs: path.join(build, 'krs'), words: path.join(build, 'site-words'), scene, markdown, pictures });

function documentPage(document, place) {
    return markdown.render(read(document), { place, document });
}

function headingsOf(html) {
    return [...html.matchAll(/<h([23]) id="([^"]*)">(.*?) <a class="anchor"/gs)].map(([, level, id, inner]) =>
        ({ level: Number(level), id, html: inner, title: inner.replace(/<[^>]+>/g, '') }));
}

function sourcePage(file, place) {
    const full = path.join(root, file);
    if (fs.statSync(full).isDirectory()) {
        const names = fs.readdirSync(full, { withFileTypes: true }).filter(entry => entry.isFile()).map(entry => entry.name).sort();
        return { title: file, html: `<h1>${file}</h1>\n<ul>${names.map(name => `<li><a href="${way(place, sourcePlace(`${file}/${name}`))}"><code>${name}</code></a></li>`).join('')}</ul>` };
    }
    if (file.endsWith('.md'))
        return documentPage(file, place);
    const text = fs.readFileSync(full, 'utf8'), name = path.basename(file, '.krs');
    const open = /^examples\/[^/]*\.krs$/.test(file) ? `<p><a class="open" href="${way(place, 'playground/index.html')}#example=${name}">Open in the playground</a></p>` : '';
    return { title: file, html: `<h1>${file}</h1>\n${open}${block(text, { krs: 'krs', sh: 'sh', c: 'c', glsl: 'glsl', mjs: 'js', json: 'json' }[file.split('.').pop()])}` };
}

// ---- searching ----

const plain = html => unescaped(html.replace(/<a class="anchor".*?<\/a>/gs, '').replace(/<figure class="scene.*?<\/figure>/gs, figure => figure.replace(/<div class="shown">.*/s, ''))
    .replace(/<\/?(?:span|code|b|em|strong|a)\b[^>]*>/g, '').replace(/<[^>]+>/g, ' ')).replace(/\s+/g, ' ').trim();

// A row for each heading of a page: its title, the page's, its place, and the text below it.
function found({ place, title, html }) {
    const parts = html.split(/(?=<h[23] id="|<dt id="|<tr id=")/);
    return parts.map((part, i) => {
        const head = /^<(h[23]|dt|tr) id="([^"]*)"[^>]*>(.*?)<\/(?:h[23]|dt|th)>/s.exec(part);
        return i > 0 && head ? [plain(head[3]), title, `${place}#${head[2]}`, plain(part.slice(head[0].length))] : [title, '', place, plain(part.replace(/<h1.*?<\/h1>/s, ''))];
    });
}

// ---- all of it ----

function copy(from, to) { fs.cpSync(path.join(build, from), path.join(out, to), { recursive: true }); }

async function write(place, html) {
    for (const mark of html.match(/@scene-\d+@/g) ?? [])
        html = html.replace(mark, await pack({ text: packed.get(mark) }));
    fs.mkdirSync(path.dirname(path.join(out, place)), { recursive: true });
    fs.writeFileSync(path.join(out, place), html);
}

const index = [], begun = Date.now();
for (const { place, title, document, part } of pages) {
    const made = document ? documentPage(document, place) : part === 'gallery' ? gallery(place) : reference[part](place);
    const sections = headingsOf(made.html);
    index.push(...found({ place, title, html: made.html }));
    await write(place, frame({ place, title: made.title ?? title, about: firstSentences(made.html), html: made.html, sections, wide: made.wide }));
}
await write('index.html', frame({ ...landing({ way, image, pictures, root, block, read, playgroundLink, examples }), place: 'index.html' }));
for (const [file, place] of sources) { // more are found on the way
    const made = sourcePage(file, place);
    await write(place, frame({ place, title: made.title ?? file, about: `${file} of krs`, html: made.html, sections: headingsOf(made.html) }));
}

for (const file of ['style.css', 'theme.js', 'site.js'])
    fs.copyFileSync(path.join(root, 'site', file), path.join(out, file));
fs.copyFileSync(path.join(root, 'web/playground/logo.svg'), path.join(out, 'logo.svg'));
fs.mkdirSync(path.join(out, 'fonts'));
let licenses = fs.readFileSync(path.join(build, 'playground/licenses.txt'), 'utf8');
for (const font of ['inter', 'jetbrains-mono']) {
    const folder = path.join(build, `npm/node_modules/@fontsource-variable/${font}`);
    fs.copyFileSync(path.join(folder, `files/${font}-latin-wght-normal.woff2`), path.join(out, `fonts/${font}.woff2`));
    licenses += `\n----\n\n${font}\n\n${fs.readFileSync(path.join(folder, 'LICENSE'), 'utf8').trim()}\n`;
}
fs.writeFileSync(path.join(out, 'licenses.txt'), licenses);
copy('playground', 'playground');
const playground = path.join(out, 'playground/index.html');
fs.writeFileSync(playground, fs.readFileSync(playground, 'utf8').replaceAll('data-site=', 'href='));
const ofPlayground = name => path.resolve(root, 'web/playground', name);
execFileSync(process.execPath, [ofPlayground('build.mjs'), 'service', path.resolve(path.dirname(playground)), ofPlayground('service.mjs')], { cwd: path.join(build, 'npm') });
fs.writeFileSync(path.join(out, 'search.js'), `krsSearch(${JSON.stringify(index).replaceAll('</', '<\\/')});\n`);

const made = await pictures.make();
console.log(`site: ${pages.length + sources.size + 1} pages, ${numberOfScenes} scenes, ${made} new pictures, after ${((Date.now() - begun) / 1000).toFixed(0)} s: ${path.join(out, 'index.html')}`);
