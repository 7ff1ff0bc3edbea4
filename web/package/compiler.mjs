// compiler.mjs: scenes, as a page has them: the compiler is in a worker (worker.mjs).

let folder = new URL('./', import.meta.url);

export function locate(place) {
    folder = new URL(place, globalThis.document?.baseURI ?? import.meta.url);
    if (!folder.pathname.endsWith('/'))
        folder.pathname += '/';
}

// A file of this package.
export const placeOf = name => new URL(name, folder);

// Elements of a page begin while a bundle with this file is read, before its program says by `locate` where the files are:
// they wait for the end of that.
export const located = new Promise(resolve => { setTimeout(resolve); });

// ---- the worker ----

// A worker from another host is not started: a small one of this host imports it.
export function startWorker(name) {
    const place = placeOf(name).href;
    if (new URL(place).origin === globalThis.location?.origin)
        return new Worker(place, { type: 'module' });
    const starter = URL.createObjectURL(new Blob([`import ${JSON.stringify(place)};`], { type: 'text/javascript' }));
    return new Worker(starter, { type: 'module' });
}

// What a scene may take: seconds of a call, bytes of memory, bytes of a file.  Texts may come from strangers.
export const limits = { seconds: 60, memory: 2 ** 31, bytes: 2 ** 26 };
const longest = 2 ** 31 - 1; // milliseconds that a browser can wait

// The work of others has ended the worker: this call can be asked again.
class Interrupted extends Error {}

class Calls {
    constructor() {
        this.worker = startWorker('worker.mjs');
        this.waiting = new Map();
        this.next = 1;
        this.ended = false;
        this.worker.onmessage = ({ data }) => this.#take(data);
        this.worker.onerror = event => this.end(new Error(event.message ?? 'the compiler cannot be loaded'));
    }

    call(call, args, told) {
        const id = this.next++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, { resolve, reject, told });
            this.worker.postMessage({ id, call, args });
        });
    }

    // Ends all calls, or one with the reason: the others were not at fault.
    end(reason, guilty) {
        this.ended = true;
        clearTimeout(this.timer);
        this.worker.terminate();
        for (const [id, { reject }] of this.waiting)
            reject(guilty === undefined || id === guilty ? reason : new Interrupted(reason.message));
        this.waiting.clear();
    }

    // The worker begins with a call, tells how far it is, or has ended it.
    #take({ id, value, error, done, begun, broken }) {
        const waiting = this.waiting.get(id);
        if (!waiting)
            return;
        if (done !== undefined) {
            waiting.told?.(done);
            return;
        }
        clearTimeout(this.timer);
        if (begun) {
            this.#limit(id, waiting);
            return;
        }
        if (broken) {
            this.end(new Error(`the compiler has failed: ${error}`), id);
            return;
        }
        this.waiting.delete(id);
        if (error === undefined)
            waiting.resolve(value);
        else
            waiting.reject(new Error(error));
    }

    // What tells its progress takes as long as it takes: it can be ended by whoever is told.
    #limit(id, { told }) {
        const { seconds } = limits;
        if (!told && 1000 * seconds <= longest)
            this.timer = setTimeout(() => this.end(new Error(`the scene takes more than ${seconds} s`), id), 1000 * seconds);
    }
}

// A worker is another when the last was ended.
let shared, answering;
const worker = () => (shared = shared && !shared.ended ? shared : new Calls());

// Asks again when others had the worker ended.
async function patiently(call) {
    for (;;) {
        try {
            return await call();
        } catch (error) {
            if (!(error instanceof Interrupted))
                throw error;
        }
    }
}
const ask = (call, args) => worker().call(call, args);
const askPatiently = (call, args) => patiently(() => ask(call, args));

// Scenes find that their worker is another, and are compiled again.
export function stop() { shared?.end(new Error('the compilation was ended')); }

// ---- scenes ----

const flat = points => (Array.isArray(points[0]) ? points.flat() : Array.from(points));
const absolute = place => (place === undefined ? undefined : new URL(place, globalThis.document?.baseURI ?? import.meta.url).href);
const optionsOf = ({ name = 'scene.krs', files, base, root = base, fonts, studio } = {}) => ({
    name, files, base: absolute(base), root: absolute(root), studio, memory: limits.memory, bytes: limits.bytes,
    fonts: fonts && Object.fromEntries(Object.entries(fonts).map(([key, font]) => [key, ArrayBuffer.isView(font) ? font : absolute(font)])),
});

const infinite = (box, otherwise) => box.map(number => number ?? otherwise);
const shownComponent = ({ low, high, ...rest }) => ({ ...rest, low: infinite(low, -Infinity), high: infinite(high, Infinity) });
const nothing = { parameters: [], components: [], cameras: [], image: { width: 0, height: 0, samples: 0, integrator: null }, animated: false, too_large: null };

export class Scene extends EventTarget {
    #options;
    #number;
    #worker;           // that has the scene
    #there;            // when it has
    #unseen = false;   // it is another one, whose tables nobody has seen
    #about = nothing;
    #values = new Map();
    #compiling = null; // what is compiled now
    #next = null;      // what follows it: a text and its promise

    constructor(options) {
        super();
        this.#options = options;
        Object.assign(this, { ok: false, diagnostics: [], text: '' });
    }

    get parameters() { return this.#about.parameters; }
    get components() { return this.#about.components; }
    get cameras() { return this.#about.cameras; }
    get image() { return this.#about.image; }
    get animated() { return this.#about.animated; }
    // All that the compiler tells of the scene (answers.c).
    get about() { return this.#about; }
    get name() { return this.#options.name; }
    get tooLarge() { return this.#about.too_large; }

    // Of texts that come while one is compiled only the last is compiled.
    update(text) {
        if (!this.#compiling) {
            this.#compiling = this.#compile(text).finally(() => {
                const next = this.#next;
                this.#compiling = this.#next = null;
                if (next)
                    this.update(next.text).then(next.resolve, next.reject);
            });
            return this.#compiling;
        }
        this.#next ??= newPromise();
        this.#next.text = text;
        return this.#next.promise;
    }

    // The worker has the scene of the last text that was accepted, with its values.
    #ready() {
        if (this.#worker !== worker()) {
            this.#worker = worker();
            this.#there = this.#compileAgain();
        }
        return this.#there;
    }

    async #compileAgain() {
        this.#number = undefined;
        if (!this.ok)
            return;
        this.#unseen = true;
        const { number } = await ask('compile', { text: this.text, options: this.#options });
        this.#number = number;
        await Promise.all(Array.from(this.#values, ([name, value]) => ask('set', { scene: number, name, value })));
    }

    async #compile(text) {
        const made = await patiently(async () => {
            await this.#ready();
            return this.#number === undefined ? ask('compile', { text, options: this.#options }) : ask('update', { scene: this.#number, text });
        });
        this.#number ??= made.number;
        this.diagnostics = made.diagnostics;
        if (made.ok) {
            Object.assign(this, { ok: true, text });
            this.#about = { ...made.about, components: made.about.components.map(shownComponent) };
        }
        const { ok, diagnostics, change } = made;
        if (ok && change !== 'nothing')
            this.#changed(change);
        return { ok, diagnostics, change };
    }

    #changed(change) { this.dispatchEvent(new CustomEvent('change', { detail: change })); }

    async set(name, value) {
        const numbers = typeof value === 'number' ? [value] : Array.from(value);
        await this.#ask('set', { name, value: numbers });
        const parameter = this.parameters.find(p => p.name === name);
        if (parameter) { // the text may be another by now
            parameter.value = numbers;
            this.#values.set(name, numbers);
            this.#changed('values');
        }
    }

    async reset() {
        await this.#ask('reset');
        this.#values.clear();
        for (const parameter of this.parameters)
            parameter.value = parameter.default.slice();
        this.#changed('values');
    }

    query(points, time = 0) { return this.#ask('query', { points: flat(points), time }); }
    distance(points, time = 0) { return this.#ask('distance', { points: flat(points), time }); }
    normal(points, time = 0) { return this.#ask('normal', { points: flat(points), time }); }

    raycast(origins, directions, { farthest = Infinity, tolerance = 0, time = 0 } = {}) {
        return this.#ask('raycast', { origins: flat(origins), directions: flat(directions), farthest, tolerance, time });
    }

    shader(target = 'glsl', { stateValues = false, earlyOuts = true } = {}) {
        return this.#ask('shader', { target, stateValues, earlyOuts });
    }

    // The shaders of a picture, which edits of numbers leave as they are: these are among the numbers of `state`.
    pictureText() { return this.#ask('shader', { target: 'essl', values: true, stateValues: true, earlyOuts: false }); }

    // What a picture reads at a time; of tables, what it has not seen.
    state(time, tables) {
        return patiently(async () => {
            await this.#ready();
            const seen = this.#unseen ? undefined : tables;
            this.#unseen = false;
            return ask('state', { scene: this.#number, time, tables: seen });
        });
    }

    camerasAt(time) { return this.#ask('cameras', { time }); }

    // A worker of its own can be ended at any time.
    async mesh({ signal, progress, time = 0, ...how } = {}) {
        signal?.throwIfAborted();
        const calls = new Calls(), abort = () => calls.end(signal.reason), tell = progress ?? (() => {});
        signal?.addEventListener('abort', abort);
        try {
            return await calls.call('mesh', { text: this.text, options: { ...this.#options, studio: false },
                values: Array.from(this.#values), time, how }, tell);
        } finally {
            signal?.removeEventListener('abort', abort);
            calls.end(new Error('ended'));
        }
    }

    free() {
        if (this.#number !== undefined && this.#worker === shared)
            ask('free', { scene: this.#number });
    }

    #ask(call, args) {
        return patiently(async () => {
            await this.#ready();
            return ask(call, { scene: this.#number, ...args });
        });
    }
}

function newPromise() {
    const made = {};
    made.promise = new Promise((resolve, reject) => Object.assign(made, { resolve, reject }));
    return made;
}

export async function compile(text, options) {
    const scene = new Scene(optionsOf(options));
    await scene.update(text);
    return scene;
}

export const format = async (text, { name } = {}) => {
    const { text: formatted, diagnostics } = await askPatiently('format', { text, name });
    return { text: formatted, diagnostics };
};
export const check = (text, options) => askPatiently('check', { text, options: optionsOf(options) });
// Whoever writes does not wait for what is compiled.
const askAbout = (question, text, params, options) => patiently(() => {
    answering = answering && !answering.ended ? answering : new Calls();
    return answering.call('ask', { question, text, params, options: optionsOf(options) });
});
export { askAbout as ask };
export const version = () => askPatiently('version');
