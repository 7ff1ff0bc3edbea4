// markdown.mjs: documents of the repository as HTML, by markdown-it.
//
// What differs from plain Markdown: a scene is shown with its picture, and before it what another program wrote for the
// same; a table whose head is empty has none; links lead to pages of the site.
import MarkdownIt from 'markdown-it';
import { block, escaped } from './code.mjs';

export const slugOf = title => title.toLowerCase().replace(/[^a-z0-9 _-]/g, '').trim().replace(/ /g, '-');

const isPicture = (tokens, i) => tokens[i]?.type === 'paragraph_open' && tokens[i + 1].children.length === 1 && tokens[i + 1].children[0].type === 'image';
const language = token => token.info.trim();

// Where a table's words are many, its rows are stacked on a narrow page; else it is scrolled.
const LONG_CELL = 26;
// Shorter cells are not broken.
const BRIEF_CELL = 14;

export class Markdown {
    // `link`, `titleOf` and `picture` are given what a document names, and the place of the document; `scene` shows a scene.
    constructor({ link, titleOf, picture, scene }) {
        Object.assign(this, { link, titleOf, picture, scene });
        this.parser = new MarkdownIt();
        const { rules } = this.parser.renderer;
        rules.heading_open = (tokens, i, options, env, renderer) => {
            const level = Number(tokens[i].tag[1]), title = textOf(tokens[i + 1]);
            const id = unique(slugOf(title), env.ids);
            tokens[i].attrSet('id', id);
            if (level > 1)
                env.heading = { level, title, id };
            return renderer.renderToken(tokens, i, options);
        };
        rules.heading_close = (tokens, i, options, env, renderer) => {
            const { level, title, id } = env.heading ?? {};
            return (tokens[i].tag === `h${level}` ? ` <a class="anchor" href="#${id}" aria-label="Link to ${escaped(title)}">#</a>` : '') +
                renderer.renderToken(tokens, i, options);
        };
        rules.link_open = (tokens, i, options, env, renderer) => {
            tokens[i].attrSet('href', this.link(tokens[i].attrGet('href'), env));
            return renderer.renderToken(tokens, i, options);
        };
        rules.image = (tokens, i, _, env) => this.picture(tokens[i].attrGet('src'), tokens[i].content, env);
        rules.fence = (tokens, i) => block(tokens[i].content, language(tokens[i]));
        rules.code_block = (tokens, i) => block(tokens[i].content);
        rules.html_inline = (tokens, i) => tokens[i].content;
        rules.table_open = (tokens, i) => {
            const form = tokens[i].meta;
            return `<div class="table ${form.kind}"${form.kind === 'wide' ? ' tabindex="0" role="region" aria-label="Table"' : ''}><table>\n`;
        };
        rules.table_close = () => '</table></div>\n';
    }

    // The HTML of a text, and its title.
    render(text, env) {
        Object.assign(env, { ids: new Map(), heading: null });
        const tokens = this.parser.parse(text, env);
        const title = tokens[0]?.type === 'heading_open' && tokens[0].tag === 'h1' ? textOf(tokens[1]) : null;
        formTables(tokens);
        this.#nameLinks(tokens, env);
        let html = '', from = 0;
        const plain = to => { html += this.parser.renderer.render(tokens.slice(from, to), this.parser.options, env); };
        for (let i = 0; i < tokens.length; i++) {
            if (tokens[i].type !== 'fence' || language(tokens[i]) !== 'krs')
                continue;
            const other = tokens[i - 1]?.type === 'fence' && language(tokens[i - 1]) !== 'krs' && i - 1 >= from ? tokens[i - 1] : null;
            plain(other ? i - 1 : i);
            const pictured = isPicture(tokens, i + 1), image = pictured ? tokens[i + 2].children[0] : null;
            html += this.scene(tokens[i].content, env, { other: other && { text: other.content, language: language(other) },
                picture: image && { src: image.attrGet('src'), alt: image.content } });
            i += pictured ? 3 : 0;
            from = i + 1;
        }
        plain(tokens.length);
        return { html, title };
    }

    // A link that shows the name of a document shows its title.
    #nameLinks(tokens, env) {
        for (const { children } of tokens.filter(token => token.type === 'inline'))
            for (const [i, token] of children.entries())
                if (token.type === 'link_open' && children[i + 1].type === 'text' && /^[\w/.-]+\.md$/.test(children[i + 1].content))
                    children[i + 1].content = this.titleOf(token.attrGet('href'), env) ?? children[i + 1].content;
    }

    inline(text, env = { place: '' }) { return this.parser.renderInline(text, env); }
    blocks(text, env = { place: '' }) { return this.render(text, env).html; }
}

const textOf = inline => inline.children.map(child => child.content).join('');

export function unique(id, ids) {
    const count = ids.get(id) ?? 0;
    ids.set(id, count + 1);
    return count ? `${id}-${count}` : id;
}

// Tells what each table is like, and leaves out empty heads.
function formTables(tokens) {
    for (let i = 0; i < tokens.length; i++) {
        if (tokens[i].type !== 'table_open')
            continue;
        const end = tokens.findIndex((token, at) => at > i && token.type === 'table_close');
        const cells = tokens.slice(i, end).filter(token => token.type === 'inline');
        const head = tokens.findIndex((token, at) => at > i && token.type === 'thead_close');
        const columns = tokens.slice(i, head).filter(token => token.type === 'th_open').length;
        const heads = tokens.slice(i, head).filter(token => token.type === 'inline').map(textOf);
        const longest = Math.max(...cells.map(cell => cell.content.length)), pictures = cells.some(cell => cell.children.some(child => child.type === 'image'));
        tokens[i].meta = { kind: pictures ? 'pictures' : columns <= 2 ? 'two' : longest > LONG_CELL ? 'stacked' : 'wide' };
        let column = 0;
        for (let at = head; at < end; at++) {
            if (tokens[at].type === 'tr_open')
                column = 0;
            if (tokens[at].type === 'td_open' && heads[column++])
                tokens[at].attrSet('data-head', heads[column - 1]);
            if (tokens[at].type === 'td_open' && tokens[at + 1].content.length <= BRIEF_CELL)
                tokens[at].attrSet('class', 'brief');
        }
        if (heads.every(title => title.trim() === ''))
            tokens.splice(i + 1, head - i);
    }
}
