// worker.mjs: the compiler, in a worker.  Answers the calls of compiler.mjs: { id, call, args } by { id, value } or
// { id, error }; a mesh tells its progress by { id, done } before.
import { loadCore, loadLetters } from './core.mjs';

const projections = ['perspective', 'orthographic', 'panorama'];
// The usual fonts, by the names that scenes have for them; '' is what texts have that name none.
const usualFonts = {
    '': 'DejaVuSans.ttf', 'DejaVu Sans': 'DejaVuSans.ttf', 'DejaVu Sans:bold': 'DejaVuSans-Bold.ttf',
    'DejaVu Serif': 'DejaVuSerif.ttf', 'DejaVu Serif:bold': 'DejaVuSerif-Bold.ttf',
};

let core, version = null;
const scenes = new Map();
let nextScene = 1;

const noMemory = 71; // KRS_OUT_OF_MEMORY

// ---- files ----

// What was fetched, by address: bytes, or null where there is nothing.
const fetched = new Map();
// Addresses that a compilation has asked for and that are not there yet.
let missing = new Set();
let current = {}; // the options of the text that is compiled
// What reads fonts: it is fetched when a scene has a text.
let reader = null, wantsReader = false;

function bytesAt(address) {
    if (!fetched.has(address))
        missing.add(address);
    return fetched.get(address) ?? null;
}

// Files are those of the root's folder and below: a stranger's scene asks for no others.
function load(path) {
    const given = current.files?.[path];
    if (given !== undefined || !current.base)
        return given ?? null;
    const { href } = new URL(path, current.base);
    return href.startsWith(new URL('.', current.root).href) ? bytesAt(href) : null;
}

function letters() {
    wantsReader = !reader;
    return reader;
}

function font(name) {
    const given = current.fonts?.[name ?? ''] ?? usualFonts[name ?? ''];
    if (given === undefined)
        return null;
    const bytes = typeof given === 'string' ? bytesAt(new URL(given, new URL('fonts/', import.meta.url)).href) : given;
    return bytes && { bytes, face: 0 };
}

// The bytes at an address; null: there are none, or more than are permitted.
async function fetchBytes(address) {
    const response = await fetch(address).catch(() => null);
    if (!response?.ok)
        return null;
    const pieces = [];
    let length = 0;
    for (const reader = response.body.getReader(); ;) {
        const { done, value } = await reader.read();
        if (done)
            return new Uint8Array(await new Blob(pieces).arrayBuffer());
        pieces.push(value);
        if ((length += value.length) > current.bytes) {
            await reader.cancel();
            return null;
        }
    }
}

async function fetchMissing() {
    const files = Array.from(missing, async address => {
        fetched.set(address, await fetchBytes(address).catch(() => null));
    });
    if (wantsReader)
        reader = await loadLetters().catch(error => { throw new Error(`fonts cannot be read: ${error.message}`); });
    await Promise.all(files);
}

// Compiles, again as long as files have to be fetched for it.  What is not there may be there for the next text.
async function withFiles(options, compile) {
    for (const [address, bytes] of fetched)
        if (bytes === null)
            fetched.delete(address);
    for (;;) {
        current = options;
        missing.clear();
        wantsReader = false;
        const made = compile();
        if (made.status === noMemory)
            throw new Error(`the scene takes more than ${options.memory / 2 ** 20} MiB`);
        if (missing.size === 0 && !wantsReader)
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

// What a picture reads at a time, but for the time itself, as one text.
function numbersAt(state, time) {
    const accepted = state.setTime(time), numbers = [state.parameters().slice(4), state.values(), state.tableInputs()];
    return JSON.stringify([accepted, viewOf(state)]) + numbers.map(hash).join();
}

function hash(numbers) {
    const words = new Uint32Array(numbers.buffer);
    let sum = 2166136261;
    for (const word of words)
        sum = Math.imul(sum ^ word, 16777619);
    return sum >>> 0;
}

// Whether the picture depends on the time: its shaders read it, or its numbers are others later on.
function isAnimated({ state, timed }) {
    const first = timed || numbersAt(state, 0), differs = timed || [0.37, 1.91].some(time => numbersAt(state, time) !== first);
    state.setTime(0);
    return differs;
}

function readsTime(scene) {
    return /krs_parameter\[0\]\.x/.test(scene.describe().too_large ? '' : scene.text('essl', { stateValues: true }) ?? '');
}

// A text with its options, its scene and the values that were set.
class Held {
    constructor(options) {
        Object.assign(this, { options, scene: null, state: null, set: new Map(), tables: null, version: 0 });
    }

    async compile(text) {
        const taken = this.#take(await withFiles(this.options, () => this.#make(text)));
        this.text = taken.ok ? text : this.text;
        return taken;
    }

    #compileAs(text, numbers) {
        const { name, studio, memory } = this.options;
        return core.compile(text, { name, studio: studio !== false, pictures: true, memory, ...numbers });
    }

    // Numbers are not in shaders, so that an edit of one compiles none; but where they are more than drivers bear.
    #make(text) {
        const made = this.scene ? this.scene.update(text) : this.#compileAs(text, { structure: true });
        if (!made.scene || made.scene.describe().shaders.affordable)
            return made;
        made.scene.free();
        return { ...made, scene: this.#compileAs(text, { automatic: true }).scene, changes: { kind: 'structure' } };
    }

    // The scene with its numbers as they are, for what is made once.
    async withNumbers(use) {
        const { scene } = await withFiles(this.options, () => this.#compileAs(this.text));
        try {
            return use(scene);
        } finally {
            scene.free();
        }
    }

    // Takes the scene over, or stays what it was.
    #take({ scene, diagnostics, changes }) {
        if (!scene)
            return { ok: false, diagnostics, change: 'nothing', about: null };
        const change = changes?.kind ?? 'structure';
        this.#freeScene();
        this.scene = scene;
        this.state = scene.state();
        this.inputs = null;
        if (change === 'structure')
            this.timed = readsTime(scene);
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
        const inputs = hash(this.state.tableInputs());
        if (seen === this.version && inputs === this.inputs)
            return { version: seen };
        this.inputs = inputs;
        const { rows, cells } = this.state.tables(), now = `${hash(rows)} ${hash(cells)} ${rows.length} ${cells.length}`;
        if (now !== this.tables) {
            this.tables = now;
            this.version++;
        }
        return { version: this.version, ...(seen === this.version ? {} : { rows, cells }) };
    }
}

// ---- reasons ----

const bounded = numbers => numbers.every(number => number !== null);

// Why a value was not taken.
function whyRefused(parameters, name, value) {
    const parameter = parameters.find(p => p.name === name), said = `${name} cannot be ${value.join(', ')}`;
    if (!parameter)
        return `there is no parameter ${name}: the scene has ${parameters.map(p => p.name).join(', ') || 'none'}`;
    const { low, high } = parameter, { length } = parameter.value;
    if (value.length !== length)
        return `${said}: it has ${length === 1 ? 'one number' : `${length} numbers`}`;
    if (value.some((number, i) => number < (low[i] ?? -Infinity) || number > (high[i] ?? Infinity)))
        return `${said}: it is from ${low.map(number => number ?? '-∞').join(', ')} to ${high.map(number => number ?? '∞').join(', ')}`;
    return `${said}: a number of the scene would not be finite`;
}

// Why there is no mesh (krs_mesh in mesh.h).
function whyNoMesh({ components, shaders }, { component = 0 }, status) {
    const wanted = component ? components.slice(component - 1, component) : components;
    const endless = wanted.find(({ low, high }) => !bounded(low) || !bounded(high));
    if (status !== 2)
        return status === noMemory ? 'there is no memory left, of which a larger error takes less' : `krs failed (status ${status})`;
    if (component && !wanted.length)
        return `there is no component ${component}: the scene has ${components.length}`;
    if (shaders.open_surfaces)
        return 'the scene has surfaces without thickness, which enclose nothing; .shell gives them some';
    if (endless)
        return `${endless.name} has no end`;
    return 'the error is too small: it is at least a 500,000th of the size';
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
        const held = heldOf(scene);
        if (!held.state.set(name, value))
            throw new RangeError(whyRefused(held.scene.describe().parameters, name, value));
        held.set.set(name, value);
    },

    reset({ scene }) {
        const held = heldOf(scene);
        held.set.clear();
        held.state.free();
        held.state = held.scene.state();
    },

    query({ scene, points, time }) { return heldOf(scene).at(time).probe(points).hits; },

    distance({ scene, points, time }) { return heldOf(scene).at(time).distance(points); },

    normal({ scene, points, time }) { return heldOf(scene).at(time).normal(points); },

    raycast({ scene, origins, directions, farthest, tolerance, time }) {
        return heldOf(scene).at(time).raycast(origins, directions, { farthest, tolerance }).hits;
    },

    cameras({ scene, time }) { return viewOf(heldOf(scene).at(time)).cameras; },

    // What a picture is drawn from.
    state({ scene, time, tables }) {
        const held = heldOf(scene), state = held.at(time);
        return { parameters: state.parameters(), values: state.values(), tables: held.tablesUnless(tables), view: viewOf(state) };
    },

    // With `values` numbers of the text are not in the shader, but among those of a state.
    async shader({ scene, target, values, stateValues, earlyOuts }) {
        const held = heldOf(scene), print = made => made.text(target, { stateValues, noEarlyOuts: earlyOuts === false });
        const text = values ? print(held.scene) : await held.withNumbers(print);
        if (text === null)
            throw new Error(held.scene.describe().too_large);
        return text;
    },

    // In a worker of its own: the scene is compiled here.
    async mesh({ text, options, values, time, how }, tell) {
        const { scene } = await withFiles(options, () => core.compile(text, { name: options.name, memory: options.memory, pictures: true }));
        if (!scene)
            throw new Error('there is no scene: its text has mistakes');
        const state = scene.state();
        for (const [name, value] of values)
            state.set(name, value);
        state.setTime(time);
        report = tell;
        const mesh = state.mesh(how);
        if (!mesh.vertices)
            throw new Error(`no mesh is made: ${whyNoMesh(scene.describe(), how, mesh.status)}`);
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
        const { scene, diagnostics } = await withFiles(options, () => core.compile(text, { name: options.name, memory: options.memory }));
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

// What the compiler is after one of these nobody knows.
const isBroken = error => error instanceof WebAssembly.RuntimeError || error instanceof RangeError && /call stack/.test(error.message);

async function answer({ id, call, args }) {
    try {
        core ??= await loadCore({ load, font, letters, progress: done => (report(done), true) });
        postMessage({ id, begun: true });
        const value = await calls[call](args ?? {}, done => postMessage({ id, done }));
        postMessage({ id, value }, ArrayBuffer.isView(value) ? [value.buffer] : buffersOf(value));
    } catch (error) {
        postMessage({ id, error: error.message, broken: isBroken(error) });
    }
}

// Calls are answered one after the other: a text that waits for files keeps what follows waiting.
let last = Promise.resolve();
self.onmessage = ({ data }) => { last = last.then(() => answer(data)); };
