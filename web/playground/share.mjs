// share.mjs: a scene as a link.  What is shared stands in the fragment, which browsers send to no server.
//
// A fragment is `#1.` and what is shared as JSON, deflated, in base64url: the text, parameters that differ from their
// defaults, the camera and the time where somebody changed them.

const MARK = '1.';
// A text of a stranger may unpack to so many bytes, no more.
const MAX_BYTES = 4 << 20;

function toBase64url(bytes) {
    let binary = '';
    for (let i = 0; i < bytes.length; i += 0x8000)
        binary += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
    return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

function fromBase64url(text) {
    return Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), c => c.charCodeAt(0));
}

async function through(bytes, transform) {
    const reader = new Blob([bytes]).stream().pipeThrough(transform).getReader();
    const pieces = [];
    let length = 0;
    for (let next = await reader.read(); !next.done; next = await reader.read()) {
        pieces.push(next.value);
        length += next.value.length;
        if (length > MAX_BYTES) {
            await reader.cancel();
            throw new RangeError('the link holds more than a scene');
        }
    }
    return new Uint8Array(await new Blob(pieces).arrayBuffer());
}

const isNumbers = (value, count) =>
    Array.isArray(value) && (count === undefined || value.length === count) && value.every(Number.isFinite);

// A camera that sees something: it looks from one place to another.
const MAX_DISTANCE = 1e15;
function isCamera({ eye, target, up }) {
    const distance = isNumbers(eye, 3) && isNumbers(target, 3) ? Math.hypot(...eye.map((x, i) => x - target[i])) : 0;
    return distance > 0 && distance < MAX_DISTANCE && (up === undefined || isNumbers(up, 3) && Math.hypot(...up) > 0);
}

// What is of the right kind in what came with a link.
function checked(shared) {
    if (typeof shared?.text !== 'string')
        throw new TypeError('the link holds no scene');
    const { text, time, camera } = shared, result = { text };
    const parameters = Object.entries(shared.parameters ?? {}).filter(([, value]) => isNumbers(value));
    if (parameters.length > 0)
        result.parameters = Object.fromEntries(parameters);
    if (camera && isCamera(camera))
        result.camera = { eye: camera.eye, target: camera.target, ...(camera.up && { up: camera.up }) };
    if (Number.isFinite(time))
        result.time = time;
    return result;
}

export async function pack(shared) {
    const bytes = new TextEncoder().encode(JSON.stringify(checked(shared)));
    return `#${MARK}${toBase64url(await through(bytes, new CompressionStream('deflate-raw')))}`;
}

// Null: the fragment is not that of a link.  Throws where it is broken, or of another kind.
export async function unpack(fragment) {
    const packed = fragment.replace(/^#/, '');
    if (!/^\d+\./.test(packed))
        return null;
    try {
        if (!packed.startsWith(MARK))
            throw new TypeError('the link is of another kind');
        const bytes = await through(fromBase64url(packed.slice(MARK.length)), new DecompressionStream('deflate-raw'));
        return checked(JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes)));
    } catch (error) {
        throw new Error('This link is broken: a part of it may be missing.', { cause: error });
    }
}
