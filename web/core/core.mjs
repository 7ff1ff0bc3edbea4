// core.mjs: the compiler in a page or in its worker.
//
//     const core = await loadCore({ load: path => files.get(path), font: name => ({ bytes, face: 0 }) });
//     const { scene, diagnostics } = core.compile('show sphere(1);');
//
// What it needs from outside comes by `load` and `font`, at once: whoever has to fetch a file first compiles again when
// it is there.  Fonts are read by a module of its own: without `letters` there are none.  Objects of the core have memory of their own, which `free` gives back.
import Krs from './krs.mjs';

const options = { studio: 1, pictures: 2, gradients: 4, assembly: 8, figures: 16, structure: 32, automatic: 64 };
const textOptions = { stateValues: 1, noEarlyOuts: 2 };
export const targets = ['glsl', 'essl', 'wgsl'];

const bitsOf = (names, wanted) =>
    Object.entries(names).reduce((bits, [name, bit]) => (wanted[name] ? bits | bit : bits), 0);

// The bytes of a module: those that are given, or what is at a place.
async function instantiate(wasm, imports) {
    if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm))
        return WebAssembly.instantiate(wasm, imports);
    const response = await fetch(wasm);
    if (!response.ok)
        throw new Error(`${response.url}: ${response.statusText || response.status}`);
    if (response.headers.get('Content-Type') === 'application/wasm')
        return WebAssembly.instantiateStreaming(response, imports);
    return WebAssembly.instantiate(await response.arrayBuffer(), imports);
}

// A module that emcc has linked, with what its page supplies.
const begin = (make, wasm, supplied = {}) => new Promise((resolve, reject) => make({
    instantiateWasm: (imports, done) => {
        instantiate(wasm, imports).then(made => done(made.instance), reject);
        return {};
    },
    ...supplied,
}).then(resolve, reject));

export async function loadCore({ wasm = new URL('krs.wasm', import.meta.url), load = () => null, font = () => null, letters = () => null,
    progress = () => true } = {}) {
    let core;
    // Bytes that the core frees, and how many they are.
    const give = (bytes, length) => {
        if (bytes == null)
            return 0;
        const given = typeof bytes === 'string' ? new TextEncoder().encode(bytes) : bytes;
        const at = core.put(given);
        core.words()[length >> 2] = given.length;
        return at;
    };
    const module = await begin(Krs, wasm, {
        load: (path, length) => give(load(core.string(path)), length),
        font: (name, length, face) => {
            const reader = letters(), found = font(name ? core.string(name) : null);
            core.words()[face >> 2] = found?.face ?? 0;
            return give(reader && found?.bytes, length);
        },
        letters: (font, length, face, text, lettering, count) => letters().drawFor(core, font, length, face, text, lettering, count),
        progress: done => progress(done),
    });
    core = new Core(module);
    return core;
}

// Reads fonts for a core (web/letters/letters.h).
export async function loadLetters({ wasm = new URL('letters.wasm', import.meta.url) } = {}) {
    const { default: make } = await import('./letters.mjs');
    return new Letters(await begin(make, wasm));
}

class Memory {
    constructor(module) {
        this.m = module;
    }

    bytes() { return this.m.HEAPU8; }
    words() { return new Uint32Array(this.bytes().buffer); }

    // A copy of numbers in memory.
    copy(Type, at, count) { return new Type(this.bytes().buffer, at, count).slice(); }

    // The bytes of a text, with the 0 at its end.
    textBytes(at) {
        const bytes = this.bytes();
        return bytes.subarray(at, bytes.indexOf(0, at) + 1);
    }

    string(at) { return new TextDecoder().decode(this.textBytes(at).subarray(0, -1)); }

    // Puts bytes into memory, with a 0 behind them.
    put(bytes) {
        const at = this.m._malloc(bytes.length + 1);
        if (!at)
            throw new RangeError('the compiler has no memory left');
        this.bytes().set(bytes, at);
        this.bytes()[at + bytes.length] = 0;
        return at;
    }

    // Calls with pieces of memory that are freed behind it.
    using(pieces, call) {
        try {
            return call(...pieces);
        } finally {
            for (const at of pieces)
                this.m._free(at);
        }
    }
}

const letteringBytes = 32; // of Lettering: three numbers and what aligns lines

class Letters extends Memory {
    // Takes and gives what letters_of does, in memory of a core.
    drawFor(core, font, length, face, text, lettering, count) {
        const pieces = [core.bytes().subarray(font, font + length), core.textBytes(text),
            core.bytes().subarray(lettering, lettering + letteringBytes), new Uint8Array(4)].map(bytes => this.put(bytes));
        return this.using(pieces, (font, text, lettering, made) => {
            const drawn = this.m._letters_of(font, length, face, text, lettering, made), numbers = this.words()[made >> 2];
            core.words()[count >> 2] = numbers;
            return drawn ? this.using([drawn], () => core.put(this.bytes().subarray(drawn, drawn + 8 * numbers))) : 0;
        });
    }
}

// Calls into memory of the module, and what goes there and comes from there.
class Core extends Memory {
    putText(text) {
        const bytes = new TextEncoder().encode(text);
        return [this.put(bytes), bytes.length];
    }

    putNumbers(numbers) {
        const from = Float64Array.from(numbers);
        return this.put(new Uint8Array(from.buffer));
    }

    answer() { return JSON.parse(this.string(this.m._core_answer())); }

    // A text that the caller frees.
    take(at) {
        if (!at)
            return null;
        return this.using([at], () => this.string(at));
    }

    // `memory` is how many bytes it may use; 0: as many as usual.
    compile(text, { name = 'scene.krs', memory = 0, ...wanted } = {}) {
        const [at, length] = this.putText(text);
        const [called] = this.putText(name);
        const scene = this.using([at, called], () => this.m._core_compile(at, length, called, bitsOf(options, wanted), memory));
        return { scene: scene ? new Scene(this, scene) : null, ...this.answer() };
    }

    // ---- what editors ask: texts that are open, positions { line, character }, questions and answers as in the Language
    // Server Protocol ----

    // Calls with texts, each of which is there while the call runs.
    #withTexts(texts, call) {
        const pieces = texts.map(text => (text == null ? 0 : this.putText(text)[0]));
        return this.using(pieces, call);
    }

    // A range, or a position, as four numbers in memory.
    #withPlace(place, call) {
        const { start, end } = place?.start ? place : { start: place ?? { line: 0, character: 0 }, end: place ?? { line: 0, character: 0 } };
        const numbers = Uint32Array.of(start.line, start.character, end.line, end.character);
        return this.using([this.put(new Uint8Array(numbers.buffer))], call);
    }

    // Opens a text, or replaces an open one of that name.
    open(text, { name = 'scene.krs' } = {}) {
        const [at, length] = this.putText(text);
        return this.using([at], () => this.#withTexts([name], called => this.m._core_open(called, at, length) !== 0));
    }

    // Puts a text in place of a range.
    edit(range, text, { name = 'scene.krs' } = {}) {
        const [at, length] = this.putText(text);
        return this.using([at], () => this.#withPlace(range, place =>
            this.#withTexts([name], called => this.m._core_edit(called, place, at, length) !== 0)));
    }

    close({ name = 'scene.krs' } = {}) { this.#withTexts([name], called => this.m._core_close(called)); }

    // The result of a question; one that is refused throws why.
    ask(question, params = {}, { name = 'scene.krs' } = {}) {
        if (params.positions)
            return params.positions.flatMap(position => this.ask(question, { position }, { name }));
        const { color = {}, context = {} } = params;
        for (const diagnostic of context.diagnostics ?? [])
            if (diagnostic.data?.replacement != null)
                this.#withPlace(diagnostic.range, place => this.#withTexts([diagnostic.data.replacement, JSON.stringify(diagnostic)],
                    (replacement, json) => this.m._core_fix(place, replacement, json)));
        const parts = this.putNumbers([color.red ?? 0, color.green ?? 0, color.blue ?? 0]);
        const answer = this.using([parts], () => this.#withPlace(params.range ?? params.position, place =>
            this.#withTexts([question, name, params.newName], (asked, called, word) =>
                this.m._core_ask(asked, called, place, word, context.includeDeclaration ?? false, parts))));
        if (answer)
            return JSON.parse(this.string(answer));
        const refusal = this.m._core_refusal();
        throw new Error(refusal ? this.string(refusal) : 'there is no such method');
    }

    complete(position, named) { return this.ask('textDocument/completion', { position }, named); }
    hover(position, named) { return this.ask('textDocument/hover', { position }, named); }

    // What reading an open text finds, as diagnostics; `compile` finds all.
    mistakes({ name = 'scene.krs' } = {}) {
        const found = this.#withTexts([name], called => this.m._core_mistakes(called));
        return found ? JSON.parse(this.string(found)) : [];
    }

    // What can be asked, as a server says it.
    capabilities() { return JSON.parse(this.string(this.m._core_capabilities())); }

    // The text of a file of the library, of which answers say "library:NAME"; null: there is none.
    library(name) {
        const at = this.#withTexts([name], called => this.m._core_library(called));
        return at ? this.string(at) : null;
    }

    format(text, { name = 'scene.krs' } = {}) {
        const [at, length] = this.putText(text);
        const [called] = this.putText(name);
        const formatted = this.using([at, called], () => this.take(this.m._core_format(at, length, called)));
        return { text: formatted, ...this.answer() };
    }
}

class Scene {
    constructor(core, at) {
        Object.assign(this, { core, at });
    }

    free() { this.core.m._krs_scene_free(this.at); }

    // The scene of an edited text; this one stays.
    update(text) {
        const [at, length] = this.core.putText(text);
        const scene = this.core.using([at], () => this.core.m._core_update(this.at, at, length));
        return { scene: scene ? new Scene(this.core, scene) : null, ...this.core.answer() };
    }

    // Its text in a shading language; null: it is too large for one.
    text(target = 'glsl', wanted = {}) {
        return this.core.take(this.core.m._core_text(this.at, targets.indexOf(target), bitsOf(textOptions, wanted)));
    }

    // It never changes.
    describe() {
        if (!this.described) {
            this.core.m._core_describe(this.at);
            this.described = this.core.answer();
        }
        return this.described;
    }

    state() {
        const state = this.core.m._core_state(this.at);
        return state ? new State(this.core, this, state) : null;
    }
}

class State {
    constructor(core, scene, at) {
        Object.assign(this, { core, scene, at });
    }

    free() { this.core.m._krs_state_free(this.at); }

    // False: there is no such parameter, or the value is not permitted.
    set(name, values) {
        const numbers = [].concat(values);
        const [called] = this.core.putText(name);
        return this.core.using([called, this.core.putNumbers(numbers)],
            (word, at) => this.core.m._krs_state_set(this.at, word, at, numbers.length) === 0);
    }

    setTime(seconds) { return this.core.m._krs_state_set_time(this.at, seconds) === 0; }

    view() {
        this.core.m._core_view(this.scene.at, this.at);
        return this.core.answer();
    }

    // Floats that a function of the core writes, `width` for each of `count`.
    #written(Type, count, width, write) {
        const at = this.core.m._malloc(4 * width * count + 4);
        return this.core.using([at], () => (write(at), this.core.copy(Type, at, width * count)));
    }

    // What its text reads: slots of four numbers, texels of tables.
    parameters() {
        const { m } = this.core;
        return this.#written(Float32Array, m._krs_parameter_slots(this.scene.at), 4, at => m._krs_state_parameters(this.at, at));
    }

    values() {
        const { m } = this.core;
        return this.#written(Float32Array, m._krs_value_slots(this.scene.at), 4, at => m._krs_state_values(this.at, at));
    }

    tables() {
        const { m } = this.core;
        const rows = m._krs_table_rows(this.scene.at), cells = m._krs_table_cells(this.scene.at);
        const at = m._malloc(16 * rows + 8 * cells + 8);
        return this.core.using([at], () => {
            m._krs_state_tables(this.at, at, at + 16 * rows);
            return { rows: this.core.copy(Float32Array, at, 4 * rows), cells: this.core.copy(Uint32Array, at + 16 * rows, 2 * cells) };
        });
    }

    // What tables depend on: states of a scene in which these are equal have the same.
    tableInputs() {
        const { m } = this.core, slots = m._krs_parameter_slots(this.scene.at), at = m._malloc(32 * slots + 8);
        return this.core.using([at], () => {
            m._krs_state_table_inputs(this.at, 0, at);
            return this.core.copy(Float64Array, at, 4 * slots);
        });
    }

    #asked(points, width, ask) {
        const count = points.length / 3, { m } = this.core;
        return this.core.using([this.core.putNumbers(points), m._malloc(8 * width * count + 8)], (from, to) =>
            ask(from, count, to) === 0 ? this.core.copy(Float64Array, to, width * count) : null);
    }

    // Points are numbers one behind the other, x, y, z, x, y, z.
    distance(points) { return this.#asked(points, 1, (...call) => this.core.m._krs_distance(this.at, ...call)); }
    normal(points) { return this.#asked(points, 3, (...call) => this.core.m._krs_normal(this.at, ...call)); }

    probe(points) {
        this.core.using([this.core.putNumbers(points)], at => this.core.m._core_probe(this.at, at, points.length / 3));
        return this.core.answer();
    }

    raycast(origins, directions, { farthest = Infinity, tolerance = 0 } = {}) {
        this.core.using([this.core.putNumbers(origins), this.core.putNumbers(directions)], (from, along) =>
            this.core.m._core_raycast(this.at, from, along, origins.length / 3, farthest, tolerance));
        return this.core.answer();
    }

    mesh({ error = 0, component = 0, simplify = false, draft = false } = {}) {
        const { core } = this, mesh = core.m._core_mesh(this.at, error, component, simplify, draft), answer = core.answer();
        if (mesh) {
            answer.vertices = core.copy(Float64Array, answer.vertices, 3 * answer.vertex_count);
            answer.triangles = core.copy(Uint32Array, answer.triangles, 3 * answer.triangle_count);
            core.m._krs_mesh_free(mesh);
        }
        return answer;
    }
}
