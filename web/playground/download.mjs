// download.mjs: the text, a picture or a mesh as a file.
import { corners, glb, middles, stl } from './files.mjs';

const MAX_POINTS = 4096;
const isFinite = ({ low, high }) => [...low, ...high].every(Number.isFinite);

function offer(blob, name) {
    const link = document.createElement('a'), address = URL.createObjectURL(blob);
    link.href = address;
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
}

export class Downloads {
    #work = null; // what is made now can be ended by this

    constructor(dialog, { view, text, title }) {
        Object.assign(this, { dialog, view, text, title, form: dialog.querySelector('#wanted') });
        this.form.addEventListener('change', () => this.#choose());
        this.form.addEventListener('submit', event => {
            event.preventDefault();
            this.#save();
        });
        dialog.addEventListener('close', () => this.#work?.abort(new Error('It was ended.')));
    }

    // Of those without an end there are no meshes.
    set components(components) {
        this.ended = components.map(({ name }, i) => ({ name, number: i + 1, ends: isFinite(components[i]) })).filter(({ ends }) => ends);
        const all = this.ended.length === components.length ? 'all' : 'all that have an end';
        this.form.component.replaceChildren(new Option(all, 0), ...this.ended.map(({ name, number }) => new Option(name, number)));
    }

    show() {
        this.#choose();
        this.#say('');
        this.dialog.showModal();
    }

    get kind() { return this.form.kind.value; }

    #choose() {
        for (const fields of this.form.querySelectorAll('.fields')) {
            fields.hidden = !fields.dataset.for.split(' ').includes(this.kind);
            for (const input of fields.querySelectorAll('input, select'))
                input.disabled = fields.hidden;
        }
    }

    #say(text) { this.form.querySelector('#failure').textContent = text; }

    #progress(done) {
        const bar = this.form.querySelector('#progress');
        bar.hidden = done === null;
        if (done > 0)
            bar.value = done;
        else
            bar.removeAttribute('value');
        this.form.querySelector('#save').disabled = done !== null;
    }

    async #save() {
        this.#say('');
        this.#progress(0);
        this.#work = new AbortController();
        const { kind } = this, name = `${this.title().toLowerCase().replace(/\W+/g, '-')}.${kind}`;
        try {
            const blob = await this[`make_${kind}`](this.#work.signal);
            this.#work.signal.throwIfAborted();
            offer(blob, name);
            this.dialog.close();
        } catch (error) {
            this.#say(error.message);
        } finally {
            this.#work = null;
            this.#progress(null);
        }
    }

    make_krs() { return new Blob([this.text()], { type: 'text/plain' }); }

    async make_png() {
        const { width, height, samples } = this.form, before = this.view.samples;
        this.view.samples = Number(samples.value);
        try {
            return await this.view.snapshot(Number(width.value), Number(height.value), 'image/png');
        } finally {
            this.view.samples = before;
        }
    }

    #mesh(component, signal, part, parts) {
        return this.view.scene.mesh({
            component, signal, error: Number(this.form.error.value), simplify: this.form.simplify.checked,
            draft: this.form.quality.value === 'draft', time: this.view.time, progress: done => this.#progress((part + done) / parts) });
    }

    // What is known at points, some of them at a time: an answer is long.
    async #hits(points, signal) {
        const hits = [];
        for (let i = 0; i < points.length; i += 3 * MAX_POINTS) {
            hits.push(...await this.view.scene.query(points.subarray(i, i + 3 * MAX_POINTS), this.view.time));
            signal.throwIfAborted();
        }
        return hits;
    }

    // Components that are chosen, by number.
    #chosen() {
        const chosen = Number(this.form.component.value), wanted = this.ended.filter(({ number }) => chosen === 0 || number === chosen);
        if (wanted.length === 0)
            throw new Error('Nothing in the scene has an end, so there is no mesh.');
        return wanted;
    }

    // All at once are one solid; what has no end is left out part by part.
    async make_stl(signal) {
        const wanted = this.#chosen();
        if (this.ended.length === this.view.scene.components.length && wanted.length > 1)
            return stl(await this.#mesh(0, signal, 0, 1));
        const meshes = [];
        for (const { number } of wanted)
            meshes.push(await this.#mesh(number, signal, meshes.length, wanted.length));
        return stl(joined(meshes));
    }

    async make_glb(signal) {
        const parts = [], wanted = this.#chosen();
        for (const { number, name } of wanted) {
            const mesh = await this.#mesh(number, signal, parts.length, wanted.length);
            parts.push({ name, mesh, hits: await this.#hits(mesh.steps ? middles(mesh) : mesh.vertices, signal),
                         normals: await this.view.scene.normal(corners(mesh), this.view.time) });
            signal.throwIfAborted();
        }
        return glb(parts);
    }
}

// Meshes one behind the other.
function joined(meshes) {
    const vertices = [], triangles = [];
    for (const mesh of meshes) {
        const before = vertices.length / 3;
        for (const number of mesh.vertices)
            vertices.push(number);
        for (const number of mesh.triangles)
            triangles.push(before + number);
    }
    return { vertices: Float64Array.from(vertices), triangles: Uint32Array.from(triangles) };
}
