// programs.mjs: the passes of a picture as programs of WebGL2 (web/picture).
import * as shaders from './shaders.mjs';

const vertex = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;
const precision = ['float', 'int', 'sampler2D', 'usampler2D', 'isampler2D'].map(type => `precision highp ${type};\n`).join('');
export const passes = ['march', 'normal', 'secondary', 'shade'];

// What the passes are told of a scene, as macros.
function definesOf({ shaders: has }, text, pass, mirrors) {
    const chosen = {
        OPEN_SURFACES: has.open_surfaces, GRADIENT: pass === 'normal' && (has.open_surfaces || has.algebraic), PLAIN: pass === 'normal' && has.plain,
        MIRRORS: mirrors, LAYERS: has.layers, FILM: has.films, ANISOTROPIC: has.anisotropic, SUBSURFACE: has.subsurface,
        KRS_VIEW: has.views, PANORAMIC: has.panoramas, LENS: has.lenses,
        EARLY_OUTS: /\bfloat krs_distance_lod\(/.test(text),
    };
    return Object.keys(chosen).filter(name => chosen[name]).map(name => `#define ${name}\n`).join('');
}

// What a driver says of a shader, with the lines that it names.
const said = (log, source) => (log ?? '').replace(/^ERROR: \d+:(\d+):.*/gm, (line, number) => `${line}\n    ${source.split('\n')[number - 1]}`);

export class Program {
    constructor(gl, source) {
        this.gl = gl;
        this.program = gl.createProgram();
        this.stages = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, source]].map(([type, text]) => {
            const shader = gl.createShader(type);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(this.program, shader);
            return shader;
        });
        gl.linkProgram(this.program);
    }

    // Resolves when it can be used, without waiting for the driver.
    async ready() {
        const { gl, program } = this, parallel = gl.getExtension('KHR_parallel_shader_compile');
        while (parallel && !gl.isContextLost() && !gl.getProgramParameter(program, parallel.COMPLETION_STATUS_KHR))
            await new Promise(resolve => setTimeout(resolve, 4));
        if (gl.isContextLost())
            throw new Error('the context is lost');
        if (!gl.getProgramParameter(program, gl.LINK_STATUS))
            throw new Error(this.stages.map(shader => said(gl.getShaderInfoLog(shader), gl.getShaderSource(shader))).join('') + gl.getProgramInfoLog(program));
        this.stages.forEach(shader => gl.deleteShader(shader));
        this.uniforms = this.#findUniforms();
        const block = gl.getUniformBlockIndex(program, 'KrsParameters');
        if (block !== gl.INVALID_INDEX)
            gl.uniformBlockBinding(program, block, 0);
        return this;
    }

    #findUniforms() {
        const { gl, program } = this, found = new Map();
        for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
            const { name, type } = gl.getActiveUniform(program, i), at = gl.getUniformLocation(program, name);
            if (at)
                found.set(name, { at, type });
        }
        return found;
    }

    // Sets those that it has; members of a struct are `frame.eye`.
    set(values, prefix = '') {
        const { gl } = this;
        for (const [name, value] of Object.entries(values)) {
            const uniform = this.uniforms.get(prefix + name);
            if (!uniform)
                continue;
            const { at, type } = uniform;
            switch (type) {
            case gl.FLOAT: gl.uniform1f(at, value); break;
            case gl.FLOAT_VEC2: gl.uniform2fv(at, value); break;
            case gl.FLOAT_VEC3: gl.uniform3fv(at, value); break;
            case gl.FLOAT_VEC4: gl.uniform4fv(at, value); break;
            case gl.FLOAT_MAT3: gl.uniformMatrix3fv(at, true, value); break; // by rows
            case gl.UNSIGNED_INT: gl.uniform1ui(at, value); break;
            case gl.UNSIGNED_INT_VEC2: gl.uniform2uiv(at, value); break;
            case gl.INT_VEC2: gl.uniform2iv(at, value); break;
            default: gl.uniform1i(at, value); // numbers, truths, samplers
            }
        }
    }

    free() { this.gl.deleteProgram(this.program); }
}

// The programs of a scene; they are compiled side by side.
export function compilePasses(gl, about, text) {
    // Rays that go on are three textures more.
    const mirrors = about.shaders.mirrors && gl.getParameter(gl.MAX_DRAW_BUFFERS) >= 7;
    const made = Object.fromEntries(passes.map(pass =>
        [pass, new Program(gl, `#version 300 es\n${precision}${definesOf(about, text, pass, mirrors)}${text}\n${shaders[pass]}`)]));
    return Promise.all(Object.values(made).map(program => program.ready())).then(() => ({ ...made, mirrors }));
}

export const compileResolve = gl => new Program(gl, `#version 300 es\n${precision}${shaders.resolve}`).ready();
