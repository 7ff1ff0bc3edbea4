// export.mjs KRS FOLDER [SCREENSHOTS]: what `krs export` writes draws in Chromium, and hits where `krs query` does.
//
// A module for three.js is shown by that, beside a wall of its own; THREE is the folder of its package, and without it this is left out.
// A file for Shadertoy is drawn as its page would do it; then a main of the test stores how far its rays go.
// A shader for Godot gets what the engine has built in from the test.  Functions say distances at points; HLSL goes through
// glslang and spirv-cross to WebGL.  KRS_EXPORT_ENGINES are the scenes for engines, KRS_EXPORT_BAKED those that are sampled.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { launch, serve } from './browser.mjs';

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

// In the page: draws a fragment shader; an answer of floats, or a picture that stays.
function draw({ source, width, height, floats, look, block, samples })
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
    add(gl.VERTEX_SHADER, '#version 300 es\nvoid main() { vec2 p = vec2(float(gl_VertexID << 1 & 2), float(gl_VertexID & 2)); gl_Position = vec4(2.0 * p - 1.0, 0, 1); }');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
        throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    gl.uniform3f(gl.getUniformLocation(program, 'iResolution'), width, height, 1);
    if (block && gl.getProgramParameter(program, gl.ACTIVE_UNIFORM_BLOCKS) > 0) {
        gl.uniformBlockBinding(program, 0, 0);
        gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, gl.createBuffer());
        gl.bufferData(gl.UNIFORM_BUFFER, new Float32Array(block), gl.STATIC_DRAW);
    }
    if (samples) { // of a file .dds
        const bytes = Uint8Array.from(atob(samples), c => c.charCodeAt(0)), header = new Uint32Array(bytes.buffer, 0, 37);
        gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
        gl.texStorage3D(gl.TEXTURE_3D, 1, gl.RGBA16F, header[4], header[3], header[6]);
        gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, header[4], header[3], header[6], gl.RGBA, gl.HALF_FLOAT, new Uint16Array(bytes.buffer, 148));
        for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
            gl.texParameteri(gl.TEXTURE_3D, wrap, gl.CLAMP_TO_EDGE);
        gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    }
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

// In the page: what three.js shows of a module, as rows of bytes from the bottom: alone, with a wall across the picture at each of some distances,
// and with its first number at the other end of its range.
async function showThree({ module, width, height, look, fov, walls, large })
{
    const THREE = await import('/three/three.module.js'), scene = await import(module);
    const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true, antialias: false }), gl = renderer.getContext(), world = new THREE.Scene();
    const far = Math.max(...walls) * 100, view = new THREE.PerspectiveCamera(fov * 180 / Math.PI, width / height, walls[0] / 2, far);
    const [eye, ahead, , up] = look.map(v => new THREE.Vector3(...v));
    renderer.setPixelRatio(1);
    renderer.setSize(width, height, false);
    view.position.copy(eye);
    view.up.copy(up);
    view.lookAt(eye.clone().add(ahead));
    const made = scene.makeScene(THREE);
    world.add(made.mesh);
    made.setTime(0);
    const shot = () => {
        const bytes = new Uint8Array(4 * width * height);
        renderer.render(world, view);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        return Array.from(bytes);
    };
    world.background = new THREE.Color(0, 1, 0);
    const shots = { alone: shot(), walls: [] };
    const wall = new THREE.Mesh(new THREE.PlaneGeometry(far, far), new THREE.MeshBasicMaterial({ color: new THREE.Color(1, 0, 1), side: THREE.DoubleSide }));
    world.add(wall);
    for (const distance of walls) {
        wall.position.copy(eye).addScaledVector(ahead, distance);
        wall.quaternion.copy(view.quaternion);
        shots.walls.push(shot());
    }
    world.remove(wall);
    const number = made.parameters.find(p => p.value.length === 1 && p.low[0] !== null && p.high[0] !== null);
    if (number) {
        made.material.uniforms.krs_parameter.value[number.slot].x = number.value[0] === number.high[0] ? number.low[0] : number.high[0];
        shots.changed = shot();
    }
    if (large) {
        renderer.setSize(5 * width, 5 * height, false);
        shot();
        shots.picture = renderer.domElement.toDataURL();
    }
    renderer.dispose();
    return shots;
}

// Tells whether three.js shows a module where rays hit, before what is behind it and behind what is before it.
async function tryThree(name, module, truth)
{
    const look = lookOf(module.camera), rays = raysOf(look), depths = truth.map((t, i) => t * dot(rays[i].slice(3), look[1]));
    const sorted = depths.filter(Number.isFinite).sort((a, b) => a - b), middle = sorted[sorted.length >> 1];
    const walls = [0.5 * sorted[0], middle, 2 * sorted[Math.floor(0.9 * sorted.length)]];
    try {
        const shown = await three.evaluate(showThree, { module: `/scenes/${name}.three.mjs`, width, height, look, fov: module.camera.fov, walls, large: !!shots });
        if (shots)
            fs.writeFileSync(`${shots}/${name}.three.png`, Buffer.from(shown.picture.split(',')[1], 'base64'));
        const has = (shot, i, color) => color.every((byte, k) => shot[4 * i + k] === byte), green = [0, 255, 0], violet = [255, 0, 255];
        const wrong = depths.filter((depth, i) => has(shown.alone, i, green) === Number.isFinite(depth));
        ok(new Set(shown.alone).size > 20 && wrong.length <= 0.02 * truth.length, `three.js shows ${name} where it is`, `${wrong.length} of ${truth.length} differ`);
        const hidden = walls.map((distance, k) => depths.filter((depth, i) => Math.abs(depth - distance) > 0.005 * distance && has(shown.walls[k], i, violet) !== depth > distance));
        ok(hidden.every(list => list.length <= 0.02 * truth.length), `${name} hides in three.js what is behind it, and is hidden by what is before it`,
            `${hidden.map(list => list.length)} of ${truth.length} differ`);
        if (name === '01-hello') // numbers of others may be those of lights, which stay
            ok(shown.changed?.some((byte, i) => byte !== shown.alone[i]), `${name} changes with a uniform in three.js`);
    } catch (error) {
        ok(false, `three.js shows ${name}`, error.message.slice(0, 2000));
    }
}

// ---- engines ----

// Points that single precision has as they are: one for each pixel, where a camera looks.
const points = scale => Array.from({ length: width * height }, (_, i) => {
    const x = i % width, y = Math.floor(i / width);
    return [(x - 48) * scale / 64, (y - 27) * scale / 32, ((7 * x + 3 * y) % 41 - 20) * scale / 32];
});
const pointText = scale => `(floor(at.x) - 48.0) * ${(scale / 64).toFixed(9)}, (floor(at.y) - 27.0) * ${(scale / 32).toFixed(9)}, (whole - 41.0 * floor((whole + 0.5) / 41.0) - 20.0) * ${(scale / 32).toFixed(9)}`;
const distances = scale => `
out vec4 krs_out;
void main()
{
    vec2  at = gl_FragCoord.xy;
    float whole = 7.0 * floor(at.x) + 3.0 * floor(at.y);
    vec3 p = vec3(${pointText(scale)});
    krs_prepare();
    krs_out = vec4(krs_distance(p), krs_distance_lod(p, 0.0), krs_surface(p, vec3(0.0, 1.0, 0.0), 0.0).roughness, 1.0);
}`;
const hlslDistances = scale => `
float4 main(float4 at : SV_Position) : SV_Target
{
    float  whole = 7.0 * floor(at.x) + 3.0 * floor(at.y);
    float3 p = float3(${pointText(scale)});
    krs_prepare();
    return float4(krs_distance(p), krs_distance_lod(p, 0.0), krs_surface(p, float3(0.0, 1.0, 0.0), 0.0).roughness, 1.0);
}`;
const precise = '#version 300 es\nprecision highp float; precision highp int; precision highp sampler2D; precision highp usampler2D; precision highp sampler3D;\n';

// What Godot has of its own.
const godot = `
#define TIME 0.0
uniform vec3 krs_look[4];
const float krs_size = SIZE;
mat4 PROJECTION_MATRIX, VIEW_MATRIX, MODEL_MATRIX;
vec3 VERTEX, ALBEDO, EMISSION, NORMAL, LIGHT_VERTEX;
vec2 VIEWPORT_SIZE;
float ROUGHNESS, METALLIC, DEPTH;
`;
const godotMain = parallel => `
out vec4 krs_out;
void main()
{
    vec2 size = vec2(${width}.0, ${height}.0), plane = 2.0 * gl_FragCoord.xy / size - 1.0;
    vec3 back = -krs_look[1], right = normalize(krs_look[2]), up = normalize(krs_look[3]);
    VIEW_MATRIX = transpose(mat4(vec4(right, -dot(right, krs_look[0])), vec4(up, -dot(up, krs_look[0])), vec4(back, -dot(back, krs_look[0])), vec4(0.0, 0.0, 0.0, 1.0)));
    MODEL_MATRIX = mat4(vec4(1.0, 0.0, 0.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0), vec4(0.0, 0.0, 1.0, 0.0), vec4(KRS_CENTER, 1.0));
    vec2 half_size = vec2(length(krs_look[2]), length(krs_look[3]))${parallel ? ' * krs_size' : ''};
    PROJECTION_MATRIX = mat4(vec4(1.0 / half_size.x, 0.0, 0.0, 0.0), vec4(0.0, 1.0 / half_size.y, 0.0, 0.0), ${parallel ? 'vec4(0.0, 0.0, -0.001, 0.0), vec4(0.0, 0.0, 0.0, 1.0)' : 'vec4(0.0, 0.0, -1.0, -1.0), vec4(0.0, 0.0, -0.1, 0.0)'});
    VIEWPORT_SIZE = size;
    VERTEX = vec3(plane * half_size${parallel ? ', -1.0' : ' * 10.0, -10.0'});
    fragment();
    krs_out = vec4(${parallel ? '-LIGHT_VERTEX.z' : 'length(LIGHT_VERTEX)'}, DEPTH - (${parallel ? '-0.001 * LIGHT_VERTEX.z' : '1.0 + 0.1 / LIGHT_VERTEX.z'}), dot(NORMAL, NORMAL), 1.0);
}`;
const withoutGodot = text => text.replace(/^(shader_type|render_mode).*$/gm, '').replace(/^(uniform sampler3D \w+).*$/gm, '$1;')
    .replace(/^uniform (\w+ \w+)(?: : [^=]*)? = /gm, 'const $1 = ');

// Statements of a text for Godot that stand in no braces, and are none of those that it permits there.
function globals(text)
{
    let depth = 0;
    const outside = [...text.replace(/\/\/.*$|^#.*$/gm, '')].filter(c => (depth += c === '{', depth -= c === '}', depth === 0 || c === '}')).join('');
    return outside.split(/[;}]/).map(part => part.trim()).filter(part => part && !/^(uniform|const|struct|shader_type|render_mode) ?/.test(part) && !/\)$/.test(part));
}

// What is wrong of distances and distances to march by, or nothing.
function wrongDistances(found, truth, scale)
{
    const wrong = points(scale).map((p, i) => {
        const size = 1 + p.reduce((sum, x) => sum + Math.abs(x), Math.abs(truth[i])), [distance, lod] = found.slice(4 * i);
        return Math.abs(distance - truth[i]) <= 1e-4 * size && lod <= distance + 1e-4 * size && (Math.abs(distance) < 1e-4 * size || lod > 0 === distance > 0)
            ? '' : `at ${p} ${distance}, ${lod} for ${truth[i]}`;
    }).filter(Boolean);
    return wrong.length ? `${wrong.length} of ${truth.length} differ, ${wrong[0]}` : '';
}

const defaults = text => text.match(/KRS_DEFAULTS.*?[({](.*)[)}];/)[1].match(/-?[\d.]+(e[-+]?\d+)?(?=[,)])/g).map(Number);

// HLSL as ESSL.
function crossed(file, text)
{
    fs.writeFileSync(`${file}.test.hlsl`, text);
    const compiled = spawnSync('glslangValidator', ['-D', '-V', '-S', 'frag', '-e', 'main', '-o', `${file}.spv`, `${file}.test.hlsl`], { encoding: 'utf8' });
    if (compiled.status !== 0)
        throw new Error(compiled.stdout);
    return spawnSync('spirv-cross', ['--es', '--version', '300', `${file}.spv`], { encoding: 'utf8' }).stdout;
}

// Distances by WGSL, in the page that tests of the printer have.
async function byWgpu(name, text, scale)
{
    const put = (ending, numbers) => fs.writeFileSync(`${folder}/${name}.${ending}`, new Uint8Array(Float32Array.from(numbers).buffer));
    put('parameters', defaults(text));
    put('points', points(scale).flatMap(p => [...p, 0]));
    put('normals', points(scale).flatMap(() => [0, 1, 0, 0]));
    put('rows', []);
    put('cells', []);
    const { error, found } = await wgpu.evaluate((...scene) => run(...scene), name);
    if (error)
        throw new Error(error);
    return found.flatMap((_, i) => i % 8 === 0 ? [found[i], found[i + 1], 0, 1] : []);
}

async function tryEngines(scene, name, camera)
{
    const look = lookOf(camera), scale = 2 ** Math.ceil(Math.log2(Math.hypot(...minus(camera.eye, camera.target)) / 2));
    const truth = queried(scene, points(scale)), tried = {
        essl: text => page.evaluate(draw, { source: precise + text + distances(scale), block: defaults(text), width, height, floats: true }),
        glsl: text => page.evaluate(draw, { source: `${precise}#define precise\n` + text.replace('KRS_SET binding = 0', '').replace('std140, ', 'std140') + distances(scale), block: defaults(text), width, height, floats: true }),
        wgsl: text => byWgpu(name, text, scale),
        hlsl: text => page.evaluate(draw, { source: crossed(`${folder}/${name}`, text + hlslDistances(scale)), block: defaults(text), width, height, floats: true }),
    };
    for (const [target, ask] of Object.entries(tried)) {
        const file = `${folder}/${name}.${target}`, told = run('export', scene, '--to', target, '--studio', 'off', '-o', file);
        if (target === 'hlsl' && /no `spirv-cross`/.test(told.stderr)) {
            ok(true, `${name} for hlsl # SKIP no spirv-cross`);
            continue;
        }
        try {
            const skipped = target === 'wgsl' && !wgpu, found = skipped ? null : await ask(fs.readFileSync(file, 'utf8'));
            const wrong = skipped ? '' : wrongDistances(found, truth, scale);
            ok(told.status === 0 && !wrong, `${name} has the command's distances in ${target}${skipped ? ' # SKIP no WebGPU' : ''}`, told.stderr + wrong);
            if (target === 'essl' && name === '01-hello')
                ok(wrongDistances(found.map(x => 1.001 * x), truth, scale), 'a wrong distance is seen');
        } catch (error) {
            ok(false, `${name} has the command's distances in ${target}`, error.message.slice(0, 2000));
        }
    }
    await tryGodot(scene, name, camera);
}

// Tells whether a shader for Godot hits where the command says, within a part of the way.
async function tryGodot(scene, name, camera, tolerance = 0.002, ...options)
{
    const look = lookOf(camera), file = `${folder}/${name}.gdshader`, told = run('export', scene, '--to', 'godot', '--studio', 'off', '-o', file, ...options);
    try {
        const text = fs.readFileSync(file, 'utf8'), rays = queried(scene, raysOf(look));
        const samples = options.length ? fs.readFileSync(`${folder}/${name}.dds`, 'base64') : null;
        ok(globals(text).length === 0 && globals(`${text}\nfloat a;`).length === 1, `${name} has no globals that change for Godot`, globals(text).join('; '));
        // Rays of a camera, and those of a light that comes from there, which are parallel.
        const size = Math.hypot(...minus(camera.eye, camera.target)), [eye, ahead, right, up] = look;
        const parallel = raysOf(look).map((_, i) => [...eye.map((x, k) => x + size * ((2 * (i % width + 0.5) / width - 1) * right[k] +
            (2 * (Math.floor(i / width) + 0.5) / height - 1) * up[k])), ...ahead]);
        for (const [what, isParallel, expected] of [['hits', false, rays], ['casts shadows', true, queried(scene, parallel)]]) {
            const found = await page.evaluate(draw, { source: precise + godot.replace('SIZE', size.toFixed(9)) + withoutGodot(text) + godotMain(isParallel), width, height, floats: true, look: look.flat(), samples });
            const wrong = expected.filter((t, i) => t === Infinity ? found[4 * i + 3] > 0
                : !(Math.abs(found[4 * i] - t) <= tolerance * t && Math.abs(found[4 * i + 1]) < 1e-4 && Math.abs(found[4 * i + 2] - 1) < 1e-3));
            ok(told.status === 0 && wrong.length <= 0.02 * expected.length, `${name} ${what} for Godot where the command says, with depth and normal`, `${wrong.length} of ${expected.length} differ`);
        }
    } catch (error) {
        ok(false, `${name} is drawn for Godot`, told.stderr + error.message.slice(0, 2000));
    }
}

const browser = await launch({ args: ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'] }), page = await browser.open('about:blank');
const server = await serve({ '/': 'tests/web/pages', '/scenes/': folder, ...(process.env.THREE ? { '/three/': path.join(process.env.THREE, 'build') } : {}) });
let wgpu = await browser.open(`${server.url}/wgsl.html`);
if (await wgpu.until('window.ready') === 'no adapter')
    wgpu = null;
const three = process.env.THREE ? await browser.open(`${server.url}/wgsl.html`) : null;
const engines = (process.env.KRS_EXPORT_ENGINES ?? '').split(' ');
for (const scene of process.env.KRS_EXPORT_SCENES.split(' ')) {
    const name = path.basename(scene, '.krs'), three = `${folder}/${name}.three.mjs`, toyFile = `${folder}/${name}.shadertoy.glsl`;
    const told = run('export', scene, '--to', 'three', '--studio', 'off', '-o', three);
    const module = told.status === 0 ? await import(path.resolve(three)) : null;
    const camera = module?.camera, truth = camera && queried(scene, raysOf(lookOf(camera)));
    if (module && three)
        await tryThree(name, module, truth);
    else if (module)
        ok(true, `three.js shows ${name} # SKIP npm has no three`);
    else
        ok(told.status === 1 && /cannot export/.test(told.stderr), `${name} is refused for three.js, with a reason`, told.stderr);
    if (module && engines.includes(scene))
        await tryEngines(scene, name, camera);
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
            await page.screenshot(`${shots}/${name}.shadertoy.png`, { x: 0, y: 0, width: 480, height: 270 });
        }
    } catch (error) {
        ok(false, `${name} draws`, error.message.slice(0, 2000));
    }
}
for (const scene of (process.env.KRS_EXPORT_BAKED ?? '').split(' ').filter(Boolean)) {
    const name = path.basename(scene, '.krs'), file = `${folder}/${name}.three.mjs`, bake = ['--bake', '128'];
    const told = run('export', scene, '--to', 'three', '--studio', 'off', '-o', file, ...bake);
    ok(told.status === 0, `${name} is sampled`, told.stderr);
    const { camera } = await import(path.resolve(file)), module = { camera }, refused = run('export', scene, '--to', 'godot', '-o', `${folder}/refused.gdshader`);
    ok(refused.status === 1 && /--bake/.test(refused.stderr), `${name} cannot be a text for Godot, which is told samples`, refused.stderr);
    if (three)
        await tryThree(name, module, queried(scene, raysOf(lookOf(camera))));
    else
        ok(true, `three.js shows ${name} # SKIP npm has no three`);
    await tryGodot(scene, name, camera, 0.01, ...bake);
}
const errors = [...page.errors, ...(three?.errors ?? [])];
ok(errors.length === 0, 'the pages have no errors', errors.join('\n'));
await browser.close();
server.close();
console.log(`1..${count}`);
process.exit(failed > 0 ? 1 : 0);
