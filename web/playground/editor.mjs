// editor.mjs: the text of the scene, in CodeMirror.
import { closeBrackets, closeBracketsKeymap, completionKeymap } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap, indentWithTab } from '@codemirror/commands';
import { bracketMatching, indentOnInput, indentUnit } from '@codemirror/language';
import { lintGutter, nextDiagnostic, setDiagnostics } from '@codemirror/lint';
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search';
import { EditorState, Prec } from '@codemirror/state';
import { drawSelection, dropCursor, EditorView, highlightActiveLine, highlightActiveLineGutter, keymap, lineNumbers, tooltips } from '@codemirror/view';
import { closeCall, goToDefinition, knowledge, offsetOf } from './complete.mjs';
import { language } from './language.mjs';
import { swatches } from './swatches.mjs';

const severities = { 1: 'error', 2: 'warning', 3: 'info' };

const same = (a, b) => a.line === b.line && a.character === b.character;

function fixOf({ range, data }, text) {
    return data.replacement === undefined ? [] : [{
        name: same(range.start, range.end) ? `Insert ${data.replacement}` : data.replacement === '' ? 'Remove it' : `Replace by ${data.replacement}`,
        from: offsetOf(text, range.start),
        to: offsetOf(text, range.end),
        insert: data.replacement,
    }];
}

// Where tips may be: below what is above the text, and not behind a keyboard on the screen.
function seen({ dom }) {
    const { offsetLeft: left, offsetTop, width, height } = visualViewport, { top } = dom.closest('#below, main').getBoundingClientRect();
    return { left, top: Math.max(top, offsetTop), right: left + width, bottom: offsetTop + height };
}

export class Editor {
    // The text has a name.  `changed` is told that a user has changed it, `run` that it is wanted now, `said` what is worth a
    // word; `ask` asks the compiler.
    constructor(parent, { name, changed, run, said, ask }) {
        // An answer that does not come is none.
        const asked = (...question) => ask(...question).catch(() => null);
        this.view = new EditorView({ parent, state: EditorState.create({ extensions: this.#extensions({ name, changed, run, said, ask: asked }) }) });
    }

    #extensions({ name, changed, run, said, ask }) {
        // Tab indents; after Escape it leaves the editor, until something is typed.
        const leave = view => {
            view.setTabFocusMode(true);
            said('Tab leaves the text now.');
            return true;
        };
        return [
            lineNumbers(), lintGutter(), history(), drawSelection(), dropCursor(), indentOnInput(), indentUnit.of('    '),
            bracketMatching(), closeBrackets(), highlightActiveLine(), highlightActiveLineGutter(),
            highlightSelectionMatches(), search({ top: true }), knowledge(ask), language, swatches, EditorView.lineWrapping,
            EditorState.tabSize.of(4), tooltips({ tooltipSpace: seen }),
            EditorView.contentAttributes.of({ 'aria-label': 'Text of the scene', 'spellcheck': 'false', 'autocapitalize': 'off' }),
            Prec.high(keymap.of([
                { key: 'Mod-Enter', run: () => (run(), true) },
                { key: 'F8', run: nextDiagnostic },
                { key: 'F12', run: goToDefinition(ask, name) },
            ])),
            keymap.of([...closeBracketsKeymap, ...completionKeymap, ...searchKeymap, ...historyKeymap, ...defaultKeymap,
                       indentWithTab, { key: 'Escape', run: view => closeCall(view) || leave(view) }]),
            EditorView.domEventHandlers({ blur: (event, view) => view.setTabFocusMode(false) }),
            EditorView.updateListener.of(update => {
                if (!update.docChanged)
                    return;
                update.view.setTabFocusMode(false);
                changed();
            }),
        ];
    }

    get text() { return this.view.state.doc.toString(); }

    // What is alike at both ends stays, so that marks and the cursor do.  It can be undone.
    set text(text) {
        const old = this.text;
        if (old === text)
            return;
        const shorter = Math.min(old.length, text.length);
        let begin = 0, end = 0;
        while (begin < shorter && old[begin] === text[begin])
            begin++;
        while (end < shorter - begin && old[old.length - 1 - end] === text[text.length - 1 - end])
            end++;
        this.view.dispatch({ changes: { from: begin, to: old.length - end, insert: text.slice(begin, text.length - end) } });
    }

    // Shows what a compiler said of a text, unless it is another by now.
    show(diagnostics, text, name) {
        if (text !== this.text)
            return;
        const { doc } = this.view.state;
        this.view.dispatch(setDiagnostics(this.view.state, diagnostics.filter(({ uri }) => uri === name).map(diagnostic => ({
            from: offsetOf(doc, diagnostic.range.start),
            to: offsetOf(doc, diagnostic.range.end),
            severity: severities[diagnostic.severity],
            source: diagnostic.code,
            message: [diagnostic.message, diagnostic.data.help].filter(Boolean).join('\n'),
            actions: fixOf(diagnostic, doc).map(fix => ({ name: fix.name, apply: () => this.apply(fix) })),
        }))));
    }

    apply({ from, to, insert }) {
        this.view.dispatch({ changes: { from, to, insert }, selection: { anchor: from + insert.length }, userEvent: 'input.fix' });
        this.view.focus();
    }

    fixes(diagnostic) { return fixOf(diagnostic, this.view.state.doc); }

    // Goes to a place.
    go(position) {
        const anchor = offsetOf(this.view.state.doc, position);
        this.view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: 'center' }) });
        this.view.focus();
    }

    // Writes into places of the text: offsets of UTF-16, each with what stands there then.
    write(changes) { this.view.dispatch({ changes }); }

    focus() { this.view.focus(); }
}
