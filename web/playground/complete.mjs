// complete.mjs: what the compiler knows of a text while it is written: words that fit, what a word means, the call that is
// being written, and where a name is defined.  Questions and answers are those of the Language Server Protocol.
import { autocompletion, snippet } from '@codemirror/autocomplete';
import { StateEffect, StateField } from '@codemirror/state';
import { hoverTooltip, showTooltip, ViewPlugin } from '@codemirror/view';
import { make } from './element.mjs';

const kinds = { 2: 'method', 3: 'function', 5: 'property', 6: 'variable', 7: 'class', 10: 'property', 14: 'keyword', 16: 'constant', 21: 'constant' };
const called = new Set(['method', 'function', 'class']);

export function positionAt(doc, offset) {
    const line = doc.lineAt(offset);
    return { line: line.number - 1, character: offset - line.from };
}

// A place as compilers say it, in a text that may have become another since.
export function offsetOf(doc, { line, character }) {
    if (line >= doc.lines)
        return doc.length;
    const { from, to } = doc.line(line + 1);
    return Math.min(from + character, to);
}

// ---- text with marks ----

// Blocks of code between ```, and paragraphs with code between `.
function shown(markdown) {
    const pieces = markdown.split(/^```.*\n?/m).flatMap((piece, i) => i % 2 ? [make('pre', '', piece.trimEnd())]
        : piece.split(/\n\n+/).filter(text => text.trim()).map(text =>
            make('p', '', ...text.trim().split('`').map((part, k) => (k % 2 ? make('code', '', part) : part)))));
    return make('div', 'explained', ...pieces);
}

// ---- words that fit ----

// Puts a function with its parentheses, and the cursor between them.
function applyCall(view, { label }, from, to) {
    const open = view.state.sliceDoc(to, to + 1) === '(';
    snippet(open ? `${label}\${}` : `${label}(\${})\${}`)(view, null, from, to);
}

function option({ label, kind, detail, documentation, sortText, textEdit }) {
    const type = kinds[kind] ?? 'text';
    return {
        label, type, sortText, info: documentation ? () => shown(documentation) : undefined,
        detail: detail?.startsWith(`${label}(`) ? detail.slice(label.length) : detail,
        apply: called.has(type) ? applyCall : textEdit?.newText,
    };
}

// `ask` takes a question, a text and parameters.
const completions = ask => async context => {
    const { state, pos } = context, before = state.sliceDoc(state.doc.lineAt(pos).from, pos);
    if (!context.explicit && !/[A-Za-z_]\w*$|[^\d.]\.$|#$|"[^"]*$/.test(before) || /\/\//.test(before))
        return null;
    const items = await ask('textDocument/completion', state.doc.toString(), { position: positionAt(state.doc, pos) });
    if (!items?.length)
        return null;
    const from = items[0].textEdit ? offsetOf(state.doc, items[0].textEdit.range.start) : context.matchBefore(/\w*/).from;
    return { from, options: items.map(option), validFor: /^#?\w*$/ };
};

// ---- what a word means ----

const meanings = ask => hoverTooltip(async (view, offset) => {
    const { doc } = view.state, hover = await ask('textDocument/hover', doc.toString(), { position: positionAt(doc, offset) });
    if (!hover || view.state.doc !== doc)
        return null;
    const { start, end } = hover.range;
    return { pos: offsetOf(doc, start), end: offsetOf(doc, end), above: true, create: () => ({ dom: shown(hover.contents.value) }) };
}, { hoverTime: 400 });

// ---- the call that is being written ----

const setCall = StateEffect.define();

const callField = StateField.define({
    create: () => null,
    update(tip, transaction) {
        for (const effect of transaction.effects)
            if (effect.is(setCall))
                return effect.value;
        return transaction.docChanged && tip ? { ...tip, pos: transaction.changes.mapPos(tip.pos) } : tip;
    },
    provide: field => showTooltip.from(field),
});

function callTip({ signatures, activeSignature = 0, activeParameter = 0 }, pos) {
    const { label, parameters = [] } = signatures[activeSignature], [from, to] = parameters[activeParameter]?.label ?? [0, 0];
    const dom = () => make('div', 'call', make('code', '', label.slice(0, from), make('b', '', label.slice(from, to)), label.slice(to)));
    return { pos, above: true, strictSide: true, create: () => ({ dom: dom() }) };
}

const calls = ask => [callField, ViewPlugin.fromClass(class {
    update(update) {
        if (!update.docChanged && !(update.selectionSet && update.startState.field(callField)))
            return;
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.look(update.view), 120);
    }

    async look(view) {
        const { state } = view, { head } = state.selection.main, line = state.sliceDoc(state.doc.lineAt(head).from, head);
        // Most places are in no call: these are not asked about.
        const inCall = [...line].reduce((depth, sign) => depth + (sign === '(') - (sign === ')'), 0) > 0 && view.hasFocus;
        const help = inCall ? await ask('textDocument/signatureHelp', state.doc.toString(), { position: positionAt(state.doc, head) }) : null;
        if (view.state.doc !== state.doc || view.state.selection.main.head !== head)
            return;
        const tip = help?.signatures?.length ? callTip(help, head) : null;
        if (tip || view.state.field(callField))
            view.dispatch({ effects: setCall.of(tip) });
    }

    destroy() { clearTimeout(this.timer); }
})];

// Takes the tip of a call away; false: there is none.
export function closeCall(view) {
    if (!view.state.field(callField))
        return false;
    view.dispatch({ effects: setCall.of(null) });
    return true;
}

// ---- where a name is defined ----

export const goToDefinition = (ask, name) => view => {
    const { doc, selection } = view.state;
    ask('textDocument/definition', doc.toString(), { position: positionAt(doc, selection.main.head) }).then(found => {
        const place = Array.isArray(found) ? found[0] : found;
        if (place?.uri !== name || view.state.doc !== doc)
            return;
        view.dispatch({ selection: { anchor: offsetOf(doc, place.range.start), head: offsetOf(doc, place.range.end) }, scrollIntoView: true });
    });
    return true;
};

export const knowledge = ask => [autocompletion({ override: [completions(ask)], icons: false }), meanings(ask), calls(ask)];
