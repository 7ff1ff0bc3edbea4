// export.mjs KRS FOLDER [SCREENSHOTS]: what `krs export` writes draws in Chromium, and hits where `krs query` does.
//
// A module for three.js gives its material to a stand-in for that: what three.js puts before the text is put there.
// A file for Shadertoy is drawn as its page would do it; then a main of the test stores how far its rays go.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { launch } from './browser.mjs';

const [krs, folder, shots] = process.argv.slice(2);
const width = 96, height = 54;
let failed = 0, count = 0;
const ok = (good, what, why = '') => {
    console.log(`${good ? 'ok' : 'not ok'} ${++count} - ${what}`);
    if (!good)
        console.log(`# ${why}`.replaceAll('\n', '\n# '));
    failed += !good;
};
const run = (...args) => spawnSync(krs, args, { encoding: 'utf8', maxBuffer: 1 << 28 });

const header = '#version 300 es\nprecision highp float; precision highp int;\nuniform vec3 iResolution; uniform float iTime; uniform int iFrame; uniform vec4 iMouse; out vec4 krs_out;\n';
const toy = '\nvoid main() { mainImage(krs_out, gl_FragCoord.xy); }';
const reach = `
uniform vec3 krs_look[4]; // eye, ahead, right, up: of the test
void main()
{
    krs_set_parameters();
    krs_prepare();
    vec2  plane = 2.0 * gl_FragCoord.xy / iResolution.xy - 1.0;
    float t, pixel = 2.0 * length(krs_look[3]) / iResolution.y;
    vec3  direction = normalize(krs_look[1] + plane.x * krs_look[2] + plane.y * krs_look[3]);
    bool  hit = krs_trace(krs_look[0], direction, 0.0, KRS_FARTHEST, pixel, t);
    krs_out = vec4(hit ? t : -1.0, krs_distance(krs_look[0]), 0.0, 1.0);
}`;

// What a module makes of a library that keeps what it is given.
class Kept { constructor(...given) { this.given = given; this.value = given[0]; } }
const standIn = { GLSL3: '300 es', RGBAFormat: 'RGBA', FloatType: 'FLOAT', RGIntegerFormat: 'RG_INTEGER', UnsignedIntType: 'UNSIGNED_INT',
    ...Object.fromEntries(['Vector2', 'Vector4', 'ShaderMaterial', 'BufferAttribute', 'DataTexture'].map(name => [name, class extends Kept {}])),
    Matrix4: class { }, Mesh: class { constructor(geometry, material) { Object.assign(this, { geometry, material }); } },
    BufferGeometry: class { setAttribute() { } } };
const threeHeader = '#version 300 es\nprecision highp float; precision highp int;\n#define varying in\nuniform vec3 cameraPosition;\n';

// The matrix from clip space to the world of a camera, column by column, whose far plane is that far away.
function toWorld([eye, ahead, right, up], near, far)
{
    const w = [0, 0, -(far - near) / (2 * far * near), (far + near) / (2 * far * near)];
    return [[...right, 0], [...up, 0], eye.map((x, k) => x * w[2]).concat(w[2]), eye.map((x, k) => x * w[3] + ahead[k]).concat(w[3])].flat();
}

// In the page: draws a fragment shader; an answer of floats, or a picture that stays.
function draw({ source, width, height, floats, look, vertex, uniforms = {}, tables = [] })
{
    document.body.innerHTML = '<canvas></canvas>';
    document.body.style.margin = 0;
    const canvas = Object.assign(document.querySelector('canvas'), { width, height });
    const gl = canvas.getContext('webgl2', { preserveDrawingBuffer: true }), program = gl.createProgram();
    const add = (type, text) => {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
            throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
    };
    add(gl.FRAGMENT_SHADER, source);
    add(gl.VERTEX_SHADER, vertex ?? '#version 300 es\nvoid main() { vec2 p = vec2(float(gl_VertexID << 1 & 2), float(gl_VertexID & 2)); gl_Position = vec4(2.0 * p - 1.0, 0, 1); }');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
        throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    gl.uniform3f(gl.getUniformLocation(program, 'iResolution'), width, height, 1);
    for (const [name, numbers] of Object.entries(uniforms))
        if (numbers.length === 16)
            gl.uniformMatrix4fv(gl.getUniformLocation(program, name), false, numbers);
        else
            gl[numbers.length === 2 ? 'uniform2fv' : 'uniform4fv'](gl.getUniformLocation(program, name), numbers);
    tables.forEach(({ name, data, width, height, format, type, internalFormat }, i) => {
        gl.activeTexture(gl.TEXTURE0 + i);
        gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl[internalFormat], width, height);
        const texels = type === 'FLOAT' ? new Float32Array(data) : new Uint32Array(data);
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl[format], gl[type], texels);
        for (const parameter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
            gl.texParameteri(gl.TEXTURE_2D, parameter, gl.NEAREST);
        gl.uniform1i(gl.getUniformLocation(program, name), i);
    });
    if (look)
        gl.uniform3fv(gl.getUniformLocation(program, 'krs_look'), look);
    if (floats) {
        gl.getExtension('EXT_color_buffer_float');
        const texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    }
    gl.viewport(0, 0, width, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const answer = floats ? new Float32Array(4 * width * height) : new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, floats ? gl.FLOAT : gl.UNSIGNED_BYTE, answer);
    return gl.getError() ? null : Array.from(answer);
}

const minus = (a, b) => a.map((x, i) => x - b[i]), scaled = (a, by) => a.map(x => x * by);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0), unit = a => scaled(a, 1 / Math.sqrt(dot(a, a)));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Eye, and the directions to the middle, to the right and to the top of the picture.
function lookOf(camera)
{
    const ahead = unit(minus(camera.target, camera.eye)), right = unit(cross(ahead, camera.up)), up = cross(right, ahead);
    const rise = Math.tan(camera.fov / 2);
    return [camera.eye, ahead, scaled(right, rise * width / height), scaled(up, rise)];
}

function raysOf([eye, ahead, right, up])
{
    const rays = [];
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const [a, b] = [2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1];
            rays.push([...eye, ...unit(ahead.map((d, k) => d + a * right[k] + b * up[k]))]);
        }
    return rays;
}

// How far rays go, by the command; infinite: they hit nothing.
function queried(scene, rays, studio)
{
    const lines = rays.map(ray => ray.join(' ')).join('\n') + '\n';
    const { stdout } = spawnSync(krs, ['query', scene, '--quiet'], { input: lines, encoding: 'utf8', maxBuffer: 1 << 28 });
    return stdout.trim().split('\n').map(line => /^[-\d]/.test(line) ? Number(line.split(' ')[0]) : Infinity);
}

// Tells whether the material of a module has a picture of what is there.
async function tryThree(name, module, truth)
{
    const { material } = module.makeScene(standIn), { uniforms, vertexShader, fragmentShader } = material.given[0];
    const numbers = { krs_parameter: uniforms.krs_parameter.value.flatMap(slot => slot.given), krs_size: [width, height],
        krs_to_world: toWorld(lookOf(module.camera), 0.01, 1e4), krs_to_clip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1] };
    const tables = ['krs_rows', 'krs_cells'].filter(table => uniforms[table]).map(table => {
        const { value } = uniforms[table], [data, across, down, format, type] = value.given;
        return { name: table, data: Array.from(data), width: across, height: down, format, type, internalFormat: value.internalFormat };
    });
    try {
        const picture = await page.evaluate(draw, { source: threeHeader + fragmentShader, vertex: threeHeader.replace('in\n', 'out\n') + vertexShader,
            width, height, uniforms: numbers, tables });
        const wrong = truth.filter((t, i) => (t !== Infinity) !== (picture[4 * i + 3] > 0));
        ok(new Set(picture).size > 20 && wrong.length <= 0.02 * truth.length, `${name} is drawn for three.js where it is`,
            `${wrong.length} of ${truth.length} differ`);
    } catch (error) {
        ok(false, `${name} is drawn for three.js`, error.message.slice(0, 2000));
    }
}

const browser = await launch(), page = await browser.open('about:blank');
for (const scene of process.env.KRS_EXPORT_SCENES.split(' ')) {
    const name = path.basename(scene, '.krs'), three = `${folder}/${name}.three.mjs`, toyFile = `${folder}/${name}.shadertoy.glsl`;
    const told = run('export', scene, '--to', 'three', '--studio', 'off', '-o', three);
    const module = told.status === 0 ? await import(path.resolve(three)) : null;
    const camera = module?.camera, truth = camera && queried(scene, raysOf(lookOf(camera)));
    if (module)
        await tryThree(name, module, truth);
    else
        ok(told.status === 1 && /cannot export/.test(told.stderr), `${name} is refused for three.js, with a reason`, told.stderr);
    const exported = run('export', scene, '--to', 'shadertoy', '--studio', 'off', '-o', toyFile);
    if (exported.status !== 0) {
        ok(exported.status === 1 && /cannot export/.test(exported.stderr) && !fs.existsSync(toyFile), `${name} is refused, with a reason`, exported.stderr);
        continue;
    }
    const source = fs.readFileSync(toyFile, 'utf8');
    ok(source.length <= 60000, `${name} is no longer than Shadertoy takes`, source.length);
    try {
        const picture = await page.evaluate(draw, { source: header + source + toy, width, height });
        ok(picture && new Set(picture).size > 20, `${name} draws`, 'one colour');
        const look = lookOf(camera), rays = raysOf(look);
        const found = await page.evaluate(draw, { source: header + source + reach, width, height, floats: true, look: look.flat() });
        const wrong = truth.filter((t, i) => t === Infinity ? found[4 * i] >= 0 : !(Math.abs(found[4 * i] - t) <= 0.002 * t));
        ok(truth.length === width * height && wrong.length <= 0.02 * truth.length, `${name} hits where the command says`,
            `${wrong.length} of ${truth.length} differ`);
        // A test that cannot fail is none: rays that begin elsewhere hit elsewhere.
        if (name === '01-hello') {
            const moved = queried(scene, raysOf([look[0].map(x => 1.05 * x), ...look.slice(1)]));
            ok(moved.filter((t, i) => t !== Infinity && !(Math.abs(found[4 * i] - t) <= 0.002 * t)).length > 0.1 * moved.length, 'a moved eye is seen');
        }
        if (shots) {
            run('export', scene, '--to', 'shadertoy', '-o', toyFile);
            await page.evaluate(draw, { source: header + fs.readFileSync(toyFile, 'utf8') + toy, width: 480, height: 270 });
            await page.screenshot(`${shots}/${name}.png`, { x: 0, y: 0, width: 480, height: 270 });
        }
    } catch (error) {
        ok(false, `${name} draws`, error.message.slice(0, 2000));
    }
}
ok(page.errors.length === 0, 'the page has no errors', page.errors.join('\n'));
await browser.close();
console.log(`1..${count}`);
process.exit(failed > 0 ? 1 : 0);
