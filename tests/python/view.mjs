// view.mjs: opens a page of krs.view in Chromium, pulls a slider, and prints as JSON what is there.
//
//     node view.mjs URL [PICTURE.png]
import { launch } from '../web/browser.mjs';

const browser = await launch(), page = await browser.open(process.argv[2], { width: 480, height: 400 });
try {
    await page.until('document.body.dataset.ready');
    const told = await page.evaluate(async () => {
        const view = document.querySelector('krs-view'), at = () => view.scene.parameters.map(({ name, value }) => [name, value]);
        await view.ready;
        const shot = async () => {
            const bitmap = await createImageBitmap(await view.snapshot(96, 64)), context = new OffscreenCanvas(96, 64).getContext('2d');
            context.drawImage(bitmap, 0, 0);
            return [...context.getImageData(48, 32, 1, 1).data, ...context.getImageData(48, 6, 1, 1).data];
        };
        const before = { values: Object.fromEntries(at()), pixels: await shot() };
        const slider = document.querySelector('input[name="r.0"]');
        slider.value = 1.75;
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        const color = document.querySelector('input[name="tint.0"]');
        color.value = '#ff8000';
        color.dispatchEvent(new Event('input', { bubbles: true }));
        await new Promise(resolve => setTimeout(resolve, 500));
        await view.ready;
        return { before, after: { values: Object.fromEntries(at()), pixels: await shot() }, inputs: [...document.querySelectorAll('input')].map(input => input.type) };
    });
    if (process.argv[3])
        await page.screenshot(process.argv[3]);
    console.log(JSON.stringify({ ...told, errors: page.errors }));
} finally {
    await browser.close();
}
