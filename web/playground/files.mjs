// files.mjs: meshes as files.  STL is byte for byte that of `krs mesh`.

// ---- STL ----

const STL_HEADER = 80, STL_TRIANGLE = 50;

function cornersOf({ vertices, triangles }, triangle) {
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
        const at = cornersOf(mesh, i);
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
const INWARDS = 0.05, EVEN = Math.cos(Math.PI / 6); // part of the way from a corner to the middle; of normals at one vertex

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

const indices = (gltf, triangles) => gltf.accessor(Uint32Array.from(triangles), ELEMENTS, UNSIGNED_INT, 'SCALAR', triangles.length);

// The middles of triangles, where the material of each is asked for.
export function middles({ vertices, triangles }) {
    const points = new Float64Array(triangles.length);
    for (let i = 0; i < triangles.length; i += 3)
        for (let k = 0; k < 3; k++)
            points[i + k] = (vertices[3 * triangles[i] + k] + vertices[3 * triangles[i + 1] + k] + vertices[3 * triangles[i + 2] + k]) / 3;
    return points;
}

// Points in triangles near their corners, where the normal of each is asked for: at an edge there are several.
export function corners(mesh) {
    const { vertices, triangles } = mesh, points = new Float64Array(3 * triangles.length), middle = middles(mesh);
    for (let i = 0; i < triangles.length; i++)
        for (let k = 0; k < 3; k++)
            points[3 * i + k] = (1 - INWARDS) * vertices[3 * triangles[i] + k] + INWARDS * middle[3 * Math.floor(i / 3) + k];
    return points;
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// A vertex for each normal at each point of a mesh: corners there of which normals differ by little have their mean.  A normal
// that is not that of the triangle, as where another part touches, does not count.
function withNormals(mesh, normals) {
    const { vertices, triangles } = mesh, there = Array.from({ length: vertices.length / 3 }, () => []);
    const made = { of: [], sums: [], triangles: new Uint32Array(triangles.length) };
    triangles.forEach((vertex, corner) => {
        const asked = normals.subarray(3 * corner, 3 * corner + 3), face = normalOf(cornersOf(mesh, Math.floor(corner / 3)));
        const own = dot(asked, face) > 0.5 ? asked : face.some(Boolean) ? face : [0, 0, 1];
        let found = there[vertex].find(({ first }) => dot(first, own) > EVEN);
        if (!found) {
            found = { first: own, number: made.of.push(vertex) - 1 };
            made.sums.push(0, 0, 0);
            there[vertex].push(found);
        }
        own.forEach((number, k) => { made.sums[3 * found.number + k] += number; });
        made.triangles[corner] = found.number;
    });
    return made;
}

function attributesOf(gltf, { vertices }, { of, sums }) {
    const places = new Float32Array(3 * of.length), normals = new Float32Array(3 * of.length);
    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    of.forEach((vertex, i) => {
        const length = Math.hypot(...sums.slice(3 * i, 3 * i + 3));
        for (let k = 0; k < 3; k++) {
            places[3 * i + k] = vertices[3 * vertex + k];
            normals[3 * i + k] = sums[3 * i + k] / length;
            min[k] = Math.min(min[k], places[3 * i + k]);
            max[k] = Math.max(max[k], places[3 * i + k]);
        }
    });
    return { POSITION: gltf.accessor(places, ARRAY, FLOAT, 'VEC3', of.length, { min, max }),
             NORMAL: gltf.accessor(normals, ARRAY, FLOAT, 'VEC3', of.length) };
}

// Each triangle has the material of its middle.
function inSteps(gltf, { name, hits }, { triangles }, attributes) {
    const groups = Map.groupBy(Array.from(hits, (hit, triangle) => ({ look: lookOf(hit), triangle })), ({ look }) => keyOf(look));
    return [...groups.values()].map(members => ({
        attributes, indices: indices(gltf, members.flatMap(({ triangle }) => [...triangles.subarray(3 * triangle, 3 * triangle + 3)])),
        material: gltf.add('materials', material(name, members[0].look)),
    }));
}

// Colours change evenly from vertex to vertex.
function evenly(gltf, { name, hits }, { of, triangles }, attributes) {
    const looks = hits.map(lookOf), first = looks[0];
    let look = first;
    if (!looks.every(other => keyOf(other) === keyOf(first))) {
        const colours = Uint16Array.from(of.flatMap(vertex => looks[vertex].slice(0, 4).map(number => Math.round(65535 * number))));
        attributes.COLOR_0 = gltf.accessor(colours, ARRAY, UNSIGNED_SHORT, 'VEC4', of.length, { normalized: true });
        const mean = k => looks.reduce((sum, other) => sum + other[k], 0) / looks.length;
        look = [1, 1, 1, 1, mean(4), mean(5)];
    }
    return [{ attributes, indices: indices(gltf, triangles), material: gltf.add('materials', material(name, look)) }];
}

// Parts have a name, a mesh, normals at its corners, and what is known at the middles of its triangles where materials change
// in steps, else at its vertices.
export function glb(parts) {
    const gltf = new Gltf();
    for (const part of parts) {
        const points = withNormals(part.mesh, part.normals), attributes = attributesOf(gltf, part.mesh, points);
        const primitives = (part.mesh.steps ? inSteps : evenly)(gltf, part, points, attributes);
        const mesh = gltf.add('meshes', { name: part.name, primitives });
        gltf.json.scenes[0].nodes.push(gltf.add('nodes', { name: part.name, mesh }));
    }
    return gltf.blob();
}
