// wrong.ts: a use that krs.d.ts refuses.
import { compile } from 'krs';

const scene = await compile('show sphere(1);');
await scene.set('radius', 'large');
export {};
