// painter.mjs: a worker that draws the picture of a view (view.mjs): a message calls a method of Picture, or asks it.
import { Picture } from './picture.mjs';

let picture = null;
const tell = (message, transfer = []) => postMessage(message, transfer);
const failed = error => tell({ kind: 'error', message: error.message });

const calls = {
    canvas({ canvas }) {
        picture = new Picture(canvas, tell);
        picture.begun.catch(failed);
    },
    scene({ scene, state }) { return picture.setScene(scene, state); },
    state({ state }) { picture.setState(state); },
    size({ width, height }) { picture.setSize(width, height); },
    samples({ samples }) { picture.setWanted(samples); },
    release() { picture.release(); },
    restore() { picture.restore(); },

    shoot({ id, ...wanted }) { return shoot(id, wanted).catch(error => tell({ kind: 'shot', id, error: error.message })); },
};

async function shoot(id, { width, height, samples, type }) {
    await picture.begun;
    const { bytes, rays } = await picture.shoot({ width, height, samples });
    if (type === 'rays') {
        tell({ kind: 'shot', id, rays }, [rays.buffer]);
        return;
    }
    const canvas = new OffscreenCanvas(width, height);
    canvas.getContext('2d').putImageData(new ImageData(bytes, width, height), 0, 0);
    tell({ kind: 'shot', id, blob: await canvas.convertToBlob({ type }) });
}

self.onmessage = ({ data }) => Promise.resolve(calls[data.call](data)).catch(failed);
