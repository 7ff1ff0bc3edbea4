// picture.mjs: a picture of a scene by WebGL2, drawn in tiles that take a few milliseconds each.
//
// It runs in a worker (painter.mjs), and nothing in it waits but for its own tiles.  A picture begins with levels of few,
// large pixels, the first of which is over within a frame; then its pixels get samples.
import { balanceOf, placeRay } from './display.mjs';
import { fitted, frameOf, lightRowsOf, projections } from './frame.mjs';
import { compilePasses, compileResolve, passes } from './programs.mjs';
import { Costs, Tiles } from './tiles.mjs';

const firstTime = 40;                   // milliseconds: of a picture while something moves
const levels = [1, 2, 4, 8, 16, 32, 64]; // sides of the pixels
const firstTiles = 4;                  // of a first level that goes on although something newer has come
const lightsAt = 5120, inputWidth = 64; // the row of the first light (blocks.h); the width of that texture
const textureWidth = 4096;
const mirroredSurfaces = [1, 5];          // that rays are followed to: while pixels are large, and then
const mostLosses = 3;                     // of contexts, by a picture that is not finished meanwhile
const toneMaps = ['neutral', 'aces', 'agx', 'none'];

// ---- textures and what is drawn to ----

function textureOf(gl, format, width, height, data = null) {
    const [kept, layout, type] = {
        floats: [gl.RGBA32F, gl.RGBA, gl.FLOAT], halves: [gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT], words: [gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT],
        pairs: [gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT], bytes: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE],
    }[format];
    const texture = gl.createTexture(), filter = format === 'bytes' ? gl.LINEAR : gl.NEAREST;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, kept, width, height, 0, layout, type, data);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
}

// Textures that are drawn to together: new ones, or those of other layers.
class Layer {
    constructor(gl, formats, width, height) {
        Object.assign(this, { gl, width, height });
        this.textures = formats.map(format => (typeof format === 'string' ? textureOf(gl, format, width, height) : format));
        this.framebuffer = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
        this.textures.forEach((texture, i) =>
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture, 0));
        gl.drawBuffers(this.textures.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
    }

    bind() {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
        gl.viewport(0, 0, this.width, this.height);
    }

    clear() {
        const { gl } = this;
        this.bind();
        gl.disable(gl.SCISSOR_TEST);
        this.textures.forEach((_, i) => gl.clearBufferfv(gl.COLOR, i, [0, 0, 0, 0]));
    }

    free() {
        this.textures.forEach(texture => this.gl.deleteTexture(texture));
        this.gl.deleteFramebuffer(this.framebuffer);
    }
}

// Sums of samples at one size of pixels, and what the passes of a sample leave: of the camera's rays, and of those that go
// on from mirrors and glass, which read one of two layers of paths and write the other.
class Sums {
    constructor(gl, width, height, sumFormat, mirrors) {
        Object.assign(this, { gl, width, height });
        const layer = (...formats) => new Layer(gl, formats, width, height);
        const found = () => ({ march: layer('floats'), normal: layer('floats'), secondary: layer('words') });
        this.sums = layer(...Array(4).fill(sumFormat));
        this.shown = layer('bytes');
        this.first = found();
        this.further = mirrors ? found() : null;
        this.paths = mirrors ? [0, 1].map(() => layer('floats', 'floats', 'floats')) : [];
        this.shaded = mirrors ? this.paths.map(({ textures }) => layer(...this.sums.textures, ...textures)) : [this.sums];
    }

    free() {
        const layers = [this.sums, this.shown, ...this.paths, ...this.shaded, ...[this.first, this.further ?? {}].flatMap(Object.values)];
        layers.forEach(layer => layer.free());
    }
}

// ---- the picture ----

export class Picture {
    constructor(canvas, tell) {
        Object.assign(this, { canvas, tell, scene: null, state: null, programs: null, width: 0, height: 0, wanted: 64,
            costs: null, sums: new Map(), job: null, running: false, shots: [], losses: 0 });
        canvas.addEventListener('webglcontextlost', event => {
            event.preventDefault();
            this.lost = true;
            this.#dropJobs();
            this.losses += this.ours ? 0 : 1;
            if (this.ours && !this.released) // it is wanted again already
                setTimeout(() => this.losing.restoreContext());
        });
        canvas.addEventListener('webglcontextrestored', () => this.#begin().then(() => this.#resume(), error => this.tell({ kind: 'error', message: error.message })));
        this.begun = this.#begin();
    }

    // A scene by which contexts are lost again and again is not drawn any more: browsers would forbid all pictures.
    #resume() {
        if (this.losses < mostLosses)
            return this.scene && this.setScene(this.scene);
        const lost = { kind: 'error', message: 'the graphics card has given up on this scene' };
        this.refused = this.scene?.text;
        this.tell(lost);
        for (const { reject } of this.shots.splice(0))
            reject(new Error(lost.message));
    }

    async #begin() {
        const gl = this.gl = this.canvas.getContext('webgl2', { alpha: false, antialias: false, depth: false, powerPreference: 'high-performance' });
        if (!gl || !gl.getExtension('EXT_color_buffer_float'))
            throw new Error('this browser has no WebGL2 with pixels of floats');
        this.lost = this.ours = false;
        this.losing = gl.getExtension('WEBGL_lose_context');
        this.sumFormat = gl.getExtension('EXT_float_blend') ? 'floats' : 'halves';
        gl.getExtension('KHR_parallel_shader_compile');
        this.sums = new Map();
        this.programs = this.inputs = this.tables = this.shown = null;
        this.parameters = gl.createBuffer();
        this.resolve = await compileResolve(gl);
    }

    // ---- what comes in ----

    // { text, about }: a scene whose text has changed, and its state.
    async setScene(scene, state = this.state) {
        if (scene.text !== this.scene?.text)
            this.losses = 0;
        this.refused = this.losses < mostLosses ? null : this.refused;
        this.scene = scene;
        this.setState(state);
        await this.begun;
        if (this.refused === scene.text)
            return;
        const { gl } = this, previous = this.programs;
        if (this.compiled !== scene.text || !this.programs) {
            if (scene.about.shaders.layers)
                this.albedos ??= await fetchAlbedos();
            const programs = await compilePasses(gl, scene.about, scene.text);
            if (this.scene !== scene) { // another came meanwhile
                freePasses(programs);
                return;
            }
            this.compiled = scene.text;
            this.programs = programs;
            this.costs = null;
            if (previous)
                freePasses(previous);
            this.#dropJobs();
        }
        this.setState(this.state);
    }

    // Numbers of a state, its view and the camera, what is told of the scene in it; of tables, those that are new.
    // Until the shaders of its scene are there, the last picture goes on.
    setState(state) {
        this.state = { ...state, tables: state.tables?.rows ? state.tables : this.state?.tables };
        if (!this.#isReady()) {
            this.next = null;
            return;
        }
        const { gl } = this, { parameters, values } = state, numbers = new Float32Array(Math.max(parameters.length + values.length, 4));
        numbers.set(parameters);
        numbers.set(values, parameters.length);
        gl.bindBuffer(gl.UNIFORM_BUFFER, this.parameters);
        gl.bufferData(gl.UNIFORM_BUFFER, numbers, gl.DYNAMIC_DRAW);
        if (!this.tables || state.tables?.rows)
            this.#setTables(this.state.tables);
        this.#setInputs(state.view.lights);
        this.#restart();
    }

    #setTables({ rows, cells }) {
        const { gl } = this;
        const padded = (Type, numbers, width) => {
            const height = Math.max(Math.ceil(numbers.length / width / textureWidth), 1), all = new Type(width * textureWidth * height);
            all.set(numbers);
            return [textureWidth, height, all];
        };
        this.tables?.forEach(texture => gl.deleteTexture(texture));
        this.tables = [textureOf(gl, 'floats', ...padded(Float32Array, rows, 4)), textureOf(gl, 'pairs', ...padded(Uint32Array, cells, 2))];
    }

    #setInputs(lights) {
        const { gl } = this, rows = lightRowsOf(lights), count = lightsAt + rows.length / 4;
        const all = new Uint32Array(4 * inputWidth * Math.ceil(count / inputWidth));
        if (this.albedos)
            all.set(this.albedos);
        all.set(rows, 4 * lightsAt);
        if (this.inputs)
            gl.deleteTexture(this.inputs);
        this.inputs = textureOf(gl, 'words', inputWidth, all.length / 4 / inputWidth, all);
    }

    setSize(width, height) {
        if (width === this.width && height === this.height)
            return;
        Object.assign(this, { width, height });
        this.#freeSums();
        this.#restart();
    }

    // What is shown stays, until there is something of the new size.
    #freeSums() {
        for (const [key, sums] of this.sums)
            if (sums.shown !== this.shown) {
                sums.free();
                this.sums.delete(key);
            }
    }

    setWanted(samples) {
        this.wanted = samples;
        this.#wake();
    }

    // ---- jobs ----

    // A job is a picture: its state, its size, and how far it is.
    #jobOf(width, height, wanted, coarse) {
        return { state: this.state, width, height, wanted, level: coarse, sample: 0, sums: null, begun: performance.now(), first: coarse, tiles: 0 };
    }

    // Of pictures that are kept, nothing is there yet.
    #dropJobs() {
        this.job = null;
        this.shots.forEach(shot => { shot.job = null; });
    }

    #restart() {
        this.next = this.#isReady() && this.width > 0 ? true : null;
        this.#wake();
    }

    // There are a state and the shaders of its scene.
    #isReady() { return this.state && this.programs && !this.lost && this.compiled === this.scene.text; }

    // The finest level that is soon over; of what draws for the first time nothing is known.
    #firstLevel(width, height) {
        const isSoonOver = level => this.costs?.isSoonOver({ width: Math.ceil(width / level), height: Math.ceil(height / level) }, firstTime);
        return levels.find(isSoonOver) ?? levels.at(-1);
    }

    // Whether the job goes on although something newer has come: its first, coarse picture is soon over, or nothing would
    // be seen while a camera moves.
    #isSoonOver(job) {
        return job.level === job.first && job.sample === 0 && (job.tiles < firstTiles || job.level === levels.at(-1));
    }

    async #wake() {
        if (this.running)
            return;
        this.running = true;
        try {
            while (!this.lost && (this.next || this.job || (this.shots.length && this.#isReady()))) {
                if (this.next && !(this.job && this.#isSoonOver(this.job))) {
                    this.next = null;
                    this.job = this.#jobOf(this.width, this.height, this.wanted, this.#firstLevel(this.width, this.height));
                }
                if (this.shots.length && this.#isReady() && !this.next && !(this.job && this.job.level === this.job.first && this.job.sample === 0))
                    this.#continueShot();
                else if (this.job)
                    this.#continue(this.job);
                await yieldToMessages();
            }
        } catch (error) {
            if (!this.gl.isContextLost())
                this.tell({ kind: 'error', message: error.message });
        }
        this.running = false;
    }

    #sumsOf(width, height) {
        const key = `${width} ${height} ${this.programs.mirrors}`;
        if (!this.sums.has(key))
            this.sums.set(key, new Sums(this.gl, width, height, this.sumFormat, this.programs.mirrors));
        return this.sums.get(key);
    }

    // A level begins with what the last one shows.
    #beginLevel(job) {
        const { level } = job, last = this.shown, { gl } = this;
        job.sums = this.#sumsOf(Math.ceil(job.width / level), Math.ceil(job.height / level));
        this.#beginSums(job, job.width / level, job.height / level);
        job.last = performance.now();
        this.shown = job.sums.shown;
        if (last && last !== this.shown)
            this.#copy(last, this.shown.framebuffer, this.shown.width, this.shown.height, false);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    #beginSums(job, width, height) {
        const { state, sums, wanted } = job, camera = fitted(state.camera, state.about.image, job.width, job.height);
        sums.sums.clear();
        job.frame = frameOf(camera, state.view, state.about.shaders, width, height, wanted);
        this.costs ??= this.#measureDraws(job);
        this.#beginSample(job);
    }

    #beginSample(job) { job.cut = new Tiles(this.costs, job.sums.width, job.sums.height); }

    #copy(from, framebuffer, width, height, flips) {
        const { gl } = this;
        gl.disable(gl.SCISSOR_TEST);
        gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from.framebuffer);
        gl.readBuffer(gl.COLOR_ATTACHMENT0);
        gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, framebuffer);
        gl.blitFramebuffer(0, 0, from.width, from.height, 0, flips ? height : 0, width, flips ? 0 : height, gl.COLOR_BUFFER_BIT, gl.LINEAR);
    }

    // Draws a tile; true: the job has all its samples.
    #continue(job) {
        if (!job.sums)
            this.#beginLevel(job);
        this.#drawTile(job);
        job.tiles++;
        const over = job.cut.isOver, now = performance.now();
        if (over) {
            job.sample++;
            this.#beginSample(job);
        }
        const done = job.level === 1 && job.sample >= job.wanted;
        if (over || now - job.last > (job.level < job.first || job.sample > 0 ? 100 : 500)) {
            job.last = now;
            this.#show(job);
            this.tell({ kind: 'frame', samples: job.level > 1 ? 1 / job.level ** 2 : job.sample || 0.25, wanted: job.wanted,
                elapsed: now - job.begun, width: job.width, height: job.height, time: job.state.time, done, number: job.state.number });
        }
        if (over && job.level > 1) {
            job.level = Math.min(job.level / 2, this.#firstLevel(job.width, job.height));
            job.sample = 0;
            job.sums = null;
        }
        if (done) {
            this.job = null;
            this.losses = 0;
        }
        return done;
    }

    // ---- drawing ----

    #drawTile(job) { job.cut.took(this.#timeTile(job, job.cut.next())); }

    // What draws cost by themselves.  Drivers compile at the first, which tells nothing.
    #measureDraws(job) {
        const [, ...times] = [0, 1, 2].map(() => this.#timeTile(job, { x: 0, y: 0, width: 1, height: 1 }));
        job.sums.sums.clear();
        return new Costs(Math.min(...times));
    }

    // Draws a tile, and waits until it is there.
    #timeTile(job, tile) {
        const { gl } = this, { shown } = job.sums, began = performance.now();
        this.#drawPasses(job, tile);
        shown.bind();
        this.#drawResolved(job);
        gl.readBuffer(gl.COLOR_ATTACHMENT0);
        gl.readPixels(tile.x, tile.y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        return performance.now() - began;
    }

    #drawPasses(job, { x, y, width, height }) {
        const { gl } = this, { sums, state, level, sample, frame } = job;
        const common = { ray_number: sample, light_count: state.view.lights.length, projection: projections.indexOf(state.camera.projection),
            from_middles: level > 1 ? 1 : 0, input_rows: 0, krs_rows: 1, krs_cells: 2, ends: 3, facings: 4, secondaries: 5,
            path_origins: 6, path_directions: 7, path_weights: 8 };
        gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.parameters);
        [this.inputs, ...this.tables].forEach((texture, unit) => this.#bindTexture(unit, texture));
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(x, y, width, height);
        for (let bounce = 0; bounce <= (sums.further ? mirroredSurfaces[level > 1 ? 0 : 1] : 0); bounce++) {
            const found = bounce ? sums.further : sums.first, shaded = sums.shaded[bounce % sums.shaded.length];
            sums.paths[(bounce + 1) % 2]?.textures.forEach((texture, i) => this.#bindTexture(6 + i, bounce ? texture : null));
            passes.forEach((pass, number) => {
                const program = this.programs[pass];
                gl.useProgram(program.program);
                if (program.frame !== frame || program.sample !== sample) { // else it has them
                    Object.assign(program, { frame, sample });
                    program.set(common);
                    program.set(frame, 'frame.');
                    program.set({ corner: [0, 0], extent: [sums.width, sums.height], offset: placeRay(sample, state.about.image.pixel_filter) }, 'work.');
                }
                program.set({ bounce });
                Object.values(found).forEach((layer, unit) => this.#bindTexture(3 + unit, unit < number ? layer.textures[0] : null));
                (found[pass] ?? shaded).bind();
                if (pass === 'shade') {
                    for (let i = 4; i < shaded.textures.length; i++)
                        gl.clearBufferfv(gl.COLOR, i, [0, 0, 0, 0]);
                    gl.enable(gl.BLEND);
                    gl.blendFunc(gl.ONE, gl.ONE);
                }
                gl.drawArrays(gl.TRIANGLES, 0, 3);
                gl.disable(gl.BLEND);
            });
        }
    }

    #bindTexture(unit, texture) {
        const { gl } = this;
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(gl.TEXTURE_2D, texture);
    }

    // Where the scissors let it.
    #drawResolved(job) {
        const { gl, resolve } = this, { sums, sample } = job, { image } = job.state.about;
        gl.useProgram(resolve.program);
        [...sums.sums.textures, sums.first.march.textures[0]].forEach((texture, unit) => this.#bindTexture(unit, texture));
        const reach = sample < 4 ? 2 : sample < 16 ? 1 : 0;
        resolve.set({ direct_sums: 0, scattered_sums: 1, mirrored_sums: 2, own_sums: 3, ends: 4, sums_size: [sums.width, sums.height],
            exposure: 2 ** image.exposure, balance: balanceOf(image.white_balance).flat(), tone_map: Math.max(toneMaps.indexOf(image.tone_map), 0), reach });
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    #show(job) {
        const { canvas } = this;
        if (canvas.width !== job.width || canvas.height !== job.height)
            Object.assign(canvas, { width: job.width, height: job.height });
        this.#copy(job.sums.shown, null, canvas.width, canvas.height, true);
    }

    // ---- pictures that are kept ----

    // Makes a picture of this size: its bytes, rows from the top, and where the first ray of each pixel ends.
    shoot({ width, height, samples }) {
        return new Promise((resolve, reject) => {
            this.shots.push({ width, height, samples, resolve, reject });
            this.#wake();
        });
    }

    #continueShot() {
        const [shot] = this.shots, { gl } = this, { width, height, samples } = shot;
        if (!shot.job) {
            shot.job = this.#jobOf(width, height, samples, 1);
            shot.job.sums = new Sums(gl, width, height, this.sumFormat, this.programs.mirrors);
            this.#beginSums(shot.job, width, height);
        }
        const { job } = shot;
        this.#drawTile(job);
        if (!job.cut.isOver)
            return;
        if (job.sample === 0)
            shot.rays = this.#readRays(job);
        this.#beginSample(job);
        if (++job.sample < samples)
            return;
        this.shots.shift();
        const bytes = new Uint8ClampedArray(4 * width * height);
        job.sums.shown.bind();
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        job.sums.free();
        shot.resolve({ bytes, rays: shot.rays });
    }

    // t, side, state and steps of each pixel's first ray.
    #readRays({ sums }) {
        const { gl } = this, rays = new Float32Array(4 * sums.width * sums.height);
        sums.first.march.bind();
        gl.readPixels(0, 0, sums.width, sums.height, gl.RGBA, gl.FLOAT, rays);
        return rays;
    }

    // Gives the memory of the card back until it is needed again.
    release() {
        this.released = true;
        if (!this.lost && this.losing) {
            this.ours = true;
            this.losing.loseContext();
        }
    }

    restore() {
        this.released = false;
        if (this.lost && this.ours)
            this.losing.restoreContext();
    }
}

const freePasses = programs => passes.forEach(pass => programs[pass].free());

// Tables that materials of several layers need.
async function fetchAlbedos() {
    const response = await fetch(new URL('albedos.bin', import.meta.url));
    return new Uint32Array(await response.arrayBuffer());
}

// A task of its own, after those that wait.
const { port1, port2 } = new MessageChannel();
const waiting = [];
port1.onmessage = () => waiting.shift()();
function yieldToMessages() {
    return new Promise(resolve => {
        waiting.push(resolve);
        port2.postMessage(null);
    });
}
