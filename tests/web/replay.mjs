// replay.mjs: pictures of the runtime's shaders in Chromium's WebGPU, beside those of the device that krs renders on.
//
//     node replay.mjs RECORD WHAT
//
// RECORD has what record.c has written, with the shaders as WGSL.  Prints a line of TAP; PICTURE is a file for both as a PPM.
import fs from 'node:fs';
import { launch, serve } from './browser.mjs';

const [record, what] = process.argv.slice(2);
const server = await serve({ '/': 'tests/web/pages', '/record/': record });
const browser = await launch({ args: ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'] });
const page = await browser.open(`${server.url}/replay.html`);
const there = await page.until('window.ready') !== 'no adapter';
const answer = there ? await page.evaluate(() => replay()) : null;
await browser.close();
server.close();
if (!there) {
    console.log(`ok - ${what} # SKIP Chromium has no WebGPU here`);
    process.exit(0);
}

// Mean and largest difference of what a screen shows, in parts of 255.
const shown = light => {
    const x = Math.min(Math.max(light / answer.samples, 0), 1);
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
};
let error = answer.error, sum = 0, most = 0, bright = 0;
if (!error) {
    const off = answer.found.map((number, i) => Math.abs(shown(number) - shown(answer.wanted[i]))).filter((_, i) => i % 4 < 3);
    sum = off.reduce((a, b) => a + b, 0) / off.length;
    most = off.reduce((a, b) => Math.max(a, b), 0);
    bright = answer.wanted.filter((number, i) => i % 4 < 3 && shown(number) > 16).length / off.length;
}
if (process.env.PICTURE && !error) {
    const bytes = numbers => Buffer.from(numbers.filter((_, i) => i % 4 < 3).map(shown));
    const [width, height] = process.env.SIZE.split('x').map(Number);
    fs.writeFileSync(process.env.PICTURE, Buffer.concat([Buffer.from(`P6 ${width} ${2 * height} 255\n`), bytes(answer.found), bytes(answer.wanted)]));
}
const good = !error && sum <= 0.1 && bright > 0.5;
console.log(`${good ? 'ok' : 'not ok'} - ${what}: ${error ?? `${sum.toExponential(1)} of 255 in the mean, ${most.toExponential(1)} at most, ${answer.seconds.toFixed(1)} s`}`.replaceAll('\n', ' '));
process.exit(good ? 0 : 1);
