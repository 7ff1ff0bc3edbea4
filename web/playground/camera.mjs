// camera.mjs: the camera by keys, and whether somebody moved it.
const TURN = Math.PI / 24, NEARER = 1.1;

const minus = (a, b) => a.map((number, k) => number - b[k]);
const plusTimes = (a, s, b) => a.map((number, k) => number + s * b[k]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => a.map(number => number / Math.hypot(...a));

// A vector turned about a unit axis.
function turned(v, axis, angle) {
    const along = dot(axis, v) * (1 - Math.cos(angle)), across = cross(axis, v);
    return v.map((number, k) => number * Math.cos(angle) + across[k] * Math.sin(angle) + axis[k] * along);
}

// The camera goes around its target.
function orbit({ eye, target, up }, sideways, upwards) {
    const upright = unit(up), away = turned(minus(eye, target), upright, sideways);
    const side = unit(cross(upright, away)), tilted = turned(away, side, -upwards);
    // It stays short of the pole, where it would turn over.
    const steep = Math.abs(dot(unit(tilted), upright)) > 0.995;
    return { target, up, eye: plusTimes(target, 1, steep ? away : tilted) };
}

const keys = {
    ArrowLeft: camera => orbit(camera, -TURN, 0),
    ArrowRight: camera => orbit(camera, TURN, 0),
    ArrowUp: camera => orbit(camera, 0, TURN),
    ArrowDown: camera => orbit(camera, 0, -TURN),
    '+': ({ eye, target, up }) => ({ target, up, eye: plusTimes(target, 1 / NEARER, minus(eye, target)) }),
    '-': ({ eye, target, up }) => ({ target, up, eye: plusTimes(target, NEARER, minus(eye, target)) }),
};
keys['='] = keys['+'];

export class Camera {
    // Where it was moved to: null where it is the scene's.
    moved = null;

    constructor(view, { moved }) {
        this.view = view;
        this.told = moved;
        view.addEventListener('krs-camera', ({ detail }) => this.#take(detail));
        view.addEventListener('keydown', event => this.#key(event));
        view.addEventListener('dblclick', () => this.move(null));
    }

    move(place) {
        this.view.camera = null;
        if (place)
            this.view.camera = place;
        this.#take(place);
    }

    #take(place) {
        this.moved = place && { eye: [...place.eye], target: [...place.target], ...(place.up && { up: [...place.up] }) };
        this.told();
    }

    #key(event) {
        if (event.ctrlKey || event.metaKey || event.altKey)
            return;
        if (event.key === 'Home')
            this.move(null);
        else if (keys[event.key] && this.view.camera)
            this.move(keys[event.key](this.view.camera));
        else
            return;
        event.preventDefault();
    }
}
