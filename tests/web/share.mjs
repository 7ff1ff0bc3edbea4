// share.mjs: links to scenes come back as they were, and broken ones are told.
//
//     node share.mjs
//
// Prints TAP.  What a link holds is also read by zlib and JSON alone.
import zlib from 'node:zlib';
import { pack, unpack } from '../../web/playground/share.mjs';

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

// The same numbers on every machine.
let seed = 1;
const random = below => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return Math.floor(seed / 2 ** 32 * below);
};

const pieces = ['show ', 'sphere(1)', '.move([0, 1, 0])', ';', '\n', '\r\n', '\t', '"', '\\', '\0', '#c8553d', 'ä', 'Ω', '鱼', '🐟', '\u2028', '</script>',
    '%', '+', '/', '=', '&', '{', '}', ' ', 'param a = 1 in [0, 2];'];
const text = () => Array.from({ length: random(400) }, () => pieces[random(pieces.length)]).join('');
const vector = () => [0, 0, 0].map(() => (random(2e6) - 1e6) / 997);

function shared() {
    const made = { text: text() };
    if (random(2))
        made.parameters = Object.fromEntries(Array.from({ length: 1 + random(4) }, (_, i) => [`p${i}`, Array.from({ length: 1 + random(4) }, () => random(1e9) / 7)]));
    if (random(2))
        made.camera = { eye: vector(), target: vector(), ...(random(2) && { up: vector() }) };
    if (random(2))
        made.time = random(1e6) / 13;
    return made;
}

const wanted = Array.from({ length: 100 }, shared);
const links = await Promise.all(wanted.map(pack));
const found = await Promise.all(links.map(unpack));
const alike = (a, b) => JSON.stringify(Object.entries(a).sort()) === JSON.stringify(Object.entries(b).sort());
report(wanted.every((one, i) => alike(one, found[i])), '100 generated scenes come back equal');
report(links.every(link => /^#1\.[A-Za-z0-9_-]+$/.test(link)), 'links have no character that needs to be escaped');
report(links.every((link, i) => alike(JSON.parse(zlib.inflateRawSync(Buffer.from(link.slice(3), 'base64url')).toString()), wanted[i])),
    'they are deflated JSON in base64url, as zlib reads it');

const fails = async link => unpack(link).then(() => false, error => /broken/.test(error.message));
const link = links.find(one => one.length > 200);
report(await fails('#2.abc'), 'a link of another kind is told');
report(await unpack('') === null && await unpack('#editor') === null, 'other fragments are no links');
report((await Promise.all([20, 60, 100].map(length => fails(link.slice(0, length))))).every(Boolean), 'links that lack their end are told');
report(await fails('#1.%%%') && await fails('#1.') && await fails('#1.AAAA'), 'so is what was never one');
const packed = value => `#1.${zlib.deflateRawSync(Buffer.from(JSON.stringify(value))).toString('base64url')}`;
report(await fails(packed({ text: 7 })) && await fails(packed(null)), 'so are links without a text');
report(await fails(packed({ text: ' '.repeat(64 << 20) })), 'a small link does not unpack to 64 MB');
const seeing = async camera => (await unpack(packed({ text: 'show sphere(1);', camera }))).camera !== undefined;
report(await seeing({ eye: [0, 0, 5], target: [0, 0, 0] }) && !await seeing({ eye: [1, 1, 1], target: [1, 1, 1] }) && !await seeing({ eye: [1e200, 0, 0], target: [0, 0, 0] }) &&
    !await seeing({ eye: [0, 0, 5], target: [0, 0, 0], up: [0, 0, 0] }), 'a camera that sees nothing is left out');
const odd = await unpack(packed({ text: 'show sphere(1);', parameters: { a: 'x', b: [1] }, camera: { eye: [1, 2], target: [0, 0, 0] }, time: 'now', more: 1 }));
report(alike(odd, { text: 'show sphere(1);', parameters: { b: [1] } }), 'of a strange link only what is of its kind is taken');
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
