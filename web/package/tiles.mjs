// tiles.mjs: how a picture is cut into tiles.  A tile is a block of pixels that takes about as long as is wanted, by what
// the pixels of that part of the picture have cost before: pictures are expensive in places.
//
// Times are milliseconds.  A tile may wait for others, on a machine that has more to do: so costs are means, and what a few
// pixels take counts as the draw's own time, since fewer would be no faster.

const wantedTime = 20, longestTime = 50; // of the pixels of a tile
const side = 8, narrowest = 2;           // pixels: cards draw blocks of them side by side, and rows of one only half as fast
const few = 32;                          // pixels
const least = 0.2;                       // of a tile's time, that its pixels take: the rest may be an error of what is known
const growth = 4;                        // of a tile over those before, at most
const across = 64, down = 36;            // parts of a picture whose costs are known
const learns = 0.25, forgets = 0.99;     // what a draw costs by itself, and the dearest pixel, with each tile
const surprise = 4;                      // times as long as expected a picture may take

// How long the pixels of each part of a picture took.
class Sums {
    times = new Float64Array(across * down);
    pixels = new Float64Array(across * down);

    // The mean; where nothing is known, something else.
    meanOf(part, otherwise) { return this.pixels[part] > 0 ? this.times[part] / this.pixels[part] : otherwise; }
}

// What a draw costs by itself, and pixels of each part: by the last picture, and by the present one as far as it is.
export class Costs {
    constructor(overhead) {
        this.overhead = overhead;
        this.before = new Sums();
        this.now = new Sums();
        this.last = Infinity; // of a pixel of the last tile, where nothing is known
        this.dearest = 0;     // of a pixel of a tile that took as long as is wanted
        this.most = 0;        // pixels of the next tile
    }

    // How long the pixels of a tile are to take.
    get wanted() { return Math.min(Math.max(wantedTime, 2 * this.overhead), longestTime); }

    // Calls `use` with the number of each part that a tile of such a picture lies in.
    #visit({ x, y, width, height }, size, use) {
        const last = (end, parts, pixels) => Math.ceil(parts * end / pixels) - 1;
        for (let row = Math.floor(down * y / size.height); row <= last(y + height, down, size.height); row++)
            for (let column = Math.floor(across * x / size.width); column <= last(x + width, across, size.width); column++)
                use(row * across + column);
    }

    // How long the pixels of a tile are expected to take.  A part of which a piece was cheap may still be dear.
    expected(tile, size) {
        let sum = 0, count = 0;
        this.#visit(tile, size, part => {
            const before = this.before.meanOf(part, NaN), now = this.now.meanOf(part, before >= 0 ? before : this.last);
            sum += before > now ? before : now;
            count++;
        });
        return sum / count * tile.width * tile.height;
    }

    // Tells whether a picture should be there after this time.  It may be another than those before, with what was dear all over.
    isSoonOver(size, time) {
        const pixels = this.expected({ x: 0, y: 0, ...size }, size), draws = Math.ceil(pixels / this.wanted);
        return pixels + draws * this.overhead < time && this.dearest * size.width * size.height < surprise * time;
    }

    // Tells that a picture has all its tiles, and another begins.
    beginPicture() {
        const { pixels, times } = this.before;
        this.now.pixels.forEach((count, part) => {
            if (count > 0)
                [pixels[part], times[part]] = [count, this.now.times[part]];
        });
        this.now = new Sums();
    }

    // Takes how long a tile took, and returns what of it its pixels did.
    learn(tile, size, time) {
        const pixels = tile.width * tile.height;
        if (pixels <= few)
            this.overhead += learns * (time - this.overhead);
        const beyond = Math.max(time - this.overhead, least * time);
        this.#visit(tile, size, part => {
            this.now.times[part] += beyond;
            this.now.pixels[part] += pixels;
        });
        this.last = beyond / pixels;
        this.dearest = Math.max(forgets * this.dearest, beyond > this.wanted / 2 ? this.last : 0);
        this.most = Math.max(growth * pixels, time < longestTime ? this.most : 0);
        return beyond;
    }
}

// One after the other the tiles of a picture, in strips from the top.  A strip has eight rows, or more where these are soon drawn.
export class Tiles {
    constructor(costs, width, height) {
        Object.assign(this, { costs, size: { width, height }, x: 0, y: 0, rows: 0, expected: 0, taken: 0 });
        costs.beginPicture();
    }

    get isOver() { return this.y >= this.size.height; }

    // How much more than expected this picture takes: smaller pixels may cost more everywhere.
    get #rise() { return this.expected > this.costs.wanted ? Math.min(Math.max(this.taken / this.expected, 1), growth) : 1; }

    #fits(tile) {
        const { costs, size } = this;
        return tile.width * tile.height <= costs.most && this.#rise * costs.expected(tile, size) <= costs.wanted;
    }

    // The largest width or height up to `left` with which a tile fits, or the least.
    #grown(least, left, tileOf) {
        let length = Math.min(least, left);
        while (length < left) {
            const next = Math.min(length < side ? 2 * length : length + side * Math.ceil(length / side / 4), left);
            if (!this.#fits(tileOf(next)))
                break;
            length = next;
        }
        return length;
    }

    next() {
        const { x, y, size } = this;
        if (x === 0)
            this.rows = this.#grown(side, size.height - y, height => ({ x, y, width: size.width, height }));
        const tile = { x, y, height: this.rows };
        return this.tile = { ...tile, width: this.#grown(narrowest, size.width - x, width => ({ ...tile, width })) };
    }

    // Goes on after the tile, which took so long.
    took(time) {
        const { tile, costs, size } = this, expected = costs.expected(tile, size), taken = costs.learn(tile, size, time);
        if (Number.isFinite(expected)) {
            this.expected += expected;
            this.taken += taken;
        }
        this.x += tile.width;
        if (this.x >= size.width) {
            this.x = 0;
            this.y += tile.height;
        }
    }
}
