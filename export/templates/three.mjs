// @name@, for three.js.  Made by krs @version@ of a scene of implicit surfaces.
//
//     import * as THREE from 'three';
//     import { makeScene } from './@name@.three.mjs';
//     const made = makeScene(THREE);
//     scene.add(made.mesh);                    // it hides what is behind it, and is hidden by what is before it
//     made.setTime(seconds);
//     made.material.uniforms.krs_parameter.value[made.parameters[0].slot].x = 2;
//
// It is drawn where its box is; where that has no end, everywhere.  The camera may be perspective or orthographic.

export const parameters = @parameters@;
export const low = @low@, high = @high@; // the box around it; null: it has no end
export const camera = @camera@;

const block = @block@;
@if_baked@const samples = '@baked_text@', sides = [@baked_count@]; // numbers of 16 bits: colour, distance
@end@const rows = '@rows@', cells = '@cells@'; // of tables, in base64

const vertexShader = `
out vec2 krs_at;
void main()
{
    krs_at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(krs_at, 0.0, 1.0);
}`;

const fragmentShader = `
precision highp int;
in vec2 krs_at;
layout(location = 0) out highp vec4 krs_color;
uniform mat4 krs_to_world; // of the camera's clip space
uniform mat4 krs_to_clip;
uniform vec2 krs_size;
uniform vec4 krs_parameter[@slots@];
@constants@
@scene@
@tracer@
void main()
{
    krs_prepare();
    vec4  near = krs_to_world * vec4(krs_at, -1.0, 1.0), far = krs_to_world * vec4(krs_at, 1.0, 1.0);
    vec4  beside = krs_to_world * vec4(krs_at.x, krs_at.y + 2.0 / krs_size.y, 1.0, 1.0);
    vec3  origin = near.xyz / near.w, end = far.xyz / far.w;
    float last = length(end - origin), pixel = length(beside.xyz / beside.w - end) / last, t;
    vec3  direction = (end - origin) / last;
    if (!krs_trace(origin, direction, 0.0, min(last, KRS_FARTHEST), pixel, t))
        discard;
    krs_color = vec4(krs_display(krs_shade(origin, direction, t, pixel)), 1.0);
    vec4 clip = krs_to_clip * vec4(origin + t * direction, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
}`;

// A table as a texture of rows of 4,096 texels.
function makeTexture(THREE, text, Type, channels, format, type, internalFormat)
{
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)), width = 4096;
    const height = Math.max(1, Math.ceil(bytes.length / Type.BYTES_PER_ELEMENT / channels / width));
    const data = new Type(width * height * channels);
    data.set(new Type(bytes.buffer));
    const texture = new THREE.DataTexture(data, width, height, format, type);
    texture.internalFormat = internalFormat;
    texture.needsUpdate = true;
    return texture;
}

@if_baked@function makeVolume(THREE)
{
    const texture = new THREE.Data3DTexture(new Uint16Array(Uint8Array.from(atob(samples), c => c.charCodeAt(0)).buffer), ...sides);
    texture.type = THREE.HalfFloatType;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

@end@export function makeScene(THREE)
{
    const slots = [];
    for (let i = 0; i < block.length; i += 4)
        slots.push(new THREE.Vector4(...block.slice(i, i + 4)));
    const uniforms = {
        krs_parameter: { value: slots }, krs_size: { value: new THREE.Vector2(1, 1) },
        krs_to_world: { value: new THREE.Matrix4() }, krs_to_clip: { value: new THREE.Matrix4() },
    };
@if_baked@    uniforms.krs_baked = { value: makeVolume(THREE) };
@end@    if (cells) {
        uniforms.krs_rows = { value: makeTexture(THREE, rows, Float32Array, 4, THREE.RGBAFormat, THREE.FloatType, 'RGBA32F') };
        uniforms.krs_cells = { value: makeTexture(THREE, cells, Uint32Array, 2, THREE.RGIntegerFormat, THREE.UnsignedIntType, 'RG32UI') };
    }
    const material = new THREE.ShaderMaterial({ glslVersion: THREE.GLSL3, uniforms, vertexShader, fragmentShader });
    const geometry = new THREE.BufferGeometry(); // a triangle that covers the picture
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(9), 3));
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.onBeforeRender = (renderer, scene, view) => {
        renderer.getDrawingBufferSize(uniforms.krs_size.value);
        uniforms.krs_to_clip.value.multiplyMatrices(view.projectionMatrix, view.matrixWorldInverse).multiply(mesh.matrixWorld);
        uniforms.krs_to_world.value.copy(uniforms.krs_to_clip.value).invert();
    };
    return { mesh, material, parameters, setTime: seconds => { slots[0].x = seconds; } };
}
