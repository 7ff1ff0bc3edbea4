// work.mjs: counts what a page and its workers do, so that a test asks no clock.
//
//     const page = await browser.open(url, counting);
//     await page.evaluate('work');       // of the page: { copied, drawn, compiled }
//     await loggedBy(page, 'scene');     // of the worker that was sent such a message: what it did, since it was asked last
//
// `copied` are the bytes of the largest message to a worker that is no transfer, `drawn` and `compiled` how often the page has drawn by itself, or taken
// WebAssembly.  A log has the calls of messages that come, { tile, copied, frame } of what is done: pixels of a tile, bytes of a
// message that goes, and samples of a picture; 'program', and 'begin' where sums are cleared.

const copies = `
    const sizeOf = (value, seen) => {
        if (typeof value === 'string')
            return 2 * value.length;
        if (value === null || typeof value !== 'object')
            return 8;
        if (seen.has(value))
            return 0;
        seen.add(value);
        return ArrayBuffer.isView(value) ? sizeOf(value.buffer, seen) : value instanceof ArrayBuffer ? value.byteLength
            : Object.values(value).reduce((sum, part) => sum + sizeOf(part, seen), 8);
    };
    const copiedOf = (message, transfer = []) => sizeOf(message, new Set(transfer.transfer ?? transfer));
    const before = (object, name, told) => {
        const call = object[name];
        object[name] = function (...values) { told(...values); return call.apply(this, values); };
    };`;

const inPage = `{
    ${copies}
    window.work = { copied: 0, drawn: 0, compiled: 0 };
    before(Worker.prototype, 'postMessage', (...call) => { work.copied = Math.max(work.copied, copiedOf(...call)); });
    before(HTMLCanvasElement.prototype, 'getContext', () => { work.drawn++; });
    for (const name of ['instantiate', 'instantiateStreaming', 'compile'])
        before(WebAssembly, name, () => { work.compiled++; });
}`;

const inWorkers = `{
    ${copies}
    self.log = [];
    let tile = 0;
    const { prototype } = WebGL2RenderingContext;
    before(prototype, 'scissor', (x, y, width, height) => { tile = width * height; });
    before(prototype, 'readPixels', () => log.push({ tile }));
    before(prototype, 'linkProgram', () => log.push('program'));
    before(prototype, 'clearBufferfv', () => log.push('begin'));
    before(self, 'postMessage', (message, transfer) => log.push({ copied: copiedOf(message, transfer), frame: message.kind === 'frame' ? message.samples : undefined }));
    addEventListener('message', ({ data }) => log.push(data.call));
}`;

export const counting = { inPage, inWorkers };

export async function loggedBy(page, ...calls) {
    const logs = await Promise.all(page.workers.map(worker => worker.evaluate('log.splice(0)')));
    return logs.find(log => log.some(what => calls.includes(what))) ?? [];
}

export const isTile = what => what.tile !== undefined;
