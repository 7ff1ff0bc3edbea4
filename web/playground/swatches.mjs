// swatches.mjs: a colour well before each colour in the text.
import { Decoration, MatchDecorator, ViewPlugin, WidgetType } from '@codemirror/view';

class Swatch extends WidgetType {
    constructor(colour) {
        super();
        this.colour = colour;
    }

    eq(other) { return other.colour === this.colour; }

    toDOM(view) {
        const well = document.createElement('input');
        well.type = 'color';
        well.value = this.colour;
        well.className = 'swatch';
        well.tabIndex = -1; // by keys a colour is written
        well.setAttribute('aria-label', `Colour ${this.colour}`);
        well.addEventListener('change', () => {
            const from = view.posAtDOM(well);
            view.dispatch({ changes: { from, to: from + this.colour.length, insert: well.value } });
        });
        return well;
    }

    ignoreEvent() { return true; }
}

const colours = new MatchDecorator({
    regexp: /#[0-9a-fA-F]{6}\b/g,
    // Both stay in one line.
    decorate: (add, from, to, [colour]) => {
        add(from, to, Decoration.mark({ class: 'colour', inclusive: true }));
        add(from, from, Decoration.widget({ widget: new Swatch(colour.toLowerCase()), side: 1 }));
    },
});

export const swatches = ViewPlugin.fromClass(class {
    constructor(view) { this.decorations = colours.createDeco(view); }
    update(update) { this.decorations = colours.updateDeco(update, this.decorations); }
}, { decorations: plugin => plugin.decorations });
