// language.mjs: the language for CodeMirror: colours of tokens, indentation, comments.
//
// Classes of words are those of compiler/front/token.def, which the build makes into words.json.
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { Tag, tags } from '@lezer/highlight';
import words from 'krs-words';

// A class of token.def, or of what the lexer calls by no word, with the tag of CodeMirror that is nearest to it.
const classes = {
    statement: tags.definitionKeyword, control: tags.controlKeyword, operator_word: tags.operatorKeyword,
    constant: tags.bool, operator: tags.operator, punctuation: tags.punctuation, stage: tags.moduleKeyword,
    label: tags.propertyName, method: Tag.define(tags.propertyName), call: tags.function(tags.variableName),
    number: tags.number, colour: tags.color, string: tags.string, comment: tags.comment, doc: tags.docComment,
};
export const classNames = Object.keys(classes);

const classOf = new Map(Object.entries(words).flatMap(([name, spellings]) =>
    spellings.map(spelling => [spelling, name.toLowerCase()])));
const signs = [...classOf.keys()].filter(spelling => /^\W/.test(spelling)).sort((a, b) => b.length - a.length);
const stages = new Set(['kernel', 'reflect', 'mobius']), messages = new Set(['print', 'assert']);

function wordClass(word, stream, state) {
    if (state.last === '.')
        return 'method';
    if (stream.match(/^\s*:/, false))
        return 'label';
    if (classOf.has(word))
        return classOf.get(word);
    if (state.begins && stages.has(word))
        return 'stage';
    if (stream.match(/^\s*\(/, false))
        return messages.has(word) ? 'stage' : 'call';
    return null;
}

function blockComment(stream, state) {
    state.comment = !stream.skipTo('*/');
    if (state.comment)
        stream.skipToEnd();
    else
        stream.match('*/');
    return 'comment';
}

const outside = {
    startState: () => ({ comment: false, begins: true, last: '', depth: [] }),
    copyState: state => ({ ...state, depth: [...state.depth] }),
    token(stream, state) {
        if (state.comment)
            return blockComment(stream, state);
        if (stream.eatSpace())
            return null;
        if (stream.match(/^\/\/.*/))
            return /^\/\/\/(?!\/)/.test(stream.current()) ? 'doc' : 'comment';
        if (stream.match('/*'))
            return blockComment(stream, state);
        const { last } = state;
        let found;
        if (stream.match(/^[A-Za-z_]\w*/))
            found = wordClass(stream.current(), stream, state);
        else if (stream.match(/^"(?:[^"\\]|\\.)*"?/))
            found = 'string';
        else if (stream.match(/^#[0-9A-Fa-f]{6}\b/))
            found = 'colour';
        else if (stream.match(/^\d+(?:\.\d+)?(?:e[-+]?\d+)?(?:deg)?\b/))
            found = 'number';
        else {
            const sign = signs.find(spelling => stream.match(spelling));
            if (!sign)
                stream.next();
            found = sign ? classOf.get(sign) : 'invalid';
        }
        state.last = stream.current();
        state.begins = ';{}'.includes(state.last) || (last === '' && state.begins);
        if ('([{'.includes(state.last))
            state.depth.push(state.last);
        else if (')]}'.includes(state.last))
            state.depth.pop();
        return found;
    },
    // A statement in a block begins four columns to the right of the line of its brace; what is in parentheses, too.
    indent: (state, after, { unit }) => unit * Math.max(0, state.depth.length - (/^\s*[)\]}]/.test(after) ? 1 : 0)),
    tokenTable: classes,
    languageData: {
        commentTokens: { line: '//', block: { open: '/*', close: '*/' } },
        indentOnInput: /^\s*[)\]}]$/,
        closeBrackets: { brackets: ['(', '[', '{', '"'] },
        wordChars: '_',
    },
};

export const krsLanguage = StreamLanguage.define(outside);

// Colours are properties of style.css, by the name of the class.
export const colours = HighlightStyle.define(Object.entries(classes).map(([name, tag]) => ({ tag, class: `t-${name}` })));

export const language = [krsLanguage, syntaxHighlighting(colours)];
