// frame.mjs: what shaders know of a camera: the block `Frame` of runtime/shared/blocks.h, as runtime/tracer/view.c fills it in.
const unbounded = 1e18, horizon = 1e4, error = 0.25, maxSteps = 4096, usualShape = 1280 / 720;
export const projections = ['perspective', 'orthographic', 'panorama'];

const sub = (a, b) => a.map((x, i) => x - b[i]), scale = (a, s) => a.map(x => x * s), length = a => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => scale(a, 1 / length(a));

// Right, up and forward, orthonormal; and how far the target is.
export function basisOf(camera) {
    const ahead = sub(camera.target, camera.eye), distance = length(ahead), forward = unit(ahead);
    let right = cross(forward, camera.up);
    if (!(length(right) > 1e-9 * length(camera.up))) {
        const other = [0, 0, 0];
        other[Math.abs(forward[2]) < 0.9 ? 2 : 0] = -1;
        right = cross(forward, other);
    }
    right = unit(right);
    return { right, up: cross(right, forward), forward, distance };
}

// The camera of a picture of this size: where it is narrower than the scene's image, as much is seen to the sides.
export function fitted(camera, image, width, height) {
    const shape = image.width > 0 ? image.width / image.height : usualShape, rise = shape * height / width;
    return rise > 1 ? { ...camera, fov: 2 * Math.atan(rise * Math.tan(camera.fov / 2)), height: rise * camera.height } : camera;
}

// Half the extent of the picture: at distance 1 in perspective.
function extentOf(camera, width, height) {
    const half = camera.projection === 'perspective' ? Math.tan(camera.fov / 2)
        : camera.projection === 'orthographic' ? camera.height / 2 : 1;
    return [camera.projection === 'panorama' ? 1 : half * width / height, half];
}

// The ray through a place of the picture, which goes from -1 to 1 to the right and upwards.
export function rayOf(camera, width, height, x, y) {
    const { right, up, forward } = basisOf(camera), extent = extentOf(camera, width, height);
    const beside = right.map((r, i) => extent[0] * x * r + extent[1] * y * up[i]);
    const fans = camera.projection === 'perspective' ? 1 : 0;
    return { origin: camera.eye.map((e, i) => e + (1 - fans) * beside[i]), direction: forward.map((f, i) => f + fans * beside[i]) };
}

// The diagonal of a box over the axes along which it is bounded.
const sizeOf = (low, high) => length(low.map((l, i) => (isFinite(l) && isFinite(high[i]) ? Math.max(high[i] - l, 0) : 0)));

function ends(camera, low, high, distance) {
    const size = sizeOf(low, high), bounded = low.every(isFinite) && high.every(isFinite), scope = Math.max(size, distance);
    const sides = low.map((l, i) => Math.max(Math.abs(l - camera.eye[i]), Math.abs(high[i] - camera.eye[i])));
    const reach = 0.15 * (bounded ? size : size > 0 ? Math.min(size, distance) : distance);
    return {
        farthest: bounded ? 2.1 * length(sides) + 2 * camera.height : horizon * scope,
        occlusion_reach: reach > 0 ? reach : 0.15 * distance,
    };
}

// `box` has low and high; `samples` are those of a pixel in all.
export function frameOf(camera, { sky, fog }, box, width, height, samples) {
    const { right, up, forward, distance } = basisOf(camera), extent = extentOf(camera, width, height);
    const { low, high } = box, finite = [...low, ...high, ...camera.eye].filter(isFinite);
    const margin = 1e-4 * sizeOf(low, high) + 1e-6 * Math.max(...finite.map(Math.abs));
    const bound = x => Math.min(Math.max(x, -unbounded), unbounded);
    const pixel = 2 * extent[1] / height, { eye, aperture, focus, shift } = camera;
    return {
        eye, right: [...scale(right, extent[0]), 0], up: [...scale(up, extent[1]), 0], forward: [...forward, 0],
        low: [...low.map(x => bound(x - margin)), 0], high: [...high.map(x => bound(x + margin)), 0],
        zenith: [...sky.zenith, 0], horizon: [...sky.horizon, 0], ground: [...sky.ground, 0],
        fog: [...fog.color, fog.density], fog_level: [fog.fall, fog.base, 0, 0], size: [width, height],
        pixel_base: camera.projection === 'orthographic' ? pixel : 0,
        pixel_slope: camera.projection === 'orthographic' ? 0 : camera.projection === 'panorama' ? Math.PI / height : pixel,
        ...ends(camera, low, high, distance), error, normal_reach: samples > 1 ? 0.5 : 0.7, max_steps: maxSteps,
        lens: [aperture / extent[0], aperture / extent[1], 1 / (focus > 0 ? focus : distance), camera.blades >= 3 ? camera.blades : 0],
        shift: [2 * shift[0], 2 * shift[1], 0, 0],
    };
}

// ---- lights ----

const positional = 1, castsShadows = 2, spot = 4, firstType = 8, lightRows = 4;

// The rows of lights, as runtime/tracer/rendering_lights.c fills them in.
export function lightRowsOf(lights) {
    const numbers = new Float32Array(4 * lightRows * Math.max(lights.length, 1)), words = new Uint32Array(numbers.buffer);
    lights.forEach((light, number) => {
        const rectangle = light.type === 1, at = 4 * lightRows * number;
        const [across, along] = rectangle ? scale(light.size, 0.5) : [1, 1];
        const radius = rectangle ? Math.sqrt(light.size[0] * light.size[1] / Math.PI) : light.softness;
        const kind = (light.positional ? positional : 0) | (light.shadow ? castsShadows : 0) | (light.spot ? spot : 0) | (firstType * light.type);
        numbers.set([...light.vector, radius, ...light.color], at);
        words[at + 7] = kind;
        numbers.set([...scale(light.right, across), Math.cos(0.5 * light.angle * (1 - light.edge))], at + 8);
        numbers.set([...scale(light.up, along), Math.cos(0.5 * light.angle)], at + 12);
    });
    return words;
}
