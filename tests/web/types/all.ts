// all.ts: a program that uses all that krs.d.ts declares, as it is meant.
import * as krs from 'krs';
import type { Camera, Change, CompileOptions, Component, Diagnostic, Frame, Hit, Mesh, MeshOptions, Parameter, ParameterKind, Position, Range,
              Scene, Update, Vector } from 'krs';

const options: CompileOptions = { name: 'scene.krs', files: { 'part.krs': 'def part() = sphere(2);', 'relief.png': new Uint8Array(4) },
    base: new URL('https://example.org/'), fonts: { '': 'fonts/own.ttf' }, studio: false };
krs.locate('/krs/');

function place({ line, character }: Position): string { return `${line + 1}:${character + 1}`; }
function tell({ code, severity, message, range, relatedInformation, data }: Diagnostic): string {
    const where: Range = range, notes: string[] = [...data.notes, ...relatedInformation.map(other => other.message)];
    return `${severity === 1 ? 'error' : 'warning'} ${code} ${place(where.start)} ${message} ${data.help ?? ''} ${data.replacement ?? ''} ${notes.join()}`;
}

async function use(): Promise<void> {
    const scene: Scene = await krs.compile('param radius = 1 in [0.5, 2]; show sphere(radius);', options);
    const update: Update = await scene.update('show sphere(1);'), change: Change = update.change;
    const parameters: readonly Parameter[] = scene.parameters, kind: ParameterKind | undefined = parameters[0]?.kind;
    const components: readonly Component[] = scene.components, [camera]: readonly Camera[] = scene.cameras, up: Vector = camera?.up ?? [0, 1, 0];
    const { width, exposure, white_balance: [kelvins] } = scene.image;
    await scene.set('radius', 1.5);
    await scene.set('tint', [1, 0, 0]);
    await scene.set('tint', new Float32Array(3));
    await scene.reset();
    const hits: Hit[] = await scene.query([[0, 1, 0]], 0.5), rays: Hit[] = await scene.raycast([0, 0, 5], [0, 0, -1], { farthest: 10, tolerance: 0.01, time: 1 });
    const distances: Float64Array = await scene.distance(new Float32Array([0, 1, 0])), normals: Float64Array = await scene.normal([0, 1, 0]);
    const how: MeshOptions = { error: 0.01, component: 1, simplify: true, draft: true, progress: done => console.log(done.toFixed(2)),
        signal: new AbortController().signal };
    const mesh: Mesh = await scene.mesh(how), corners: number = mesh.triangles.length + mesh.vertices.length + mesh.unresolved;
    const text: string = await scene.shader('wgsl', { stateValues: true, earlyOuts: false });
    scene.addEventListener('change', () => {});
    const formatted = await krs.format('show sphere(1);', { name: 'scene.krs' }), mistakes = await krs.check('show', options);
    const completion: unknown = await krs.ask('textDocument/completion', 'show sph', { position: { line: 0, character: 8 } });
    console.log(mistakes.map(tell), formatted.text ?? formatted.diagnostics.length, completion, await krs.version(), change, kind, up, width, exposure,
        kelvins, components[0]?.flops, scene.ok, scene.diagnostics, scene.text, scene.animated, scene.tooLarge?.length, hits[0]?.normal, rays[0]?.t,
        distances[0], normals[0], corners, mesh.error, mesh.steps, text.length);
    krs.limits.seconds = Math.min(krs.limits.seconds, 10);
    krs.stop();
    scene.free();
}

async function show(view: krs.KrsViewElement): Promise<void> {
    Object.assign(view, { src: 'gear.krs', controls: true, autoplay: false, samples: 16, playing: true, time: 2 });
    const update: Update = await view.update('show sphere(1);', options), scene: Scene | null = view.scene;
    view.scene = null;
    const seen = view.camera?.fov ?? 0;
    view.camera = 'side';
    view.camera = { fov: 0.5, eye: [0, 0, 5] };
    view.camera = null;
    const picture: Blob = await view.snapshot(320, 180, 'image/png'), rays: Float32Array = await view.rays(160, 90), hit: Hit | null = await view.pick(10, 20);
    view.addEventListener('krs-frame', ({ detail }) => { const frame: Frame = detail; console.log(frame.samples / frame.wanted, frame.elapsed); });
    view.addEventListener('krs-diagnostics', ({ detail }) => console.log(detail.ok));
    view.addEventListener('krs-camera', ({ detail }) => console.log(detail.shutter[0], detail.eyes));
    view.addEventListener('krs-error', ({ detail }) => console.log(detail.toUpperCase()));
    await view.ready;
    console.log(update.ok, scene?.name, seen, picture.size, rays.length, hit?.point);
}

const view = document.querySelector('krs-view');
if (view)
    use().then(() => show(view), error => console.log(error));
