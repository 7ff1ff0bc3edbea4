// index.mjs: what the package `krs` has (krs.d.ts).
import { KrsViewElement } from './view.mjs';

export { ask, check, compile, format, limits, locate, stop, version } from './compiler.mjs';
export { KrsViewElement };

if (!customElements.get('krs-view'))
    customElements.define('krs-view', KrsViewElement);
