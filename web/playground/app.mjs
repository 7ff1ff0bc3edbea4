// app.mjs: the playground: a text, its picture and its parameters.
import * as krs from './krs/index.mjs';
import { Camera } from './camera.mjs';
import { Downloads } from './download.mjs';
import { Editor } from './editor.mjs';
import { Examples } from './examples.mjs';
import { Layout } from './layout.mjs';
import { Parameters, written } from './parameters.mjs';
import { Problems } from './problems.mjs';
import { pack, unpack } from './share.mjs';

const NAME = 'scene.krs', KEPT = 'krs-playground', FIRST = '04-school';
const PAUSE = 250; // milliseconds without a key before a text is compiled
const $ = id => document.getElementById(id);
const view = $('view'), options = { name: NAME, base: new URL('examples/', document.baseURI) };

// ---- what is said ----

let saying;
function say(text) {
    clearTimeout(saying);
    $('said').textContent = text;
    saying = setTimeout(() => { $('said').textContent = ''; }, 4000);
}

// ---- compiling ----

let pause, busy, compiled = null; // compiled: the text that was answered last, and whether it is a scene

async function compile() {
    const { text } = editor;
    wait();
    clearTimeout(pause);
    try {
        const { ok, diagnostics, change } = await (view.scene ? view.update(text) : view.update(text, options));
        if (change === 'structure')
            $('drawing').hidden = false;
        take(text, ok, diagnostics);
    } catch (error) {
        take(text, false, []);
        say(error.message);
    }
}

// The page says that it waits for an answer when that takes long.
function wait() {
    document.documentElement.dataset.waiting = '';
    busy ??= setTimeout(() => { $('busy').hidden = false; }, PAUSE + 300);
}

function take(text, ok, diagnostics) {
    if (text !== editor.text)
        return; // another answer is on its way
    clearTimeout(busy);
    busy = undefined;
    $('busy').hidden = true;
    delete document.documentElement.dataset.waiting;
    compiled = { text, ok };
    editor.show(diagnostics, text, NAME);
    problems.show(diagnostics);
    $('stale').hidden = ok || !view.scene?.ok;
    if (ok)
        showScene();
    keep();
}

function showScene() {
    const { scene } = view;
    parameters.show(scene.parameters);
    $('play').hidden = $('clock').hidden = !scene.animated;
    if (!scene.animated)
        setPlaying(false);
    downloads.components = scene.components;
}

// A text that is edited is not that of the link any more: who comes again finds the text.
function edited() {
    if (!opening && location.hash)
        history.replaceState(null, '', location.pathname + location.search);
    compileSoon();
}

function compileSoon() {
    wait();
    clearTimeout(pause);
    pause = setTimeout(compile, PAUSE);
}

// ---- the present scene, as it is shared and kept ----

function present() {
    const changed = parameters.changed.map(({ name, value }) => [name, value]);
    return {
        text: editor.text,
        ...(changed.length > 0 && { parameters: Object.fromEntries(changed) }),
        ...(camera.moved && { camera: camera.moved }),
        ...(view.scene?.animated && view.time !== 0 && { time: view.time }),
    };
}

let opening = false;

async function open({ text, parameters: values = {}, camera: place = null, time = 0 }) {
    setPlaying(false);
    opening = true;
    editor.text = text;
    opening = false;
    if (view.scene?.ok)
        await view.scene.reset();
    await compile();
    camera.move(place);
    setTime(time);
    if (!view.scene?.ok)
        return;
    await Promise.all(Object.entries(values).map(([name, value]) => setValue(name, value)));
    parameters.show(view.scene.parameters);
    keep();
}

// A link may have values that are refused.
const setValue = (name, value) => view.scene.set(name, value).catch(error => say(error.message));

// The browser keeps the last scene, for the next visit.
function keep() {
    try {
        localStorage.setItem(KEPT, JSON.stringify(present()));
    } catch {
        // It keeps nothing where that is forbidden.
    }
}

function kept() {
    try {
        return JSON.parse(localStorage.getItem(KEPT));
    } catch {
        return null;
    }
}

// ---- parts of the page ----

const parameters = new Parameters($('parameters'), {
    set: async (name, value) => {
        await setValue(name, value);
        keep();
    },
    write: changed => {
        if (!compiled?.ok || compiled.text !== editor.text || changed.some(({ source }) => source !== NAME)) {
            say('Values are written into a text without mistakes.');
            return;
        }
        editor.write(changed.map(parameter => ({
            from: unitsOf(compiled.text, parameter.start), to: unitsOf(compiled.text, parameter.end), insert: written(parameter) })));
        say('Written. Ctrl Z takes it back.');
    },
});

// The compiler counts bytes, the editor units of UTF-16.
const unitsOf = (text, bytes) => new TextDecoder().decode(new TextEncoder().encode(text).subarray(0, bytes)).length;

const problems = new Problems($('problems'), { name: NAME, go: place => editor.go(place), fix: fix => editor.apply(fix),
                                               fixes: diagnostic => editor.fixes(diagnostic) });
const camera = new Camera(view, { moved: () => { $('home').hidden = !camera.moved; keep(); } });
const downloads = new Downloads($('download'), { view, text: () => editor.text, title: () => examples.current?.title ?? 'scene' });
const editor = new Editor($('editor'), { name: NAME, changed: edited, run: compile, said: say, ask: (...question) => krs.ask(...question, options) });
const examples = new Examples($('examples'), {
    open: async example => {
        const before = editor.text;
        await open({ text: example.text });
        history.replaceState(null, '', location.pathname);
        if (before.trim() !== '')
            say(`${example.title}. Ctrl Z brings your text back.`);
        editor.focus();
    },
});
new Layout({ theme: $('theme'), divider: $('divider'), main: document.querySelector('main'), text: $('text'), below: $('below') });

// ---- buttons and keys ----

for (const dialog of document.querySelectorAll('dialog'))
    dialog.addEventListener('click', event => event.target === dialog && dialog.close());

$('open-examples').addEventListener('click', () => examples.show());
$('open-download').addEventListener('click', () => downloads.show());
$('open-help').addEventListener('click', () => $('help').showModal());

async function format() {
    const { text } = editor, formatted = await krs.format(text, { name: NAME });
    if (formatted.text === null)
        say('A text with mistakes is not laid out.');
    else if (editor.text === text)
        editor.text = formatted.text;
}
$('format').addEventListener('click', format);

async function copy() {
    $('link').select();
    try {
        await navigator.clipboard.writeText($('link').value);
        $('copy').textContent = 'Copied';
    } catch {
        $('copy').textContent = 'Press Ctrl C';
    }
}
$('share').addEventListener('click', async () => {
    const fragment = await pack(present());
    history.replaceState(null, '', fragment);
    $('link').value = location.href;
    $('copy').textContent = 'Copy';
    $('shared').showModal();
    $('copy').focus();
});
$('copy').addEventListener('click', copy);

$('stop').addEventListener('click', () => krs.stop());

addEventListener('keydown', event => {
    if (event.altKey && event.shiftKey && event.code === 'KeyF') {
        event.preventDefault();
        format();
    }
});

// ---- time ----

function setPlaying(playing) {
    view.playing = playing;
    $('play').setAttribute('aria-pressed', String(playing));
}
function setTime(time) {
    view.time = time;
    $('time').value = time.toFixed(1);
}
$('play').addEventListener('click', () => setPlaying(!view.playing));
$('time').addEventListener('input', () => {
    if (!$('time').validity.valid || $('time').value === '')
        return;
    setPlaying(false);
    view.time = Number($('time').value);
});
$('home').addEventListener('click', () => {
    camera.move(null);
    view.focus();
});
view.addEventListener('krs-error', () => { $('drawing').hidden = true; });
view.addEventListener('krs-frame', ({ detail }) => {
    $('drawing').hidden = true;
    $('samples').textContent = detail.samples < 1 ? 'first look' : `${Math.floor(detail.samples)} of ${detail.wanted} samples`;
    if (view.playing && document.activeElement !== $('time'))
        $('time').value = detail.time.toFixed(1);
});

// ---- the beginning ----

// `#example=02-gear` opens an example.
async function openLink() {
    const [, name] = /^#example=(.*)$/.exec(location.hash) ?? [], example = examples.find(name);
    try {
        if (name !== undefined && !example)
            throw new Error(`There is no example ${name.slice(0, 40)}.`);
        return example ? { text: example.text } : await unpack(location.hash);
    } catch (error) {
        say(error.message);
        return null;
    }
}
addEventListener('hashchange', async () => {
    const shared = await openLink();
    if (shared)
        await open(shared);
});

await examples.load();
await open(await openLink() ?? kept() ?? { text: examples.find(FIRST).text });
document.documentElement.dataset.ready = '';
navigator.serviceWorker?.register('service.js');
