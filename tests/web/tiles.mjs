// tiles.mjs: tiles cover a picture once, and follow what pixels cost: pictures are made of costs, so that no clock decides.
//
//     node tests/web/tiles.mjs
import { Costs, Tiles } from '../../web/package/tiles.mjs';

let number = 0, failed = 0;
const report = (good, what) => {
    console.log(`${good ? 'ok' : 'not ok'} ${++number} - ${what}`);
    failed += !good;
};

const OVERHEAD = 2, LONGEST = 100; // milliseconds of a draw by itself, and of a tile at most

let seed = 1;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;

// Draws a picture that costs `costOf(x, y)` at each place from 0 to 1, and returns its tiles with the time of each.  Each draw
// waits for `waits` milliseconds in the mean.
function draw(costs, { width, height }, costOf, waits = 0) {
    const tiles = new Tiles(costs, width, height), drawn = new Uint8Array(width * height), all = [];
    while (!tiles.isOver) {
        const { x, y, width: across, height: down } = tiles.next();
        let time = OVERHEAD - waits * Math.log(1 - random());
        for (let row = y; row < y + down; row++)
            for (let column = x; column < x + across; column++) {
                drawn[row * width + column]++;
                time += costOf((column + 0.5) / width, (row + 0.5) / height);
            }
        tiles.took(time);
        all.push({ pixels: across * down, time });
    }
    return { all, once: drawn.every(times => times === 1), longest: Math.max(...all.map(({ time }) => time)),
        whole: all.reduce((sum, { time }) => sum + time, 0) };
}

const levels = [64, 32, 16, 8, 4, 2, 1].map(level => ({ width: Math.ceil(640 / level), height: Math.ceil(360 / level) }));
const pictures = {
    'an even, cheap picture': () => 1e-4,
    'an even, dear one': () => 0.5,
    'one with a dear horizon': (x, y) => (Math.abs(y - 0.4) < 0.03 ? 1 : 0.001),
    'one with a dear ball': (x, y) => (Math.hypot(x - 0.6, y - 0.5) < 0.2 ? 0.3 : 1e-4),
};
for (const [what, costOf] of Object.entries(pictures)) {
    const costs = new Costs(OVERHEAD), drawn = levels.map(size => draw(costs, size, costOf)), [first] = drawn, last = draw(costs, levels.at(-1), costOf);
    report(drawn.every(({ once }) => once) && last.once, `${what}: each pixel is drawn once`);
    report(first.all[0].pixels <= 16 && first.all.every(({ pixels }, i) => i === 0 || pixels <= 4 * Math.max(...first.all.slice(0, i).map(tile => tile.pixels))),
        `${what}: it begins with few pixels, and grows`);
    report(Math.max(...drawn.map(({ longest }) => longest)) < LONGEST, `${what}: no tile takes long (${Math.max(...drawn.map(({ longest }) => longest)).toFixed(1)} ms)`);
    report(last.all.length <= 2 + 3 * last.whole / 20, `${what}: nor are there many (${last.all.length} for ${Math.round(last.whole)} ms)`);
}

// A camera moves, and what was cheap becomes dear.
const costs = new Costs(OVERHEAD), size = levels.at(-2);
draw(costs, size, () => 1e-4);
const moved = draw(costs, levels[0], () => 0.5), then = draw(costs, size, () => 0.5);
report(moved.once && then.longest < LONGEST, `after a coarse picture a change is known (${then.longest.toFixed(1)} ms)`);

// On a machine that has more to do, tiles are larger, not fewer pixels at a time.
for (const [what, costOf] of Object.entries(pictures)) {
    const costs = new Costs(OVERHEAD), all = levels.map(size => draw(costs, size, costOf, 20)), last = draw(costs, levels.at(-1), costOf, 0);
    report(all.at(-1).all.length < 80 + last.whole / 10, `${what}: tiles that wait are not many (${all.at(-1).all.length} for ${Math.round(last.whole)} ms of work)`);
}

// Times that rise with pixels are told from those that do not: a checker of sizes that never change would be fooled.
const even = draw(new Costs(OVERHEAD), size, () => 0.5), cheap = draw(new Costs(OVERHEAD), size, () => 1e-4);
report(even.all.length > 20 * cheap.all.length, `dear pictures have more tiles (${even.all.length}) than cheap ones (${cheap.all.length})`);
console.log(`1..${number}`);
process.exitCode = failed ? 1 : 0;
