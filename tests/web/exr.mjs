// exr.mjs: reads pictures of OpenEXR in scan lines, by its file layout, as `krs render` writes them: without compression or
// by ZIP.  Channels are arrays of numbers, rows from the top.
import zlib from 'node:zlib';

const half = bits => {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, part = bits & 1023;
    return sign * (exponent === 0 ? part * 2 ** -24 : exponent === 31 ? (part ? NaN : Infinity) : (1 + part / 1024) * 2 ** (exponent - 15));
};
const types = [
    { size: 4, read: (bytes, at) => bytes.readUInt32LE(at) },
    { size: 2, read: (bytes, at) => half(bytes.readUInt16LE(at)) },
    { size: 4, read: (bytes, at) => bytes.readFloatLE(at) },
];
const rowsOf = { 0: 1, 2: 1, 3: 16 }; // of a chunk, by compression: none, ZIPS, ZIP

// Bytes are differences of neighbours, and every second one is in the second half.
function unpack(packed, size) {
    const bytes = zlib.inflateSync(packed), out = Buffer.alloc(size), middle = Math.ceil(size / 2);
    for (let i = 1; i < size; i++)
        bytes[i] = (bytes[i - 1] + bytes[i] - 128) & 255;
    for (let i = 0; i < size; i++)
        out[i] = bytes[i % 2 ? middle + (i >> 1) : i >> 1];
    return out;
}

export function readExr(file) {
    let at = 8;
    const word = () => {
        const end = file.indexOf(0, at), text = file.toString('latin1', at, end);
        at = end + 1;
        return text;
    };
    const attributes = {}, channels = [];
    for (let name; (name = word());) {
        word(); // its type
        const size = file.readInt32LE(at);
        attributes[name] = file.subarray(at + 4, at + 4 + size);
        at += 4 + size;
    }
    const list = attributes.channels;
    for (let i = 0; list[i];) {
        const end = list.indexOf(0, i);
        channels.push({ name: list.toString('latin1', i, end), ...types[list.readInt32LE(end + 1)] });
        i = end + 17;
    }
    const [left, top, right, bottom] = [0, 4, 8, 12].map(i => attributes.dataWindow.readInt32LE(i));
    const width = right - left + 1, height = bottom - top + 1, rows = rowsOf[attributes.compression[0]];
    const numbers = Object.fromEntries(channels.map(({ name }) => [name, new Float64Array(width * height)]));
    const row = width * channels.reduce((sum, { size }) => sum + size, 0);
    for (let first = 0; first < height; first += rows, at += 8) {
        const place = Number(file.readBigUInt64LE(at)), size = file.readInt32LE(place + 4), count = Math.min(rows, height - first);
        const packed = file.subarray(place + 8, place + 8 + size), bytes = size < row * count ? unpack(packed, row * count) : packed;
        let from = 0;
        for (let y = first; y < first + count; y++)
            for (const { name, size: step, read } of channels)
                for (let x = 0; x < width; x++, from += step)
                    numbers[name][y * width + x] = read(bytes, from);
    }
    return { width, height, ...numbers };
}
