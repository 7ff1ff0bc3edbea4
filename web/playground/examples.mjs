// examples.mjs: examples to open, with their pictures.
export class Examples {
    current = null;

    constructor(dialog, { open }) {
        Object.assign(this, { dialog, open });
    }

    async load() {
        this.list = await (await fetch('examples.json')).json();
        this.dialog.querySelector('ul').append(...this.list.map(example => this.#card(example)));
    }

    find(name) { return this.list.find(example => example.name === name); }

    show() { this.dialog.showModal(); }

    #card(example) {
        const item = document.createElement('li'), button = document.createElement('button'), picture = document.createElement('img');
        const title = document.createElement('b'), about = document.createElement('small');
        Object.assign(picture, { src: `examples/${example.name}.jpg`, alt: '', width: 320, height: 180, loading: 'lazy' });
        title.textContent = example.title;
        about.textContent = example.about;
        button.append(picture, title, about);
        button.addEventListener('click', () => {
            this.dialog.close();
            this.current = example;
            this.open(example);
        });
        item.append(button);
        return item;
    }
}
