/**
 * krs: scenes of implicit surfaces in a page.
 *
 *     import * as krs from 'krs';
 *     const scene = await krs.compile('show sphere(1);');
 *     document.querySelector('krs-view').scene = scene;
 *
 * The compiler runs in a worker, so no call of these holds the page up.  Lengths are those of the scene, angles
 * radians, colours linear Rec.709, points three numbers.
 */

/** Three numbers. */
export type Vector = [number, number, number];

/** A place in a text: line and character count from 0, characters in UTF-16, as in the Language Server Protocol. */
export interface Position { line: number; character: number }
export interface Range { start: Position; end: Position }

/** A remark of the compiler: the members have the names of the Language Server Protocol. */
export interface Diagnostic {
    /** The name of the text or file that it is about. */
    uri: string;
    range: Range;
    /** 1: an error, 2: a warning, 3: a note. */
    severity: 1 | 2 | 3;
    /** "E0201"; `krs explain E0201` says more. */
    code: string;
    source: 'krs';
    message: string;
    relatedInformation: { location: { uri: string; range: Range }; message: string }[];
    data: {
        /** What is marked. */
        label?: string;
        help?: string;
        /** What could stand in `range` instead. */
        replacement?: string;
        notes: string[];
    };
}

/** How a parameter is shown: as a slider, a slider in degrees, a choice of two, a colour, several numbers. */
export type ParameterKind = 'number' | 'angle' | 'switch' | 'color' | 'vector';

/** A `param` of a scene. */
export interface Parameter {
    readonly name: string;
    readonly kind: ParameterKind;
    /** As many numbers as it has: 1 for a number, 2 to 4 for a vector, 3 for a colour. */
    readonly value: number[];
    /** What the text says. */
    readonly default: number[];
    /** The permitted range of each number; -Infinity and Infinity where the text gives none. */
    readonly low: number[];
    readonly high: number[];
    /** The comment of `///` lines before it. */
    readonly doc: string | null;
    /** Where the default stands in the text `source`, in bytes of UTF-8: `[start, end)`. */
    readonly source: string;
    readonly start: number;
    readonly end: number;
}

/** What one `show` shows. */
export interface Component {
    readonly name: string;
    /** A box around it; infinite where it has no end. */
    readonly low: Vector;
    readonly high: Vector;
    /** Nothing is proven of the distance; else it is a bound. */
    readonly estimate: boolean;
    /** Multiply-adds for its distance at a point. */
    readonly flops: number;
}

/** A camera; the names are those of `camera` blocks. */
export interface Camera {
    name: string | null;
    projection: 'perspective' | 'orthographic' | 'panorama';
    eye: Vector;
    target: Vector;
    up: Vector;
    /** The vertical angle.  A view that is narrower than the image of the scene is higher instead: it shows as much to the sides. */
    fov: number;
    /** Of an orthographic picture. */
    height: number;
    aperture: number;
    focus: number;
    blades: number;
    shift: [number, number];
    /** From when to when it is open, in seconds. */
    shutter: [number, number];
    /** The distance of two eyes; 0: there is one. */
    eyes: number;
}

/** What is known at a point or where a ray ends.  Materials have further members, one for each property. */
export interface Hit {
    hit: boolean;
    unresolved: boolean;
    /** How far along the ray. */
    t: number;
    point: Vector;
    distance: number;
    normal: Vector;
    /** From 1, in the order of `Scene.components`; 0: none. */
    component: number;
    level: number;
    instance: number;
    material: number;
    color: Vector;
    roughness: number;
    [property: string]: unknown;
}

export interface Mesh {
    /** x, y, z of each vertex. */
    vertices: Float64Array;
    /** The numbers of three vertices for each triangle, counterclockwise from outside. */
    triangles: Uint32Array;
    /** No vertex is farther from the surface. */
    error: number;
    /** Cells in which it is not decided what the surface does. */
    unresolved: number;
    /** Materials change in steps, as from part to part: each triangle has that of its middle.  At corners several meet. */
    steps: boolean;
}

export interface MeshOptions {
    /** The permitted distance from the surface; 0: a 500th of the size. */
    error?: number;
    /** One component, from 1; 0: all. */
    component?: number;
    /** Fewer triangles within the same error. */
    simplify?: boolean;
    /** Faster, and nothing is proven. */
    draft?: boolean;
    /** Told which part is done, from 0 to 1. */
    progress?: (done: number) => void;
    /** Ends it; the promise is rejected with the signal's reason. */
    signal?: AbortSignal;
}

/** A file that scenes use (`use`, pictures, fonts of their own): its bytes, or a text. */
export type FileContent = string | Uint8Array;

export interface CompileOptions {
    /** The name of the text in diagnostics, to which paths of `use` are relative: "scene.krs". */
    name?: string;
    /** Files by their paths.  Others are fetched from `base`. */
    files?: Record<string, FileContent>;
    /** The folder of files that are not in `files`; none: only those in `files` are there. */
    base?: string | URL;
    /** Files are in this folder and below: that of `base`, where nothing is said. */
    root?: string | URL;
    /** Fonts that scenes name, by name: places of TrueType or OpenType files, or their bytes.  "" is what texts have
        that name none. */
    fonts?: Record<string, string | URL | Uint8Array>;
    /** A scene without lights and sky gets some, and a floor: true. */
    studio?: boolean;
}

/** What an edit has changed.  Of 'nothing' and 'values' the shaders stay. */
export type Change = 'nothing' | 'values' | 'structure';

export interface Update {
    /** The text is a scene.  Otherwise the scene stays as it was, and `diagnostics` say why. */
    ok: boolean;
    diagnostics: Diagnostic[];
    change: Change;
}

/**
 * A compiled scene with its values of parameters.  Several views may show it.
 *
 * Event `change`: something that is seen has changed: values, or by `update` the scene.
 */
export interface Scene extends EventTarget {
    /** There is a scene.  It is false where the first text was none; an `update` can mend that. */
    readonly ok: boolean;
    /** Of the last text, also where it was refused. */
    readonly diagnostics: Diagnostic[];
    /** The last text that was accepted. */
    readonly text: string;
    /** That of the options. */
    readonly name: string;
    readonly parameters: readonly Parameter[];
    readonly components: readonly Component[];
    /** At the values of parameters, at time 0. */
    readonly cameras: readonly Camera[];
    /** The `image` block; 0 or null where it says nothing. */
    readonly image: {
        width: number; height: number; samples: number; integrator: string | null; exposure: number; tone_map: string | null;
        pixel_filter: string | null;
        /** Kelvins and tint; 0: as the light is. */
        white_balance: [number, number];
    };
    /** Whether the picture depends on the time. */
    readonly animated: boolean;
    /** Why no picture is made: it is too large for a shader; null: it is not. */
    readonly tooLarge: string | null;

    /**
     * The scene becomes that of an edited text.  Values that were set stay, where the new text permits them.  Of edits
     * that come while one is compiled only the last is compiled; the others get its answer.
     */
    update(text: string): Promise<Update>;
    /** Sets a parameter: a number, or as many as it has.  Rejected, with the reason, where there is none of this name, or
        the value is not permitted. */
    set(name: string, value: number | ArrayLike<number>): Promise<void>;
    /** Sets all to what the text says. */
    reset(): Promise<void>;
    /** What is known at points: x, y, z, x, y, z, ... or an array of points. */
    query(points: ArrayLike<number> | readonly Vector[], time?: number): Promise<Hit[]>;
    /** Distances at points: negative inside, and never more than the distance to the surface. */
    distance(points: ArrayLike<number> | readonly Vector[], time?: number): Promise<Float64Array>;
    /** Unit normals at points: the direction in which the distance grows fastest. */
    normal(points: ArrayLike<number> | readonly Vector[], time?: number): Promise<Float64Array>;
    /** Where rays end: origins and directions like points. */
    raycast(origins: ArrayLike<number> | readonly Vector[], directions: ArrayLike<number> | readonly Vector[],
            options?: { farthest?: number; tolerance?: number; time?: number }): Promise<Hit[]>;
    /** Triangles; in a worker of its own.  Rejected, with the reason, where there are none: what has no end, or encloses
        nothing, or too small an error. */
    mesh(options?: MeshOptions): Promise<Mesh>;
    /** The scene in a shading language; 'glsl' is that of `krs compile`. */
    shader(target?: 'glsl' | 'essl' | 'wgsl', options?: { stateValues?: boolean; earlyOuts?: boolean }): Promise<string>;
    /** Gives its memory back; it cannot be used any more. */
    free(): void;
}

/** Compiles a text.  A mistake in it is no exception: `ok` is false, and `diagnostics` say why. */
export function compile(text: string, options?: CompileOptions): Promise<Scene>;

/** The text in the canonical layout; null where it is no scene. */
export function format(text: string, options?: { name?: string }): Promise<{ text: string | null; diagnostics: Diagnostic[] }>;

/** Mistakes and warnings of a text, without a scene. */
export function check(text: string, options?: CompileOptions): Promise<Diagnostic[]>;

/**
 * What editors ask of a text, scene or not: a question of the Language Server Protocol ("textDocument/completion"), its
 * parameters without `textDocument`, and its result.  A worker of its own answers, while another compiles.
 */
export function ask(question: string, text: string, params: object, options?: CompileOptions): Promise<any>;

/**
 * Ends what the compiler does, however long it would take: promises that wait for it are rejected.  Scenes stay; each is compiled
 * again when it is asked next.
 */
export function stop(): void;

/**
 * What a scene may take, which may come from a stranger: seconds of a call, bytes of memory, and bytes of a file that is
 * fetched.  A call that takes longer is rejected.  60 s, 2 GiB, 64 MiB.  Meshes take as long as they take, until `signal`.
 */
export const limits: { seconds: number; memory: number; bytes: number };

/** The version of the compiler. */
export function version(): Promise<string>;

/** Where the files of this package lie (`worker.mjs`, `krs.wasm` and so on) where that is not beside this module: for
    bundlers.  To be called before all else. */
export function locate(folder: string | URL): void;

/** Details of `krs-frame`. */
export interface Frame {
    /** Samples of each pixel that the picture has; below 1 while a first, coarse one is drawn. */
    samples: number;
    /** How many it will have. */
    wanted: number;
    /** Milliseconds since what is seen has changed. */
    elapsed: number;
    width: number;
    height: number;
    time: number;
}

/**
 * `<krs-view>`: shows a scene.
 *
 *     <krs-view src="gear.krs" controls autoplay></krs-view>
 *
 * Attributes: `src`, a scene's address, and `root`, the folder of its files where that is not its own; or the text stands in `<script type="text/krs">` inside of it.  `camera`, the
 * name of one of the scene's.  `controls`: the camera is turned by dragging, moved with the shift key or two fingers,
 * and comes nearer by the wheel.  `autoplay`: the time runs.  `samples`: of each pixel, 64 by default.
 *
 * A text that is refused leaves the last picture.  What it cannot show is said in the corner, with the command that can.
 *
 * Events: `krs-diagnostics` (a text was compiled: `detail` is an `Update`), `krs-frame` (a picture is there: `detail` is
 * a `Frame`), `krs-camera` (`detail` is the `Camera`, moved by the user), `krs-error` (nothing can be drawn: `detail` says why).
 */
export class KrsViewElement extends HTMLElement {
    src: string | null;
    controls: boolean;
    autoplay: boolean;
    /** Of each pixel, while nothing moves. */
    samples: number;
    /** What it shows; null: nothing. */
    scene: Scene | null;
    /** What is seen from where.  Null, or a name, is one of the scene's; parts of a camera move the present one. */
    get camera(): Camera | null;
    set camera(camera: Partial<Camera> | string | null);
    /** The time runs. */
    playing: boolean;
    /** In seconds. */
    time: number;
    /** Compiles a text and shows it, or keeps the last picture; the scene is `scene`, made where there is none. */
    update(text: string, options?: CompileOptions): Promise<Update>;
    /** A picture of so many pixels, with `samples`, at the present camera and time. */
    snapshot(width?: number, height?: number, type?: string): Promise<Blob>;
    /** Where rays of pixels end, rows from the top: length along the ray, side (1: from outside), 1 for a hit and 2 for none,
        and steps, for each. */
    rays(width: number, height: number): Promise<Float32Array>;
    /** The point of the scene under a place of the page (`event.clientX`, `event.clientY`); null: none. */
    pick(x: number, y: number): Promise<Hit | null>;
    /** Resolves when the picture has all its samples. */
    readonly ready: Promise<void>;
}

declare global {
    interface HTMLElementTagNameMap { 'krs-view': KrsViewElement }
    interface HTMLElementEventMap {
        'krs-diagnostics': CustomEvent<Update>;
        'krs-frame': CustomEvent<Frame>;
        'krs-camera': CustomEvent<Camera>;
        'krs-error': CustomEvent<string>;
    }
}
