// view.mjs: <krs-view> (krs.d.ts): a canvas, a camera that a user moves, and a worker that draws (painter.mjs).
import { Scene, compile, located, startWorker } from './compiler.mjs';
import { basisOf, fitted, rayOf } from './frame.mjs';

const style = `
:host { display: block; position: relative; width: 640px; height: 360px; overflow: hidden; background: #202226; }
:host([hidden]) { display: none; }
canvas { display: block; width: 100%; height: 100%; touch-action: none; }
:host([controls]) canvas { cursor: grab; }
p { position: absolute; left: 0; bottom: 0; margin: 0; padding: 2px 8px; font: 12px/1.5 sans-serif; color: #fff; background: #0008; }
p:empty { display: none; }`;

const sub = (a, b) => a.map((x, i) => x - b[i]), along = (a, s, b) => a.map((x, i) => x + s * b[i]);

// What is not drawn as `krs render` draws it.
function notes({ about, image, camera, name }) {
    const { shaders } = about, missing = [];
    if (about.too_large)
        missing.push('no shader is made of so large a scene');
    if (shaders.media && image.integrator !== 'path')
        missing.push('what is inside of glass, and light through it');
    if (shaders.volumes && image.integrator !== 'path' && image.integrator !== 'direct')
        missing.push('media');
    if (image.integrator === 'path' || image.integrator === 'direct')
        missing.push(`the light of the integrator "${image.integrator}"`);
    if (shaders.sky_map)
        missing.push('the picture of the sky');
    if (camera?.shutter?.[0] !== camera?.shutter?.[1])
        missing.push('motion blur');
    if (camera?.eyes > 0)
        missing.push('two eyes');
    return missing.length ? `Not shown here: ${missing.join(', ')}. See \`krs render ${name}\`.` : '';
}

export class KrsViewElement extends HTMLElement {
    static observedAttributes = ['src', 'camera', 'autoplay', 'samples'];

    #canvas;
    #note;
    #painter = null;
    #scene = null;
    #camera = null;    // the user's, or that of a property; null: the scene's
    #cameraName = null;
    #shown = null;     // the camera of the last state
    #playing = false;
    #time = 0;
    #clock = 0;        // when the time was that
    #asking = false;   // a state is being made
    #dirty = null;     // 'scene' or 'state': what has changed since
    #seen;             // version of the tables that the painter has
    #sent = null;      // the last state that it was sent
    #waiting = new Map();
    #shots = 0;
    #number = 0;       // of the last state that the painter was sent
    #first = 0;        // of the first state of the scene
    #done = null;      // resolves `ready`
    #settled = false;  // it has
    #changed = event => this.#update(event.detail === 'structure' ? 'scene' : 'state');
    #resizing = new ResizeObserver(() => this.#resize());

    constructor() {
        super();
        const root = this.attachShadow({ mode: 'open' });
        root.innerHTML = `<style>${style}</style><canvas></canvas><p part="note"></p>`;
        this.#canvas = root.querySelector('canvas');
        this.#note = root.querySelector('p');
        this.#listen();
        this.#restartReady();
    }

    // ---- the life of the element ----

    async connectedCallback() {
        await located;
        if (this.isConnected)
            this.#connect();
    }

    #connect() {
        if (!this.#painter)
            this.#start();
        else
            this.#paint({ call: 'restore' });
        this.#resizing.observe(this);
        this.#resize();
        const inside = this.querySelector('script[type="text/krs"]');
        if (inside && !this.#scene)
            this.#begin(inside.textContent, { name: this.getAttribute('name') ?? 'scene.krs', base: this.baseURI });
    }

    disconnectedCallback() {
        this.#resizing.disconnect();
        this.#paint({ call: 'release' });
    }

    attributeChangedCallback(name, _, value) {
        if (name === 'src' && value)
            this.#load(value);
        else if (name === 'camera')
            this.camera = value;
        else if (name === 'autoplay')
            this.playing = value !== null;
        else if (name === 'samples')
            this.#paint({ call: 'samples', samples: this.samples });
    }

    #start() {
        if (!this.#canvas.transferControlToOffscreen) {
            this.#note.textContent = 'This browser cannot draw in a worker.';
            return;
        }
        this.#painter = startWorker('painter.mjs');
        this.#painter.onmessage = ({ data }) => this.#hear(data);
        this.#painter.onerror = event => this.#fail(event.message);
        const canvas = this.#canvas.transferControlToOffscreen();
        this.#painter.postMessage({ call: 'canvas', canvas }, [canvas]);
        this.#paint({ call: 'samples', samples: this.samples });
        if (this.#scene?.ok)
            this.#update('scene');
    }

    #paint(message, transfer = []) { this.#painter?.postMessage(message, transfer); }

    #hear(message) {
        if (message.kind === 'frame')
            this.#heardFrame(message);
        else if (message.kind === 'shot') {
            const { resolve, reject } = this.#waiting.get(message.id);
            this.#waiting.delete(message.id);
            if (message.error === undefined)
                resolve(message.blob ?? message.rays);
            else
                reject(new Error(message.error));
        } else if (message.kind === 'error')
            this.#fail(message.message);
    }

    #fail(message) {
        this.#note.textContent = `No picture: ${message}`;
        this.dispatchEvent(new CustomEvent('krs-error', { detail: message }));
    }

    #heardFrame({ kind, done, number, ...frame }) {
        if (number < this.#first)
            return; // of a scene that is no more
        this.dispatchEvent(new CustomEvent('krs-frame', { detail: frame }));
        if (done && number === this.#number)
            this.#done();
        if (this.#playing && frame.samples > 0 && !this.#asking)
            this.#update('state');
    }

    #restartReady() {
        if (this.#done === null || this.#settled) {
            this.#settled = false;
            this.ready = new Promise(resolve => { this.#done = () => { this.#settled = true; resolve(); }; });
        }
    }

    // ---- properties ----

    get src() { return this.getAttribute('src'); }
    set src(src) { src === null ? this.removeAttribute('src') : this.setAttribute('src', src); }
    get controls() { return this.hasAttribute('controls'); }
    set controls(on) { this.toggleAttribute('controls', on); }
    get autoplay() { return this.hasAttribute('autoplay'); }
    set autoplay(on) { this.toggleAttribute('autoplay', on); }
    get samples() { return Math.max(Number(this.getAttribute('samples') ?? 64) | 0, 1); }
    set samples(samples) { this.setAttribute('samples', samples); }

    get scene() { return this.#scene; }
    set scene(scene) {
        if (scene === this.#scene)
            return;
        this.#scene?.removeEventListener('change', this.#changed);
        this.#scene = scene;
        this.#seen = undefined;
        this.#camera = this.#sent = null;
        scene?.addEventListener('change', this.#changed);
        if (scene?.ok)
            this.#update('scene');
    }

    get camera() { return this.#camera ?? this.#shown ?? this.#named(this.#scene?.cameras ?? []) ?? null; }
    set camera(camera) {
        this.#cameraName = typeof camera === 'string' ? camera : camera === null ? null : this.#cameraName;
        this.#camera = camera && typeof camera === 'object' ? { ...this.camera, ...camera } : null;
        this.#moveCamera();
    }

    #named(cameras) { return cameras.find(camera => camera.name === this.#cameraName) ?? cameras[0]; }

    get time() { return this.#playing ? this.#time + (performance.now() - this.#clock) / 1000 : this.#time; }
    set time(seconds) {
        this.#time = seconds;
        this.#clock = performance.now();
        this.#update('state');
    }

    get playing() { return this.#playing; }
    set playing(playing) {
        this.#time = this.time;
        this.#clock = performance.now();
        this.#playing = playing;
        this.#update('state');
    }

    // ---- scenes ----

    async #load(src) {
        const place = new URL(src, this.baseURI), response = await fetch(place).catch(error => ({ ok: false, statusText: error.message }));
        if (this.src !== src)
            return;
        if (response.ok)
            await this.#begin(await response.text(), { name: decodeURIComponent(place.pathname.split('/').pop()), base: place });
        else
            this.#fail(`${src}: ${response.statusText || response.status}`);
    }

    // Shows a text that stands in the page, or is named there.
    async #begin(text, options) {
        const root = this.getAttribute('root');
        await this.update(text, { ...options, root: new URL(root ?? '.', root === null ? options.base : this.baseURI) }).catch(error => this.#fail(error.message));
    }

    async update(text, options) {
        let update;
        if (this.#scene && !options)
            update = await this.#scene.update(text);
        else {
            const scene = await compile(text, options);
            update = { ok: scene.ok, diagnostics: scene.diagnostics, change: scene.ok ? 'structure' : 'nothing' };
            if (scene.ok || !this.#scene)
                this.scene = scene;
        }
        this.dispatchEvent(new CustomEvent('krs-diagnostics', { detail: update }));
        return update;
    }

    // Something that is seen has changed: of changes that come while a state is made, the last is shown.
    #update(what) {
        this.#restartReady();
        this.#dirty = what === 'scene' || this.#dirty === 'scene' ? 'scene' : 'state';
        if (what === 'scene')
            this.#first = this.#number + 1;
        if (!this.#asking && this.#painter && this.#scene?.ok)
            this.#send();
    }

    async #send() {
        this.#asking = true;
        try {
            while (this.#dirty)
                await this.#sendOnce();
        } catch (error) {
            this.#fail(error.message);
        }
        this.#asking = false;
    }

    async #sendOnce() {
        const scene = this.#scene, what = this.#dirty, time = scene.animated ? this.time : 0;
        this.#dirty = null;
        const text = what === 'scene' ? await scene.pictureText() : null;
        const { parameters, values, tables, view } = await scene.state(time, text ? undefined : this.#seen);
        const { image, shaders } = scene.about;
        this.#seen = tables.version;
        this.#shown = this.#named(view.cameras);
        this.#sent = { parameters, values, tables: { version: tables.version }, view, about: { image, shaders }, time };
        const state = this.#stateAt({ tables });
        this.#paint(text ? { call: 'scene', scene: { text, about: scene.about }, state } : { call: 'state', state },
            tables.rows ? [tables.rows.buffer, tables.cells.buffer] : []);
    }

    // The last state with the present camera.
    #stateAt(more) {
        const { about, image, name } = this.#scene, camera = this.#camera ?? this.#shown;
        this.#note.textContent = notes({ about, image, camera, name });
        return { ...this.#sent, camera, number: ++this.#number, ...more };
    }

    // A camera alone needs nothing of the compiler.
    #moveCamera() {
        if (!this.#sent || this.#asking) {
            this.#update('state');
            return;
        }
        this.#restartReady();
        this.#shown = this.#named(this.#sent.view.cameras);
        this.#paint({ call: 'state', state: this.#stateAt() });
    }

    // ---- pictures ----

    #resize() {
        const ratio = globalThis.devicePixelRatio ?? 1, { width, height } = this.getBoundingClientRect();
        if (width && height)
            this.#paint({ call: 'size', width: Math.max(Math.round(width * ratio), 1), height: Math.max(Math.round(height * ratio), 1) });
        this.#restartReady();
    }

    #shoot(width, height, samples, type) {
        const id = ++this.#shots;
        return new Promise((resolve, reject) => {
            if (!this.#painter)
                throw new Error('the view is not in a page, or its browser cannot draw');
            this.#waiting.set(id, { resolve, reject });
            this.#paint({ call: 'shoot', id, width, height, samples, type });
        });
    }

    snapshot(width = this.#canvas.clientWidth, height = this.#canvas.clientHeight, type = 'image/png') {
        return this.#shoot(width, height, this.samples, type);
    }

    async rays(width, height) { return this.#shoot(width, height, 1, 'rays'); }

    async pick(x, y) {
        const box = this.#canvas.getBoundingClientRect(), camera = this.camera;
        if (!this.#scene?.ok || !camera || camera.projection === 'panorama')
            return null;
        const { origin, direction } = rayOf(this.#fitted(camera), box.width, box.height, 2 * (x - box.left) / box.width - 1, 1 - 2 * (y - box.top) / box.height);
        const [hit] = await this.#scene.raycast([origin], [direction], { time: this.#scene.animated ? this.time : 0 });
        return hit.hit ? hit : null;
    }

    // ---- the user's camera ----

    #move(camera) {
        this.#camera = camera;
        this.dispatchEvent(new CustomEvent('krs-camera', { detail: camera }));
        this.#moveCamera();
    }

    // Turns about the target, by parts of the height of the view: to the right about what is up.
    #turn(right, down) {
        const { camera } = this, { eye, target, up } = camera, basis = basisOf(camera), away = sub(eye, target);
        const axis = up.map(x => x / Math.hypot(...up)), height = axis.reduce((sum, x, i) => sum + x * away[i], 0);
        const rise = Math.asin(Math.max(-1, Math.min(1, height / basis.distance)));
        const tilt = Math.max(-1.55, Math.min(1.55, rise + Math.PI * down)) - rise;
        // Tilting is about what is to the right, turning about what is up.
        this.#move({ ...camera, eye: along(target, 1, rotated(rotated(away, basis.right, -tilt), axis, -2 * Math.PI * right)) });
    }

    #shift(right, down) {
        const { camera } = this, basis = basisOf(camera), size = this.#sizeAtTarget(camera, basis);
        const by = basis.right.map((r, i) => -right * size * r + down * size * basis.up[i]);
        this.#move({ ...camera, eye: along(camera.eye, 1, by), target: along(camera.target, 1, by) });
    }

    // The camera by which the picture is drawn.
    #fitted(camera) { return fitted(camera, this.#scene.image, this.#canvas.clientWidth, this.#canvas.clientHeight); }

    #sizeAtTarget(given, basis) {
        const camera = this.#fitted(given);
        return camera.projection === 'orthographic' ? camera.height : 2 * Math.tan(camera.fov / 2) * basis.distance;
    }

    #zoom(factor) {
        const { camera } = this, { eye, target } = camera;
        this.#move({ ...camera, eye: along(target, factor, sub(eye, target)), height: camera.height * factor });
    }

    #listen() {
        const fingers = new Map(), canvas = this.#canvas;
        canvas.addEventListener('pointerdown', event => {
            if (!this.controls || !this.camera)
                return;
            fingers.set(event.pointerId, [event.clientX, event.clientY]);
            canvas.setPointerCapture(event.pointerId);
        });
        canvas.addEventListener('pointermove', event => {
            const last = fingers.get(event.pointerId), height = canvas.clientHeight;
            if (!last || !this.camera)
                return;
            const now = [event.clientX, event.clientY], [right, down] = [(now[0] - last[0]) / height, (now[1] - last[1]) / height];
            if (fingers.size === 2) {
                const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
                const gap = place => Math.hypot(place[0] - other[0], place[1] - other[1]);
                this.#zoom(gap(last) / Math.max(gap(now), 1));
                this.#shift(right / 2, down / 2);
            } else if (event.shiftKey || event.buttons & 6)
                this.#shift(right, down);
            else
                this.#turn(right, down);
            fingers.set(event.pointerId, now);
        });
        for (const type of ['pointerup', 'pointercancel'])
            canvas.addEventListener(type, event => fingers.delete(event.pointerId));
        canvas.addEventListener('contextmenu', event => this.controls && event.preventDefault());
        canvas.addEventListener('wheel', event => {
            if (!this.controls || !this.camera)
                return;
            event.preventDefault();
            this.#zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.0015));
        }, { passive: false });
        canvas.addEventListener('dblclick', () => this.controls && (this.camera = null));
    }
}

// Rodrigues' formula: v turned about a unit axis.
function rotated(v, axis, angle) {
    const c = Math.cos(angle), s = Math.sin(angle), d = axis.reduce((sum, a, i) => sum + a * v[i], 0);
    const cross = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
    return v.map((x, i) => x * c + cross[i] * s + axis[i] * d * (1 - c));
}

export { Scene };
