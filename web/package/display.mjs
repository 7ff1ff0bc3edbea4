// display.mjs: how a picture is shown, and where its rays go: white balance and pixel filters, by the numbers of
// runtime/display/white_balance.c and runtime/tracer/pixel_filter.c.

// ---- white balance ----

const times = (a, v) => a.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const transposed = a => a[0].map((_, i) => a.map(row => row[i]));
const product = (a, b) => transposed(transposed(b).map(column => times(a, column)));

function inverse(a) {
    const cofactor = (i, j) => a[(j + 1) % 3][(i + 1) % 3] * a[(j + 2) % 3][(i + 2) % 3] - a[(j + 1) % 3][(i + 2) % 3] * a[(j + 2) % 3][(i + 1) % 3];
    const out = a.map((_, i) => a.map((_, j) => cofactor(i, j))), determinant = a[0].reduce((sum, x, j) => sum + x * out[j][0], 0);
    return out.map(row => row.map(x => x / determinant));
}

// u, v (CIE 1960) of a black body (Krystek 1985).
const blackBody = t => [
    (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t),
    (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t)];

// The white of such light as X, Y, Z with Y = 1; a tint is across the curve of black bodies, to its green side.
function whiteOf(kelvins, tint) {
    const [u, v] = blackBody(kelvins), hotter = blackBody(1.001 * kelvins), along = [hotter[0] - u, hotter[1] - v], step = tint / 3000 / Math.hypot(...along);
    const x = u + step * along[1], y = v - step * along[0];
    return [1.5 * x / y, 1, (2 - 0.5 * x) / y - 5];
}

const xyzOfRgb = [[0.4123907993, 0.3575843394, 0.1804807884], [0.2126390059, 0.7151686788, 0.0721923154], [0.0193308187, 0.1191947798, 0.9505321522]];
const bradford = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

// Three rows, by which linear Rec.709 colours are multiplied so that such light is white; 0 kelvins change nothing.
export function balanceOf([kelvins, tint]) {
    if (!(kelvins > 0))
        return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const from = times(bradford, whiteOf(kelvins, tint)), to = times(bradford, times(xyzOfRgb, [1, 1, 1]));
    const cones = product(bradford, xyzOfRgb);
    return product(inverse(cones), cones.map((row, i) => row.map(x => x * to[i] / from[i])));
}

// ---- pixel filters ----

const reach = 1.5, parts = 3000; // in pixels; steps of the sums
// Weights by the place in the filter, from -1 to 1.
const weights = {
    gaussian: x => Math.exp(-2 * (reach * x) ** 2) - Math.exp(-2 * reach ** 2),
    'blackman-harris': x => 0.35875 + 0.48829 * Math.cos(Math.PI * x) + 0.14128 * Math.cos(2 * Math.PI * x) + 0.01168 * Math.cos(3 * Math.PI * x),
};

// Places within a pixel whose density is a filter's weight: what part of the weight lies before each step.
const sums = {};
function sumsOf(filter) {
    if (sums[filter])
        return sums[filter];
    const found = new Float64Array(parts + 1);
    for (let i = 0; i < parts; i++)
        found[i + 1] = found[i] + weights[filter](2 * (i + 0.5) / parts - 1);
    return sums[filter] = found.map(sum => sum / found[parts]);
}

function placeIn(filter, part) {
    const all = weights[filter] && sumsOf(filter);
    if (!all)
        return part; // a box
    const after = Math.max(all.findIndex(sum => sum > part), 1), before = all[after - 1];
    return 0.5 + reach * (2 * (after - 1 + (part - before) / (all[after] - before)) / parts - 1);
}

// The offset of a ray within its pixel (place_ray in runtime/tracer/plan.c); the first goes through the middle.
export const placeRay = (ray, filter) => [0.75487766624669276, 0.56984029099805327].map(step => placeIn(filter, (0.5 + step * ray) % 1));
