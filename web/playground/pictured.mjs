// pictured.mjs: the scenes of examples/, each with the picture that shows it first (tools/pictures.txt).
import fs from 'node:fs';
import path from 'node:path';

const capital = text => text[0].toUpperCase() + text.slice(1);

// By the name of each scene: that, its title, the name of its picture, and what this shows.
export function picturedScenes(root) {
    const found = new Map();
    for (const line of fs.readFileSync(path.join(root, 'tools/pictures.txt'), 'utf8').split('\n')) {
        const [kind, picture, name, , , about] = line.split(' | ');
        if ((kind === 'picture' || kind === 'exr') && !found.has(name))
            found.set(name, { picture, name, title: capital(name.replace(/^\d+-/, '').replaceAll('-', ' ')), about: capital(about) });
    }
    return found;
}
