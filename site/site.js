// site.js: what pages do: light and dark, searching, scenes that can be turned, and texts to copy.
'use strict';
(() => {
    const root = document.documentElement.dataset.root, make = (name, properties = {}, ...children) => {
        const element = Object.assign(document.createElement(name), properties);
        element.append(...children);
        return element;
    };

    // ---- light and dark ----

    const theme = document.getElementById('theme');
    const isDark = () => (document.documentElement.dataset.theme || (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light')) === 'dark';
    const tell = () => { theme.title = isDark() ? 'Show it light' : 'Show it dark'; };
    theme.addEventListener('click', () => {
        document.documentElement.dataset.theme = isDark() ? 'light' : 'dark';
        tell();
        try {
            localStorage.setItem('krs-theme', document.documentElement.dataset.theme);
        } catch {
            // It holds for this page alone.
        }
    });
    tell();

    // ---- contents ----

    const contents = document.querySelector('.contents details');
    const narrow = matchMedia('(max-width: 900px)'), fold = () => { contents.open = !narrow.matches; };
    if (contents) {
        fold();
        narrow.addEventListener('change', fold);
        const here = contents.querySelector('[aria-current]'), box = contents.closest('.contents');
        if (here && !narrow.matches)
            box.scrollTop = Math.max(here.offsetTop - box.clientHeight / 2, 0);
    }
    const outline = new Map([...document.querySelectorAll('.outline a')].map(link => [decodeURIComponent(link.hash.slice(1)), link]));
    if (outline.size > 0) {
        const heads = [...outline.keys()].map(id => document.getElementById(id));
        const mark = () => {
            const at = heads.findLast(head => head.getBoundingClientRect().top < 140) ?? heads[0];
            for (const [id, link] of outline)
                id === at.id ? link.setAttribute('aria-current', 'true') : link.removeAttribute('aria-current');
            const link = outline.get(at.id), around = link.closest('.outline'), { top, bottom } = link.getBoundingClientRect(), box = around.getBoundingClientRect();
            if (top < box.top + 60 || bottom > box.bottom - 60)
                around.scrollTop += top - (box.top + box.bottom) / 2;
        };
        addEventListener('scroll', mark, { passive: true });
        mark();
    }

    // ---- searching ----

    const finder = document.getElementById('finder'), field = finder.querySelector('input'), results = finder.querySelector('ol'), status = finder.querySelector('p');
    let rows = null;
    globalThis.krsSearch = list => { rows = list.map(([title, page, place, text]) => ({ title, page, place, text, low: text.toLowerCase(), name: title.toLowerCase() })); };
    let asked = false;
    function load() {
        if (!asked)
            document.head.append(make('script', { src: `${root}search.js`, onload: find }));
        asked = true;
    }

    // How well a row has a word: in its name, at the beginning of a word of its text, or anywhere.
    function worth({ name, low, page }, word) {
        if (name === word || name === `.${word}` || name.startsWith(`${word}(`) || name === `krs ${word}`)
            return page.startsWith('Shapes') || page.startsWith('Functions') ? 130 : 100;
        const at = name.indexOf(word);
        if (at >= 0)
            return at === 0 || /\W/.test(name[at - 1]) ? 60 : 20;
        const below = low.indexOf(word);
        return below < 0 ? 0 : below === 0 || /\W/.test(low[below - 1]) ? 8 : 3;
    }

    function excerpt({ text, low }, words) {
        const places = words.map(word => low.indexOf(word)).filter(at => at >= 0), from = Math.max(Math.min(...places, low.length) - 50, 0);
        const piece = (places.length ? (from > 0 ? '... ' : '') + text.slice(from, from + 170) : text.slice(0, 170)), shown = make('span');
        const pattern = new RegExp(words.map(word => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')).join('|'), 'gi');
        let at = 0;
        for (const match of piece.matchAll(pattern)) {
            shown.append(piece.slice(at, match.index), make('mark', {}, match[0]));
            at = match.index + match[0].length;
        }
        shown.append(piece.slice(at));
        return shown;
    }

    function find() {
        const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
        if (!rows || words.length === 0) {
            results.replaceChildren();
            status.textContent = '';
            return;
        }
        const best = rows.map(row => {
            const each = words.map(word => worth(row, word));
            return { row, sum: each.some(value => value === 0) ? 0 : each.reduce((a, b) => a + b) };
        }).filter(({ sum }) => sum > 0).sort((a, b) => b.sum - a.sum);
        results.replaceChildren(...best.slice(0, 14).map(({ row }) => make('li', {}, make('a', { href: root + row.place },
            make('b', {}, row.title), ...(row.page ? [make('small', {}, row.page)] : []), excerpt(row, words)))));
        status.textContent = best.length === 0 ? 'Nothing has all these words.' : best.length > 14 ? `${best.length} places; the first 14 are shown.` : '';
    }

    function open() {
        load();
        finder.showModal();
        field.select();
    }
    document.getElementById('search').addEventListener('click', open);
    field.addEventListener('input', find);
    results.addEventListener('click', event => event.target.closest('a') && finder.close());
    finder.addEventListener('click', event => event.target === finder && finder.close());
    finder.addEventListener('keydown', event => {
        const links = [...results.querySelectorAll('a')], at = links.indexOf(document.activeElement);
        if (event.key === 'Enter' && document.activeElement === field) {
            event.preventDefault();
            links[0]?.click();
        } else if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
            event.preventDefault();
            const next = at + (event.key === 'ArrowDown' ? 1 : -1);
            (next < 0 ? field : links[Math.min(next, links.length - 1)])?.focus();
        }
    });
    addEventListener('keydown', event => {
        const writing = event.target.closest?.('input, textarea, select, [contenteditable], krs-view');
        if ((event.key === '/' && !writing && !event.ctrlKey && !event.metaKey) || (event.key === 'k' && (event.ctrlKey || event.metaKey))) {
            event.preventDefault();
            open();
        }
    });

    // ---- texts to copy ----

    for (const text of document.querySelectorAll('article pre:not(.signature, .said), .install pre')) {
        const button = make('button', { type: 'button', className: 'copy', textContent: 'Copy' });
        button.addEventListener('click', async () => {
            try {
                await navigator.clipboard.writeText(text.textContent);
                button.textContent = 'Copied';
            } catch {
                getSelection().selectAllChildren(text);
                button.textContent = 'Press Ctrl C';
            }
            setTimeout(() => { button.textContent = 'Copy'; }, 2000);
        });
        const around = make('div', { className: 'text' });
        text.replaceWith(around);
        around.append(text, button);
    }

    // ---- scenes that can be turned ----

    const hex = value => `#${value.map(part => Math.round(255 * (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055)).toString(16).padStart(2, '0')).join('')}`;
    const linear = colour => [1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16) / 255).map(part => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));

    // A slider for each number with a range, a well for each colour, a box for each switch.
    function control(scene, { name, kind, value, low, high }) {
        const input = kind === 'color' ? make('input', { type: 'color', value: hex(value) })
            : kind === 'switch' ? make('input', { type: 'checkbox', checked: value[0] !== 0 })
            : value.length === 1 && Number.isFinite(low[0]) && Number.isFinite(high[0]) ? make('input', { type: 'range', min: low[0], max: high[0], step: 'any', value: value[0] }) : null;
        if (!input)
            return [];
        input.addEventListener('input', () => scene.set(name, kind === 'color' ? linear(input.value) : kind === 'switch' ? Number(input.checked) : Number(input.value)).catch(() => {}));
        return [make('label', {}, make('span', {}, name), input)];
    }

    async function show(figure) {
        const box = figure.querySelector('.view'), button = figure.querySelector('.turn');
        if (box.querySelector('krs-view'))
            return;
        button.hidden = true;
        box.dataset.state = 'coming';
        await import(new URL(`${root}playground/krs/index.mjs`, location.href));
        const view = make('krs-view', { samples: 32 });
        view.setAttribute('controls', '');
        view.setAttribute('role', 'img');
        view.setAttribute('aria-label', 'The scene. Drag to turn it.');
        view.addEventListener('krs-error', () => { box.dataset.state = 'failed'; });
        view.addEventListener('krs-frame', ({ detail }) => {
            if (detail.samples < 1)
                return;
            // The time runs where pictures come fast enough to be followed.
            if (box.dataset.state === 'coming' && view.scene?.animated && detail.elapsed < 3000 && !matchMedia('(prefers-reduced-motion: reduce)').matches)
                view.playing = true;
            box.dataset.state = 'there';
        });
        box.append(view);
        const { ok, diagnostics } = await view.update(figure.querySelector('pre[data-language="krs"]').textContent, { name: 'scene.krs' });
        if (!ok) {
            box.dataset.state = 'failed';
            throw new Error(diagnostics[0]?.message);
        }
        figure.querySelector('.sliders').replaceChildren(...view.scene.parameters.flatMap(parameter => control(view.scene, parameter)));
    }
    for (const figure of document.querySelectorAll('figure.scene'))
        figure.querySelector('.turn')?.addEventListener('click', () => show(figure));
    // The first scene comes by itself, when all else is there and nobody asked for few bytes.
    const soon = document.querySelector('figure[data-soon]');
    if (soon && !navigator.connection?.saveData)
        addEventListener('load', () => (globalThis.requestIdleCallback ?? setTimeout)(() => show(soon)));
})();
