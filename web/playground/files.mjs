// files.mjs: meshes as files.  STL is byte for byte that of `krs mesh`.

// ---- STL ----

const STL_HEADER = 80, STL_TRIANGLE = 50;

function corners({ vertices, triangles }, triangle) {
    return [0, 1, 2].map(k => vertices.subarray(3 * triangles[3 * triangle + k], 3 * triangles[3 * triangle + k] + 3));
}

// Without numbers of vertices, those that are equal in single precision are one.
const areOne = (a, b) => a.every((number, k) => Math.fround(number) === Math.fround(b[k]));

function normalOf([a, b, c]) {
    const u = b.map((number, k) => number - a[k]), v = c.map((number, k) => number - a[k]);
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    return normal.map(number => (length > 0 ? number / length : 0));
}

export function stl(mesh) {
    const kept = [];
    for (let i = 0; i < mesh.triangles.length / 3; i++) {
        const at = corners(mesh, i);
        if (!areOne(at[0], at[1]) && !areOne(at[1], at[2]) && !areOne(at[2], at[0]))
            kept.push(at);
    }
    const bytes = new ArrayBuffer(STL_HEADER + 4 + STL_TRIANGLE * kept.length), file = new DataView(bytes);
    new TextEncoder().encodeInto('binary STL, made by krs', new Uint8Array(bytes));
    file.setUint32(STL_HEADER, kept.length, true);
    kept.forEach((at, i) => [normalOf(at), ...at].forEach((vector, row) => vector.forEach((number, k) =>
        file.setFloat32(STL_HEADER + 4 + STL_TRIANGLE * i + 12 * row + 4 * k, number, true))));
    return new Blob([bytes], { type: 'model/stl' });
}

// ---- GLB ----

const FLOAT = 5126, UNSIGNED_INT = 5125, UNSIGNED_SHORT = 5123, ARRAY = 34962, ELEMENTS = 34963;

// A file that grows: buffers one behind the other, each with its accessor.
class Gltf {
    constructor() {
        this.pieces = [];
        this.length = 0;
        this.json = { asset: { version: '2.0', generator: 'krs' }, scene: 0, scenes: [{ nodes: [] }], nodes: [], meshes: [],
                      materials: [], accessors: [], bufferViews: [], buffers: [{ byteLength: 0 }] };
    }

    add(list, item) { return this.json[list].push(item) - 1; }

    accessor(numbers, target, componentType, type, count, more) {
        const bytes = new Uint8Array(numbers.buffer), bufferView = this.add('bufferViews', {
            buffer: 0, byteOffset: this.length, byteLength: bytes.length, target });
        this.pieces.push(bytes);
        this.length += bytes.length;
        return this.add('accessors', { bufferView, componentType, type, count, ...more });
    }

    blob() {
        this.json.buffers[0].byteLength = this.length;
        let json = JSON.stringify(this.json);
        json = new TextEncoder().encode(json.padEnd(json.length + (4 - new TextEncoder().encode(json).length % 4) % 4));
        const head = (...words) => new Uint8Array(Uint32Array.from(words).buffer);
        return new Blob([head(0x46546c67, 2, 28 + json.length + this.length, json.length, 0x4e4f534a), json,
                         head(this.length, 0x004e4942), ...this.pieces], { type: 'model/gltf-binary' });
    }
}

const lookOf = ({ color, roughness, metallic }) => [...color, 1, metallic ?? 0, roughness];
const keyOf = look => look.map(number => Math.round(255 * number)).join(' ');

function material(name, look) {
    const [red, green, blue, alpha, metallicFactor, roughnessFactor] = look;
    return { name, pbrMetallicRoughness: { baseColorFactor: [red, green, blue, alpha], metallicFactor, roughnessFactor } };
}

function positions(gltf, vertices) {
    const numbers = Float32Array.from(vertices), min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    numbers.forEach((number, i) => {
        min[i % 3] = Math.min(min[i % 3], number);
        max[i % 3] = Math.max(max[i % 3], number);
    });
    return gltf.accessor(numbers, ARRAY, FLOAT, 'VEC3', numbers.length / 3, { min, max });
}

const indices = (gltf, triangles) => gltf.accessor(Uint32Array.from(triangles), ELEMENTS, UNSIGNED_INT, 'SCALAR', triangles.length);

// The middles of triangles, where the material of each is asked for.
export function middles({ vertices, triangles }) {
    const points = new Float64Array(triangles.length);
    for (let i = 0; i < triangles.length; i += 3)
        for (let k = 0; k < 3; k++)
            points[i + k] = (vertices[3 * triangles[i] + k] + vertices[3 * triangles[i + 1] + k] + vertices[3 * triangles[i + 2] + k]) / 3;
    return points;
}

// Each triangle has the material of its middle.
function inSteps(gltf, { name, mesh, hits }) {
    const groups = Map.groupBy(Array.from(hits, (hit, triangle) => ({ look: lookOf(hit), triangle })), ({ look }) => keyOf(look));
    const POSITION = positions(gltf, mesh.vertices);
    return [...groups.values()].map(members => ({
        attributes: { POSITION },
        indices: indices(gltf, members.flatMap(({ triangle }) => [...mesh.triangles.subarray(3 * triangle, 3 * triangle + 3)])),
        material: gltf.add('materials', material(name, members[0].look)),
    }));
}

// Colours change evenly from vertex to vertex.
function evenly(gltf, { name, mesh, hits }) {
    const looks = hits.map(lookOf), first = looks[0];
    const attributes = { POSITION: positions(gltf, mesh.vertices) };
    let look = first;
    if (!looks.every(other => keyOf(other) === keyOf(first))) {
        const colours = Uint16Array.from(looks.flatMap(other => other.slice(0, 4).map(number => Math.round(65535 * number))));
        attributes.COLOR_0 = gltf.accessor(colours, ARRAY, UNSIGNED_SHORT, 'VEC4', looks.length, { normalized: true });
        const mean = k => looks.reduce((sum, other) => sum + other[k], 0) / looks.length;
        look = [1, 1, 1, 1, mean(4), mean(5)];
    }
    return [{ attributes, indices: indices(gltf, mesh.triangles), material: gltf.add('materials', material(name, look)) }];
}

// Parts have a name, a mesh, and what is known at the middles of its triangles where materials change in steps, else at its vertices.
export function glb(parts) {
    const gltf = new Gltf();
    for (const part of parts) {
        const primitives = part.mesh.steps ? inSteps(gltf, part) : evenly(gltf, part);
        const mesh = gltf.add('meshes', { name: part.name, primitives });
        gltf.json.scenes[0].nodes.push(gltf.add('nodes', { name: part.name, mesh }));
    }
    return gltf.blob();
}
