// pictures.mjs: pictures of scenes, which the command renders, and those of the repository, both as JPEG.
//
// A picture is kept in a folder by the hash of all that decides what it shows, so it is made once.
import { execFile } from 'node:child_process';
import crypto from 'node:crypto';
import fs from 'node:fs';
import path from 'node:path';
import jpeg from 'jpeg-js';
import { PNG } from 'pngjs';
import { smaller } from '../web/playground/smaller.mjs';

const QUALITY = 86;
// So many commands run at once: while one compiles on one core, another renders.
const AT_ONCE = 2;

const hashOf = (...parts) => {
    const hash = crypto.createHash('sha256');
    for (const part of parts)
        hash.update(part).update('\0');
    return hash.digest('hex').slice(0, 12);
};

export class Pictures {
    #wanted = new Map();

    // `renderer` tells which program renders.  For tests `scale` makes pictures smaller, and only those are rendered whose names
    // are `chosen`.
    constructor({ krs, kept, out, renderer, scale = 1, chosen = /^/ }) {
        Object.assign(this, { krs, kept, out, renderer, scale, chosen });
        fs.mkdirSync(kept, { recursive: true });
        fs.mkdirSync(path.join(out, 'pictures'), { recursive: true });
    }

    // The picture of a scene: its file, and as how many pixels it is shown.  It is there after `make`.
    scene(name, text, { width = 480, height = 270, density = 1, samples = 9 } = {}) {
        const size = [width, height].map(pixels => Math.max(Math.round(pixels * density * this.scale), 16));
        // Kernels are the same everywhere; who is done first may be another each time, which few pixels do not show.
        const [rays, count] = this.scale < 1 ? ['auto', 1] : ['kernels', samples];
        const command = ['render', '-', '--quiet', '--size', size.join('x'), '--samples', String(count), '--rays', rays];
        const file = `pictures/${name}-${hashOf(text, this.renderer, ...command)}.jpg`;
        if (!this.chosen.test(name))
            return { file, width, height };
        this.#wanted.set(file, async kept => {
            const png = `${kept}.${process.pid}.png`;
            try {
                await this.#run([...command, '-o', png], text);
                this.#write(kept, PNG.sync.read(fs.readFileSync(png)));
            } catch (error) {
                throw new Error(`${name}: ${error.message}\n${text}`);
            } finally {
                fs.rmSync(png, { force: true });
            }
        });
        return { file, width, height };
    }

    // A picture of the repository, with so many pixels at most.
    ofFile(from, { width = 960 } = {}) {
        const name = path.basename(from).replace(/\.\w+$/, ''), bytes = fs.readFileSync(from);
        if (!from.endsWith('.png')) {
            const file = `pictures/${path.basename(from)}`;
            fs.copyFileSync(from, path.join(this.out, file));
            return { file, ...sizeOfWebp(bytes) };
        }
        const [wide, high] = [bytes.readUInt32BE(16), bytes.readUInt32BE(20)], share = Math.min(width / wide, 1);
        const size = [wide, high].map(pixels => Math.round(pixels * share));
        const file = `pictures/${name}-${hashOf(bytes, String(size))}.jpg`;
        this.#wanted.set(file, async kept => {
            const picture = PNG.sync.read(bytes);
            this.#write(kept, share < 1 ? smaller(picture, ...size) : picture);
        });
        return { file, width: size[0], height: size[1] };
    }

    #write(file, picture) {
        fs.writeFileSync(`${file}.part`, jpeg.encode(picture, QUALITY).data);
        fs.renameSync(`${file}.part`, file);
    }

    #run(args, input) {
        return new Promise((resolve, reject) => {
            const child = execFile(this.krs, args, { maxBuffer: 1 << 26 }, (error, _, said) =>
                (error ? reject(new Error(said || error.message)) : resolve()));
            child.stdin.on('error', () => {}); // it ended before it had read all, and says why
            child.stdin.end(input);
        });
    }

    async make() {
        const left = [...this.#wanted], made = left.filter(([file]) => !fs.existsSync(path.join(this.kept, path.basename(file)))).length;
        const work = async () => {
            for (let next = left.shift(); next; next = left.shift()) {
                const [file, render] = next, kept = path.join(this.kept, path.basename(file));
                if (!fs.existsSync(kept))
                    await render(kept);
                fs.copyFileSync(kept, path.join(this.out, file));
            }
        };
        await Promise.all(Array.from({ length: AT_ONCE }, work));
        return made;
    }
}

// Of an animation: the canvas of its header VP8X.
function sizeOfWebp(bytes) {
    if (bytes.toString('latin1', 12, 16) !== 'VP8X')
        throw new Error('a WebP without a canvas');
    return { width: 1 + bytes.readUIntLE(24, 3), height: 1 + bytes.readUIntLE(27, 3) };
}
