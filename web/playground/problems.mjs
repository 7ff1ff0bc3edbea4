// problems.mjs: the list of what the compiler says of a text.
import { make } from './element.mjs';

const kinds = { 1: 'error', 2: 'warning', 3: 'info' };
const numbers = { 1: ['mistake', 'mistakes'], 2: ['warning', 'warnings'], 3: ['note', 'notes'] };

// What stands between backquotes is of a text.
const quoted = text => text.split('`').map((piece, i) => (i % 2 ? make('code', '', piece) : piece));

export class Problems {
    // `go` goes to a place of the text, `fixes` finds what could be done about a mistake, `fix` does it.
    constructor(root, calls) {
        Object.assign(this, { root, ...calls });
    }

    show(diagnostics) {
        this.root.hidden = diagnostics.length === 0;
        this.root.querySelector('h2').textContent = [1, 2, 3].map(severity => [diagnostics.filter(d => d.severity === severity).length, numbers[severity]])
            .filter(([count]) => count > 0).map(([count, [one, many]]) => `${count} ${count === 1 ? one : many}`).join(', ');
        this.root.querySelector('ol').replaceChildren(...diagnostics.map(diagnostic => this.#row(diagnostic)));
    }

    #row(diagnostic) {
        const { uri, range: { start }, message, data, severity } = diagnostic, own = uri === this.name;
        const at = own ? `${start.line + 1}:${start.character + 1}` : uri ? `${uri}:${start.line + 1}` : '';
        const place = make('button', 'place', make('span', 'at', at), make('span', '', ...quoted(message),
            ...[data.help, ...data.notes].filter(Boolean).map(text => make('small', '', ...quoted(text)))));
        place.title = `${diagnostic.code}: go there`;
        place.addEventListener('click', () => own && this.go(start));
        const row = make('li', kinds[severity], place);
        for (const fix of own ? this.fixes(diagnostic) : []) {
            const button = make('button', 'fix', fix.name);
            button.addEventListener('click', () => this.fix(fix));
            row.append(button);
        }
        return row;
    }
}
