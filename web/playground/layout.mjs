// layout.mjs: light or dark, how wide the text is, and what is above on phones.
const THEME = 'krs-theme', WIDTH = 'krs-width';
const themes = ['', 'light', 'dark'], titles = { '': 'as the system', light: 'light', dark: 'dark' };

const stored = name => {
    try {
        return localStorage.getItem(name);
    } catch {
        return null;
    }
};
const store = (name, value) => {
    try {
        localStorage.setItem(name, value);
    } catch {
        // It is forgotten where nothing may be kept.
    }
};

export class Layout {
    constructor(parts) {
        Object.assign(this, parts);
        this.#setTheme(themes.includes(stored(THEME)) ? stored(THEME) : '');
        this.theme.addEventListener('click', () => this.#setTheme(themes[(themes.indexOf(this.chosen) + 1) % themes.length]));
        this.#setWidth(Number(stored(WIDTH)) || 48);
        this.divider.addEventListener('pointerdown', event => this.divider.setPointerCapture(event.pointerId));
        this.divider.addEventListener('pointermove', event => this.#drag(event));
        this.divider.addEventListener('keydown', event => this.#key(event));
        addEventListener('resize', () => this.#order());
        this.#order();
    }

    #setTheme(theme) {
        this.chosen = theme;
        document.documentElement.dataset.theme = theme;
        const says = `Colours: ${titles[theme]}`;
        this.theme.title = says;
        this.theme.querySelector('span').textContent = says;
        store(THEME, theme);
    }

    #setWidth(percent) {
        this.width = Math.round(Math.min(Math.max(percent, 20), 75));
        document.documentElement.style.setProperty('--text-width', this.width);
        this.divider.setAttribute('aria-valuenow', this.width);
        store(WIDTH, this.width);
    }

    #drag(event) {
        if (this.divider.hasPointerCapture(event.pointerId))
            this.#setWidth(100 * event.clientX / this.main.clientWidth);
    }

    #key(event) {
        const step = { ArrowLeft: -2, ArrowRight: 2 }[event.key];
        if (!step)
            return;
        event.preventDefault();
        this.#setWidth(this.width + step);
    }

    // What is first for the eye is first for keys: the text at the left, or below the picture (style.css).
    #order() {
        const below = getComputedStyle(this.main).display === 'flex';
        if (below === (this.text.parentElement === this.below))
            return;
        const focus = this.text.contains(document.activeElement) ? document.activeElement : null;
        if (below)
            this.below.append(this.text);
        else
            this.main.prepend(this.text);
        focus?.focus();
    }
}
