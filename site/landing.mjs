// landing.mjs: the first page.
import path from 'node:path';
import { escaped } from './code.mjs';

const place = 'index.html';
const shown = ['school', 'gear', 'lattice'];

const lead = [
    'krs compiles scenes that declare what is there: shapes that are joined, cut, mirrored, repeated and bent.',
    'It finds a safe distance from every point to the nearest surface by itself, or refuses the scene and says why, so there is no step size to tune.',
    'The same scene becomes a picture, a mesh with a proven error, a stack of sections, a grid of distances, or a shader for another program.',
];

const ways = [
    ['Learn', 'From the first sphere to a lighthouse in eight steps, each of which you can turn.', 'docs/tutorial.html', 'Tutorial'],
    ['Look it up', 'All shapes with their pictures, parameters, and whether their distance is exact.', 'reference/shapes.html', 'Shapes'],
    ['Come over', 'OpenSCAD, Curv, POV-Ray, CadQuery and Shadertoy, side by side with krs.', 'docs/coming-from.html', 'If you know another program'],
    ['Build on it', 'Libraries for C, Python and pages: distances, rays, meshes and pictures.', 'docs/library.html', 'krs from C'],
    ['Understand it', 'Why no step is too long, and how twelve mirrors make 4,096 fish in twelve steps.', 'docs/how-it-works.html', 'How krs works'],
    ['Make things', 'Meshes, sections for printers and cutters, wall thickness and volume.', 'docs/meshes.html', 'Meshes'],
];

export function landing({ way, image, pictures, root, block, read, playgroundLink, examples }) {
    const text = read('site/first.krs'), to = target => way(place, target);
    const first = pictures.scene('first', text, { width: 720, height: 480, density: 1.5, samples: 16 });
    const eager = image(first, 'A sphere of balls that touch each other, with a corner cut away', place).replace(' loading="lazy"', ' fetchpriority="high"');
    const cards = shown.map(name => examples.find(example => example.picture === name)).map(({ picture, name, title, about }) =>
        `<li><a class="card" href="${to('playground/index.html')}#example=${name}">${image(pictures.ofFile(path.join(root, `docs/pictures/${picture}.png`), { width: 800 }), '', place)}<b>${escaped(title)}</b><span>${escaped(about)}</span></a></li>`);
    const html = `<section class="hero">
<div class="words">
<h1>Scenes of implicit surfaces, traced exactly</h1>
${lead.map(sentence => `<p>${sentence}</p>`).join('\n')}
<p class="acts"><a class="act" href="${playgroundLink(text, place)}">Try it in the playground</a> <a class="act plain" href="${to('docs/tutorial.html')}">Read the tutorial</a></p>
</div>
<figure class="scene first" data-scene="first" data-soon>
<div class="shown"><div class="view">${eager}<button type="button" class="turn">Turn it</button></div>
<div class="beside"><p>Five balls and twenty mirrors that are spheres. Drag to turn it, and pull the cut.</p><div class="sliders"></div></div></div>
<details><summary>The whole scene</summary>${block(text, 'krs')}</details>
</figure>
</section>
<section class="install">
<div><h2>Install</h2>
<p>On Debian 12 or 13, or Ubuntu 24.04, with git, make and gcc. It needs no graphics card. <a href="${to('docs/contributing.html')}#other-systems">Other systems</a> need some packages by hand.</p></div>
<div>${block('make demo           # installs what is missing, builds, renders examples\nsudo make install   # the command, library and manual\n\nkrs view fish.krs   # a window: turn it, edit and save the text\nkrs render fish.krs -o fish.png\nkrs mesh fish.krs -o fish.stl', 'sh')}</div>
</section>
<section><h2>What it makes</h2>
<ul class="cards">${cards.join('\n')}</ul>
<p class="more"><a href="${to('gallery.html')}">All ${examples.length} scenes of the gallery</a></p></section>
<section><h2>Where to go on</h2>
<ul class="ways">${ways.map(([title, about, target, name]) => `<li><h3>${title}</h3><p>${about}</p><a href="${to(target)}">${name}</a></li>`).join('\n')}</ul></section>`;
    return { title: 'krs', about: lead.join(' '), html, wide: true };
}
