// albedos.mjs: the tables of albedos (runtime/tracer/albedos.h) as rows of four words, as shaders read them (blocks.h).
//
//     node albedos.mjs build/albedo_tables.c >albedos.bin
import fs from 'node:fs';

const albedoRows = 4096, wideAt = 4096 + 2 * 32, rows = wideAt + 12 * 16 * 5, thousandths = 1000, whole = 65535;
const [plain, wide] = fs.readFileSync(process.argv[2], 'utf8').split(/\nconst uint16_t/);
const numbersOf = text => Array.from(text.matchAll(/\{([-\d., ]+)\}/g), ([, row]) => row.split(',').filter(word => word.trim()).map(Number));
const bytes = new ArrayBuffer(16 * rows), floats = new Float32Array(bytes), halves = new Uint16Array(bytes);
const plainRows = numbersOf(plain), wideRows = numbersOf(wide);
if (plainRows.length !== albedoRows || wideRows.length !== rows - wideAt)
    throw new Error(`${plainRows.length} and ${wideRows.length} rows`);
plainRows.forEach((row, i) => floats.set(row, 4 * i));
wideRows.forEach((row, i) => halves.set(row.map(part => Math.floor((part * whole + thousandths / 2) / thousandths)), 8 * (wideAt + i)));
fs.writeSync(1, new Uint8Array(bytes));
