// scene.mjs: puts a scene into a shader of WGSL, in place of the one that stands for it (runtime/shaders/scene.glsl).
//
// naga keeps names and adds the types of parameters to them; it passes each parameter by a pointer.

const declaration = name => new RegExp(`^fn (${name}_u0028_\\w*)\\(([^)]*)\\)( -> [^{]*)? \\{\\n[^]*?^\\}\\n`, 'm');
const structOf = name => new RegExp(`^struct ${name} \\{\\n[^]*?^\\}\\n`, 'm');

// Returns the shader's text with the functions of the scene's text, as `krs compile --language wgsl` prints it.
export function withScene(shader, scene) {
    let text = shader;
    for (const [name] of shader.matchAll(/\bkrs_\w+?(?=_u0028_)/g)) {
        const found = text.match(declaration(name));
        if (!found || found[0].includes('/* of the scene */'))
            continue;
        const [whole, mangled, parameters, result = ''] = found;
        if (!scene.includes(`fn ${name}(`))
            throw new Error(`the scene has no function ${name}`);
        const passed = [...parameters.matchAll(/(\w+): ptr/g)].map(([, parameter]) => `*${parameter}`).join(', ');
        text = text.replace(whole, () => `fn ${mangled}(${parameters})${result} { /* of the scene */ ${result && 'return '}${name}(${passed}); }\n`);
    }
    text = text.replace(structOf('KrsSurface'), '').replace(structOf('KrsParameters'), '')
        .replace(/^@group\(0\) @binding\(0\) *\nvar<uniform> .*\n/m, '').replace(/^var<private> krs_local_radius.*\n/m, '');
    return scene + text;
}
