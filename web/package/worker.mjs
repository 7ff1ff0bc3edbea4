// worker.mjs: the compiler, in a worker.  Answers the calls of compiler.mjs: { id, call, args } by { id, value } or
// { id, error }; a mesh tells its progress by { id, done } before.
import { loadCore } from './core.mjs';

const projections = ['perspective', 'orthographic', 'panorama'];
// The usual fonts, by the names that scenes have for them; '' is what texts have that name none.
const usualFonts = {
    '': 'DejaVuSans.ttf', 'DejaVu Sans': 'DejaVuSans.ttf', 'DejaVu Sans:bold': 'DejaVuSans-Bold.ttf',
    'DejaVu Serif': 'DejaVuSerif.ttf', 'DejaVu Serif:bold': 'DejaVuSerif-Bold.ttf',
};

let core, version = null;
const scenes = new Map();
let nextScene = 1;

// ---- files ----

// What was fetched, by address: bytes, or null where there is nothing.
const fetched = new Map();
// Addresses that a compilation has asked for and that are not there yet.
let missing = new Set();
let current = {}; // the options of the text that is compiled

function bytesAt(address) {
    if (!fetched.has(address))
        missing.add(address);
    return fetched.get(address) ?? null;
}

function load(path) {
    const given = current.files?.[path];
    if (given !== undefined || !current.base)
        return given ?? null;
    return bytesAt(new URL(path, current.base).href);
}

function font(name) {
    const given = current.fonts?.[name ?? ''] ?? usualFonts[name ?? ''];
    if (given === undefined)
        return null;
    const bytes = typeof given === 'string' ? bytesAt(new URL(given, new URL('fonts/', import.meta.url)).href) : given;
    return bytes && { bytes, face: 0 };
}

async function fetchMissing() {
    await Promise.all(Array.from(missing, async address => {
        const response = await fetch(address).catch(() => null);
        fetched.set(address, response?.ok ? new Uint8Array(await response.arrayBuffer()) : null);
    }));
    missing.clear();
}

// Compiles, again as long as files have to be fetched for it.
async function withFiles(options, compile) {
    for (;;) {
        current = options;
        missing.clear();
        const made = compile();
        if (missing.size === 0)
            return made;
        made.scene?.free();
        await fetchMissing();
    }
}

// ---- scenes ----

// What a page knows of a scene.
function about(held) {
    const { state, scene } = held, described = scene.describe();
    held.parameters = described.parameters.map(p => p.name);
    version = described.version;
    const { shaders } = described;
    shaders.low = finite(shaders.low, -Infinity);
    shaders.high = finite(shaders.high, Infinity);
    return { ...described, parameters: described.parameters.map(shownParameter), cameras: viewOf(state).cameras,
        animated: isAnimated(held) };
}

const kindOf = p => (p.color ? 'color' : p.value.length > 1 ? 'vector' : p.whole ? 'switch' : p.degrees ? 'angle' : 'number');

// JSON has no infinite numbers.
const finite = (numbers, otherwise) => numbers.map(number => number ?? otherwise);

function shownParameter(p) {
    const { name, value, low, high, doc, source, start, end } = p;
    return { name, kind: kindOf(p), value, default: value.slice(), low: finite(low, -Infinity), high: finite(high, Infinity),
        doc, source, start, end };
}

function viewOf(state) {
    const view = state.view();
    for (const camera of view.cameras)
        camera.projection = projections[camera.projection];
    return view;
}

// What a picture reads at a time, as one number for all.
function numbersAt(state, time) {
    const accepted = state.setTime(time);
    const { rows, cells } = state.tables();
    const numbers = [state.parameters().slice(4), state.values(), rows, cells];
    return JSON.stringify([accepted, viewOf(state)]) + numbers.map(hash).join();
}

function hash(numbers) {
    const words = new Uint32Array(numbers.buffer);
    let sum = 2166136261;
    for (const word of words)
        sum = Math.imul(sum ^ word, 16777619);
    return sum >>> 0;
}

// Whether the picture depends on the time: its text reads it, or its numbers are others later on.
function isAnimated({ scene, state }) {
    const text = scene.describe().too_large ? '' : scene.text('essl', { stateValues: true }) ?? '';
    const differs = /krs_parameter\[0\]\.x/.test(text) ||
        [0.37, 1.91].some(time => numbersAt(state, time) !== numbersAt(state, 0));
    state.setTime(0);
    return differs;
}

// A text with its options, its scene and the values that were set.
class Held {
    constructor(options) {
        Object.assign(this, { options, scene: null, state: null, set: new Map(), tables: null, version: 0 });
    }

    async compile(text) {
        const { name, studio } = this.options;
        const made = await withFiles(this.options, () => this.scene ? this.scene.update(text)
            : core.compile(text, { name, studio: studio !== false, pictures: true, automatic: true }));
        return this.#take(made);
    }

    // Takes the scene over, or stays what it was.
    #take({ scene, diagnostics, changes }) {
        if (!scene)
            return { ok: false, diagnostics, change: 'nothing', about: null };
        // Numbers are in the shaders until the first edit, and in parameters from then on (KRS_SPECIALIZE_AUTO).
        const change = changes?.kind ?? 'structure';
        this.#freeScene();
        this.scene = scene;
        this.state = scene.state();
        const told = about(this);
        for (const [name, value] of this.set) {
            const parameter = told.parameters.find(p => p.name === name);
            if (parameter && this.state.set(name, value))
                parameter.value = value;
            else
                this.set.delete(name);
        }
        return { ok: true, diagnostics, change, about: told };
    }

    #freeScene() {
        this.state?.free();
        this.scene?.free();
        this.state = this.scene = null;
    }

    free() { this.#freeScene(); }

    at(time) {
        this.state.setTime(time);
        return this.state;
    }

    // Tables that a picture has already are not sent again.
    tablesUnless(seen) {
        const { rows, cells } = this.state.tables(), now = `${hash(rows)} ${hash(cells)} ${rows.length} ${cells.length}`;
        if (now !== this.tables) {
            this.tables = now;
            this.version++;
        }
        return { version: this.version, ...(seen === this.version ? {} : { rows, cells }) };
    }
}

// ---- calls ----

const heldOf = number => {
    const held = scenes.get(number);
    if (!held?.scene)
        throw new Error('there is no scene: its text has mistakes, or it was freed');
    return held;
};

const calls = {
    async compile({ text, options }) {
        const held = new Held(options), number = nextScene++;
        scenes.set(number, held);
        return { number, ...await held.compile(text) };
    },

    update({ scene, text }) { return scenes.get(scene).compile(text); },

    free({ scene }) {
        scenes.get(scene)?.free();
        scenes.delete(scene);
    },

    set({ scene, name, value }) {
        const held = heldOf(scene), good = held.state.set(name, value);
        if (good)
            held.set.set(name, value);
        return good;
    },

    reset({ scene }) {
        const held = heldOf(scene);
        held.set.clear();
        held.state.free();
        held.state = held.scene.state();
    },

    query({ scene, points, time }) { return heldOf(scene).at(time).probe(points).hits; },

    distance({ scene, points, time }) { return heldOf(scene).at(time).distance(points); },

    raycast({ scene, origins, directions, farthest, tolerance, time }) {
        return heldOf(scene).at(time).raycast(origins, directions, { farthest, tolerance }).hits;
    },

    cameras({ scene, time }) { return viewOf(heldOf(scene).at(time)).cameras; },

    // What a picture is drawn from.
    state({ scene, time, tables }) {
        const held = heldOf(scene), state = held.at(time);
        return { parameters: state.parameters(), values: state.values(), tables: held.tablesUnless(tables), view: viewOf(state) };
    },

    shader({ scene, target, stateValues, earlyOuts }) {
        const text = heldOf(scene).scene.text(target, { stateValues, noEarlyOuts: earlyOuts === false });
        if (text === null)
            throw new Error(heldOf(scene).scene.describe().too_large);
        return text;
    },

    // In a worker of its own: the scene is compiled here.
    async mesh({ text, options, values, time, how }, tell) {
        const held = new Held(options);
        const { ok } = await held.compile(text);
        if (!ok)
            throw new Error('there is no scene: its text has mistakes');
        for (const [name, value] of values)
            held.state.set(name, value);
        report = tell;
        const mesh = held.at(time).mesh(how);
        if (!mesh.vertices)
            throw new Error(`the mesh is not made (status ${mesh.status})`);
        return mesh;
    },

    format({ text, name }) { return core.format(text, { name }); },

    async ask({ question, text, params, options }) {
        const { name } = options;
        return (await withFiles(options, () => {
            core.open(text, { name });
            return { answer: core.ask(question, params, { name }) };
        })).answer;
    },

    async check({ text, options }) {
        const { scene, diagnostics } = await withFiles(options, () => core.compile(text, { name: options.name }));
        scene?.free();
        return diagnostics;
    },

    version() { return version ??= versionOf(core.compile('show sphere(1);').scene); },
};

function versionOf(scene) {
    const { version } = scene.describe();
    scene.free();
    return version;
}

// ---- messages ----

let report = () => {};
const buffersOf = value => Object.values(value ?? {}).flatMap(part =>
    ArrayBuffer.isView(part) ? [part.buffer] : part?.rows || part?.cells ? buffersOf(part) : []);

async function answer({ id, call, args }) {
    try {
        const value = await calls[call](args ?? {}, done => postMessage({ id, done }));
        postMessage({ id, value }, ArrayBuffer.isView(value) ? [value.buffer] : buffersOf(value));
    } catch (error) {
        postMessage({ id, error: error.message });
    }
}

// Calls are answered one after the other: a text that waits for files keeps what follows waiting.
let last = loadCore({ load, font, progress: done => (report(done), true) }).then(made => { core = made; });
self.onmessage = ({ data }) => { last = last.then(() => answer(data), error => postMessage({ id: data.id, error: error.message })); };
