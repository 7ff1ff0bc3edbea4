// frame.mjs: what stands around the contents of each page.
import { escaped } from './code.mjs';
import { chapters } from './pages.mjs';

const icon = shape => `<svg viewBox="0 0 20 20" aria-hidden="true">${shape}</svg>`;
const icons = {
    search: icon('<circle cx="9" cy="9" r="5"/><path d="M13 13l4 4"/>'),
    theme: icon('<circle cx="10" cy="10" r="6"/><path d="M10 4a6 6 0 010 12z" class="filled"/>'),
    menu: icon('<path d="M3 6h14M3 10h14M3 14h14"/>'),
};

// The way from one page of the site to another, both as places from its root.
export function way(from, to) {
    const up = '../'.repeat(from.split('/').length - 1), [place, fragment] = to.split('#');
    return `${place === from && fragment ? '' : up + place}${fragment ? `#${fragment}` : ''}` || './';
}

function contents(place) {
    return chapters.map(({ title, pages }) => `<h2>${title}</h2>\n<ul>${pages.map(page =>
        `<li><a href="${way(place, page.place)}"${page.place === place ? ' aria-current="page"' : ''}>${escaped(page.title)}</a></li>`).join('')}</ul>`).join('\n');
}

// Headings of a page, to go to; where there are more, only the upper ones.
const MANY_HEADINGS = 90;
function outline(sections) {
    const upper = sections.filter(({ level }) => level === 2), shown = sections.length <= MANY_HEADINGS ? sections : upper;
    return shown.length < 2 ? '' : `<nav class="outline" aria-label="On this page"><h2>On this page</h2>\n<ul>${shown.map(({ id, html, level }) =>
        `<li><a href="#${id}"${level > 2 ? ' class="lower"' : ''}>${html.replace(/<\/?a[^>]*>/g, '')}</a></li>`).join('')}</ul></nav>`;
}

// The pages before and behind.
function neighbours(place) {
    const all = chapters.flatMap(({ pages }) => pages), at = all.findIndex(page => page.place === place);
    if (at < 0)
        return '';
    const link = (page, name) => (page ? `<a class="${name}" href="${way(place, page.place)}"><small>${name === 'next' ? 'Next' : 'Before'}</small>${escaped(page.title)}</a>` : '<span></span>');
    return `<nav class="neighbours" aria-label="Neighbouring pages">${link(all[at - 1], 'previous')}${link(all[at + 1], 'next')}</nav>`;
}

// A page: its place, title, description, HTML and sections.  One that is `wide` has neither contents nor outline.
export function frame({ place, title, about, html, sections = [], wide = false }) {
    const to = target => way(place, target), root = '../'.repeat(place.split('/').length - 1) || './';
    const body = wide ? `<main id="main" class="wide">\n${html}\n</main>` : `<div class="columns">
<nav class="contents" aria-label="Contents"><details open><summary>Contents</summary>\n${contents(place)}</details></nav>
<main id="main"><article>\n${html}\n</article>${neighbours(place)}</main>
${outline(sections)}</div>`;
    return `<!doctype html>
<html lang="en" data-root="${root}">
<head>
<meta charset="utf-8">
<title>${escaped(title === 'krs' ? 'krs: scenes of implicit surfaces' : `${title} · krs`)}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="description" content="${escaped(about)}">
<meta http-equiv="Content-Security-Policy" content="default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="${to('logo.svg')}" type="image/svg+xml">
<link rel="preload" href="${to('fonts/inter.woff2')}" as="font" type="font/woff2" crossorigin>
<link rel="stylesheet" href="${to('style.css')}">
<script src="${to('theme.js')}"></script>
<script defer src="${to('site.js')}"></script>
</head>
<body>
<a class="skip" href="#main">To the text</a>
<header class="bar">
<a class="home" href="${to('index.html')}"><img src="${to('logo.svg')}" alt="" width="26" height="26">krs</a>
<nav aria-label="Main">
<a href="${to('docs/tutorial.html')}">Tutorial</a>
<a href="${to('docs/language.html')}">Language</a>
<a href="${to('reference/shapes.html')}">Shapes</a>
<a href="${to('gallery.html')}">Gallery</a>
<a href="${to('playground/index.html')}">Playground</a>
</nav>
<div class="end">
<button id="search" aria-haspopup="dialog" aria-label="Search">${icons.search}<span>Search</span><kbd>/</kbd></button>
<button id="theme" aria-label="Light or dark">${icons.theme}</button>
</div>
</header>
${body}
<footer><p>krs is free software under the MIT license. This page asks no other host for anything. <a href="${to('licenses.txt')}">Licenses</a> of fonts and of what the playground is made with.</p></footer>
<dialog id="finder" aria-label="Search"><form method="dialog"><input type="search" placeholder="torus, reflect, --samples, E0402 ..." aria-label="Words" autocomplete="off" spellcheck="false" enterkeyhint="search"><button>Close</button></form>
<ol></ol><p role="status"></p></dialog>
</body>
</html>
`;
}
