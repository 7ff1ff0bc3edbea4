// code.mjs: texts of programs as HTML.  Classes are those of compiler/front/token.def, which the playground has as well;
// words of other languages get the class that is nearest.
import { highlightTree } from '@lezer/highlight';
import hljs from 'highlight.js/lib/core';
import bash from 'highlight.js/lib/languages/bash';
import c from 'highlight.js/lib/languages/c';
import glsl from 'highlight.js/lib/languages/glsl';
import javascript from 'highlight.js/lib/languages/javascript';
import json from 'highlight.js/lib/languages/json';
import python from 'highlight.js/lib/languages/python';
import typescript from 'highlight.js/lib/languages/typescript';
import xml from 'highlight.js/lib/languages/xml';
import { colours, krsLanguage } from '../web/playground/language.mjs';

const escapes = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' };
export const escaped = text => String(text).replace(/[&<>"]/g, sign => escapes[sign]);

export function krs(text) {
    let html = '', at = 0;
    highlightTree(krsLanguage.parser.parse(text), colours, (from, to, name) => {
        const token = text.slice(from, to);
        html += escaped(text.slice(at, from));
        html += `<span class="${name}"${name === 't-colour' ? ` style="--colour: ${token}"` : ''}>${escaped(token)}</span>`;
        at = to;
    });
    return html + escaped(text.slice(at));
}

for (const [name, language] of Object.entries({ bash, c, glsl, javascript, json, python, typescript, xml }))
    hljs.registerLanguage(name, language);
const languages = { c: 'c', sh: 'bash', js: 'javascript', ts: 'typescript', json: 'json', python: 'python', html: 'xml', glsl: 'glsl',
                    wgsl: 'glsl', openscad: 'c', pov: 'c' };
const classes = { keyword: 'statement', literal: 'constant', number: 'number', string: 'string', regexp: 'string', comment: 'comment',
                  doctag: 'doc', title: 'call', built_in: 'call', type: 'constant', meta: 'stage', name: 'statement', tag: 'punctuation',
                  attr: 'label', attribute: 'label', property: 'label', symbol: 'label' };

export function highlighted(text, language) {
    if (language === 'krs')
        return krs(text);
    if (!languages[language])
        return escaped(text);
    return hljs.highlight(text, { language: languages[language] }).value
        .replace(/class="hljs-([a-z_]+)[^"]*"/g, (_, name) => `class="t-${classes[name] ?? 'other'}"`);
}

export const block = (text, language) =>
    `<pre tabindex="0"${language ? ` data-language="${language}"` : ''}><code>${highlighted(text.replace(/\n$/, ''), language)}</code></pre>`;
