// kernels.mjs: the runtime's shaders as WGSL, by naga.
//
//     node kernels.mjs PACKAGES FILE.spv...
//
// PACKAGES is a folder with naga-wasm.  Writes FILE.wgsl beside each module.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [packages, ...files] = process.argv.slice(2);
const { parseSpirv, validate, writeWgsl } = await import(pathToFileURL(path.join(packages, 'naga-wasm/dist/node.js')));
for (const file of files) {
    try {
        const module = parseSpirv(fs.readFileSync(file));
        fs.writeFileSync(file.replace(/\.spv$/, '.wgsl'), writeWgsl(module, validate(module)));
    } catch (error) {
        console.error(`${file}: ${error.formatted ?? error}`);
        process.exitCode = 1;
    }
}
