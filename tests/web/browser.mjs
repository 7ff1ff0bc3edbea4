// browser.mjs: drives Chromium without a window, by the DevTools protocol over a pipe, for tests and figures of pages.
//
//     const server = await serve('build/web'), browser = await launch();
//     const page = await browser.open(`${server.url}/index.html`);
//     await page.evaluate(async radius => (await view.scene).set('radius', radius), 2);
//     await page.screenshot('picture.png');
//     page.errors;                      // what the console has said of errors, and exceptions that nobody caught
//     await browser.close(); server.close();
import { spawn, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

export const findChromium = () => [process.env.CHROMIUM, 'chromium', 'chromium-browser', 'google-chrome']
    .find(name => name && spawnSync(name, ['--version'], { stdio: 'ignore' }).status === 0);

// ---- files ----

const types = { html: 'text/html', mjs: 'text/javascript', js: 'text/javascript', css: 'text/css', json: 'application/json',
    wasm: 'application/wasm', png: 'image/png', svg: 'image/svg+xml', jpg: 'image/jpeg', webmanifest: 'application/manifest+json', krs: 'text/plain', ttf: 'font/ttf' };

// Serves folders on a port of this machine, a free one by default: `{ '/': 'build/web', '/examples/': 'examples' }`, or one folder for '/'.
// `asked` are the paths that it was asked for, and those in `missing` are not found.
export async function serve(folders, port = 0) {
    const asked = [], missing = new Set();
    const places = Object.entries(typeof folders === 'string' ? { '/': folders } : folders).sort((a, b) => b[0].length - a[0].length);
    const server = http.createServer((request, response) => {
        const name = decodeURIComponent(new URL(request.url, 'http://here').pathname);
        asked.push(name);
        const [prefix, folder] = missing.has(name) ? [] : places.find(([start]) => name.startsWith(start)) ?? [];
        const file = folder && path.join(folder, path.normalize(`/${name.slice(prefix.length)}`));
        const found = file && [file, path.join(file, 'index.html')].find(f => fs.statSync(f, { throwIfNoEntry: false })?.isFile());
        response.writeHead(found ? 200 : 404, { 'Content-Type': `${types[path.extname(found ?? '').slice(1)] ?? 'text/plain'}; charset=utf-8` });
        response.end(found ? fs.readFileSync(found) : '');
    });
    await new Promise(resolve => server.listen(port, '127.0.0.1', resolve));
    return { url: `http://127.0.0.1:${server.address().port}`, asked, missing, close: () => { server.closeAllConnections?.(); server.close(); } };
}

// ---- the browser ----

export async function launch({ args = [], width = 1280, height = 720 } = {}) {
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'krs-chromium-'));
    const child = spawn(findChromium(), ['--headless=new', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
        '--remote-debugging-pipe', '--no-first-run', '--disable-dev-shm-usage', '--disable-background-timer-throttling',
        `--user-data-dir=${profile}`, `--window-size=${width},${height}`, ...args, 'about:blank'],
    { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    return new Browser(child, profile);
}

class Browser {
    #waiting = new Map();
    #next = 1;
    #sessions = new Map();

    constructor(child, profile) {
        Object.assign(this, { child, profile });
        let rest = Buffer.alloc(0);
        child.stdio[4].on('data', bytes => {
            rest = Buffer.concat([rest, bytes]);
            for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1))
                this.#take(JSON.parse(rest.subarray(0, end).toString()));
        });
        child.stdio[3].on('error', () => {});
        child.on('exit', () => {
            for (const { reject } of this.#waiting.values())
                reject(new Error('the browser has ended'));
            this.#waiting.clear();
        });
    }

    send(method, params = {}, sessionId) {
        const id = this.#next++;
        return new Promise((resolve, reject) => {
            this.#waiting.set(id, { resolve, reject });
            this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
        });
    }

    #take({ id, result, error, method, params, sessionId }) {
        const waiting = this.#waiting.get(id);
        this.#waiting.delete(id);
        if (error)
            waiting?.reject(new Error(error.message));
        else if (waiting)
            waiting.resolve(result);
        else if (method)
            this.#sessions.get(sessionId)?.take(method, params);
    }

    // `inPage` and `inWorkers` are scripts that the page and its workers run before their own; `page.workers` are asked by `evaluate`.
    async open(url, { width = 1280, height = 720, inPage, inWorkers } = {}) {
        const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
        const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
        const page = new Page(this, sessionId, targetId);
        this.#sessions.set(sessionId, page);
        if (inWorkers)
            await page.prepareWorkers(inWorkers);
        for (const domain of ['Page', 'Runtime', 'Log'])
            await page.send(`${domain}.enable`);
        if (inPage)
            await page.send('Page.addScriptToEvaluateOnNewDocument', { source: inPage });
        await page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
        if (url)
            await page.go(url);
        return page;
    }

    async close() {
        const ended = new Promise(resolve => this.child.on('exit', resolve));
        this.send('Browser.close').catch(() => {});
        const timer = setTimeout(() => this.child.kill('SIGKILL'), 5000);
        await ended;
        clearTimeout(timer);
        fs.rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
    }
}

class Page {
    errors = [];
    said = [];
    workers = [];
    #loaded = null;

    constructor(browser, session, target) { Object.assign(this, { browser, session, target }); }

    send(method, params) { return this.browser.send(method, params, this.session); }

    take(method, params) {
        const text = args => args.map(arg => arg.value ?? arg.description ?? '').join(' ');
        if (method === 'Target.attachedToTarget')
            this.prepareWorker(params);
        else if (method === 'Page.loadEventFired')
            this.#loaded?.();
        else if (method === 'Runtime.consoleAPICalled')
            (params.type === 'error' ? this.errors : this.said).push(text(params.args));
        else if (method === 'Runtime.exceptionThrown')
            this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
        else if (method === 'Log.entryAdded' && params.entry.level === 'error')
            this.errors.push(`${params.entry.text} ${params.entry.url ?? ''}`);
    }

    async prepareWorkers(script) {
        this.prepareWorker = async ({ sessionId, targetInfo }) => {
            const worker = new Page(this.browser, sessionId, targetInfo.targetId);
            this.workers.push(worker);
            await worker.evaluate(script);
            await worker.send('Runtime.runIfWaitingForDebugger');
        };
        await this.send('Target.setAutoAttach', { autoAttach: true, waitForDebuggerOnStart: true, flatten: true });
    }

    async go(url) {
        const loaded = new Promise(resolve => { this.#loaded = resolve; });
        await this.send('Page.navigate', { url });
        await loaded;
    }

    // The value of an expression, or of a function with arguments that JSON can have, when its promise is there.
    async evaluate(what, ...args) {
        const expression = typeof what === 'function' ? `(${what})(${args.map(arg => JSON.stringify(arg)).join(', ')})` : what;
        const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true, userGesture: true });
        if (exceptionDetails)
            throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
        return result.value;
    }

    // Waits until an expression is true, and returns what it is.
    async until(what, { seconds = 60, every = 50 } = {}) {
        for (const end = Date.now() + 1000 * seconds; Date.now() < end; await new Promise(resolve => setTimeout(resolve, every))) {
            const value = await this.evaluate(what);
            if (value)
                return value;
        }
        throw new Error(`after ${seconds} s it is not yet so: ${what}`);
    }

    // A picture of the page, or of the part { x, y, width, height }, as PNG.
    async screenshot(file, part) {
        const clip = part && { clip: { scale: 1, ...part } };
        const { data } = await this.send('Page.captureScreenshot', { format: 'png', ...clip });
        const bytes = Buffer.from(data, 'base64');
        if (file)
            fs.writeFileSync(file, bytes);
        return bytes;
    }

    // Moves, presses and releases the mouse: 'mousePressed', 'mouseMoved', 'mouseReleased', 'mouseWheel'.
    mouse(type, x, y, more = {}) {
        return this.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', clickCount: 1, ...more });
    }

    async type(text) { await this.send('Input.insertText', { text }); }

    close() { return this.browser.send('Target.closeTarget', { targetId: this.target }); }
}
