// parameters.mjs: a slider, a colour well or a box for each parameter of a scene.
import { fromHex, toHex } from './colour.mjs';

const DEGREES = 180 / Math.PI;

// As many digits as count: 0.30000000000000004 is 0.3.
const rounded = number => Number(number.toPrecision(6));

// A step of 1, 2 or 5, about 200 of them from end to end.
function stepOf(low, high) {
    const rough = (high - low) / 200, power = 10 ** Math.floor(Math.log10(rough));
    return rounded(power * [1, 2, 5, 10].find(k => k * power >= rough * 0.999));
}

function make(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes))
        key in element ? element[key] = value : element.setAttribute(key, value);
    element.append(...children);
    return element;
}

const unitOf = ({ kind }) => (kind === 'angle' ? DEGREES : 1);

// How a value is written into a text.
export function written({ kind, value }) {
    if (kind === 'color')
        return toHex(value);
    const numbers = value.map(number => (kind === 'angle' ? `${rounded(number * DEGREES)}deg` : String(rounded(number))));
    return numbers.length === 1 ? numbers[0] : `[${numbers.join(', ')}]`;
}

// One number of a parameter: a slider where it has a range, and a field.
class NumberControl {
    constructor(parameter, index, label, changed) {
        const unit = unitOf(parameter), low = parameter.low[index] * unit, high = parameter.high[index] * unit;
        const ranged = Number.isFinite(low) && Number.isFinite(high) && high > low;
        const step = ranged ? stepOf(low, high) : 'any';
        const limits = { ...(Number.isFinite(low) && { min: rounded(low) }), ...(Number.isFinite(high) && { max: rounded(high) }) };
        this.unit = unit;
        this.field = make('input', { type: 'number', step: 'any', inputMode: 'decimal', 'aria-label': `${label}, as a number`, ...limits });
        this.slider = ranged ? make('input', { type: 'range', ...limits, step, 'aria-label': label }) : null;
        const tell = input => () => {
            if (input.value === '' || !input.validity.valid)
                return;
            this.show(Number(input.value) / unit, input);
            changed(Number(input.value) / unit);
        };
        this.field.addEventListener('input', tell(this.field));
        this.slider?.addEventListener('input', tell(this.slider));
        this.elements = [...(this.slider ? [this.slider] : []), this.field,
                         ...(parameter.kind === 'angle' ? [make('span', { className: 'unit' }, '°')] : [])];
    }

    show(number, except = null) {
        for (const input of [this.slider, this.field])
            if (input && input !== except)
                input.value = rounded(number * this.unit);
    }
}

class Control {
    constructor(parameter, set) {
        const { name, kind, doc } = parameter;
        this.parameter = parameter;
        this.value = [...parameter.value];
        const values = make('div', { className: 'values' }), add = (...elements) => values.append(make('div', { className: 'value' }, ...elements));
        const tell = value => {
            this.value = value;
            this.mark();
            set(name, value);
        };
        if (kind === 'color') {
            this.well = make('input', { type: 'color', 'aria-label': name });
            this.well.addEventListener('input', () => tell(fromHex(this.well.value)));
            add(this.well);
        } else if (kind === 'switch') {
            this.box = make('input', { type: 'checkbox', 'aria-label': name });
            this.box.addEventListener('change', () => tell([Number(this.box.checked)]));
            add(this.box);
        } else {
            this.numbers = parameter.value.map((_, i) => new NumberControl(parameter, i, parameter.value.length > 1 ? `${name}, ${'xyzw'[i]}` : name,
                number => tell(this.value.with(i, number))));
            this.numbers.forEach(({ elements }) => add(...elements));
        }
        this.back = make('button', { type: 'button', className: 'bare', title: `${name} as the text says` });
        this.back.append(icon(), make('span', { className: 'hidden' }, `${name} as the text says`));
        this.back.addEventListener('click', () => {
            tell([...this.parameter.default]);
            this.showValue();
        });
        this.element = make('div', { className: `parameter ${kind}` }, make('span', { className: 'name' }, name), values, this.back,
                            ...(doc ? [make('span', { className: 'doc' }, doc)] : []));
        this.showValue();
    }

    get changed() { return this.value.some((number, i) => rounded(number) !== rounded(this.parameter.default[i])); }
    mark() { this.element.classList.toggle('changed', this.changed); }

    showValue() {
        if (this.well)
            this.well.value = toHex(this.value);
        if (this.box)
            this.box.checked = this.value[0] !== 0;
        this.numbers?.forEach((number, i) => number.show(this.value[i]));
        this.mark();
    }

    take(parameter) {
        this.parameter = parameter;
        if (this.value.some((number, i) => number !== parameter.value[i])) {
            this.value = [...parameter.value];
            this.showValue();
        }
        this.mark();
    }
}

function icon() {
    const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg'), path = document.createElementNS(svg.namespaceURI, 'path');
    svg.setAttribute('viewBox', '0 0 20 20');
    svg.setAttribute('aria-hidden', 'true');
    path.setAttribute('d', 'M4 4v4h4M4.6 8A6 6 0 114 11.5');
    svg.append(path);
    return svg;
}

// What a control depends on; while it is the same, controls stay, and so does the focus.
const formOf = ({ name, kind, doc, low, high, value }) => JSON.stringify([name, kind, doc, low, high, value.length].map(String));

export class Parameters {
    #controls = [];
    #form = '';

    // `set` is told of values; `write` is asked to put those that differ into the text.
    constructor(root, { set, write }) {
        Object.assign(this, { root, set, write });
    }

    show(parameters) {
        const form = parameters.map(formOf).join('\n');
        if (form === this.#form) {
            this.#controls.forEach((control, i) => control.take(parameters[i]));
        } else {
            this.#form = form;
            this.#controls = parameters.map(parameter => new Control(parameter, (...call) => (this.#mark(), this.set(...call))));
            this.root.replaceChildren(...this.#controls.map(({ element }) => element), ...(parameters.length > 0 ? [this.#all()] : []));
        }
        this.#mark();
    }

    #all() {
        this.reset = make('button', { type: 'button' }, 'All as the text says');
        this.keep = make('button', { type: 'button' }, 'Write into the text');
        this.reset.addEventListener('click', () => this.#controls.filter(({ changed }) => changed).forEach(({ back }) => back.click()));
        this.keep.addEventListener('click', () => this.write(this.changed));
        return make('div', { className: 'all' }, this.reset, this.keep);
    }

    #mark() {
        const none = this.changed.length === 0;
        if (this.keep)
            this.reset.disabled = this.keep.disabled = none;
    }

    // Parameters whose values are not those of the text.
    get changed() {
        return this.#controls.filter(({ changed }) => changed).map(({ parameter, value }) => ({ ...parameter, value }));
    }
}
