"""Pictures: AOVs as arrays that are memory of the library."""
from __future__ import annotations

import os
import struct as packing
import threading
import zlib
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Callable, Iterable

import numpy as np

from krs import native
from krs._tables import AOVS
from krs.errors import ArgumentError, DeviceError
from krs.native import Handle, Progress, ffi, lib

if TYPE_CHECKING:
    from krs.scene import Camera, Scene

# What AOVs are called: by the arrays that they have.
_BITS = {array["member"]: 1 << aov["bit"] for aov in AOVS for array in aov["arrays"]}


# ---- devices ----


def _cache_folder() -> str | None:
    """As the command has it, so that both share shaders."""
    caches, home = os.environ.get("XDG_CACHE_HOME", ""), os.environ.get("HOME", "")
    return os.path.join(caches, "krs") if caches.startswith("/") else os.path.join(home, ".cache/krs") if home else None


class Renderer(Handle):
    """An open Vulkan device.  One thread at a time uses it."""

    def __init__(self, device: str | None):
        cache = _cache_folder()
        kept = [ffi.new("char[]", os.fsencode(text)) if text else ffi.NULL for text in (device, cache)]
        options = ffi.new("KrsRendererOptions *", {"device": kept[0], "cache": kept[1]})
        made = ffi.new("KrsRenderer **")
        status = lib.krs_renderer_new_sized(options, ffi.sizeof("KrsRendererOptions"), made)
        super().__init__(made[0], lib.krs_renderer_free)
        native.check(status, self.message("cannot open a Vulkan device"))

    def message(self, otherwise: str) -> str:
        return (ffi.string(lib.krs_renderer_message(self.pointer)).decode() if self.pointer else "") or otherwise


_opened: dict[str, Renderer] = {}
_opening = threading.Lock()


def _renderer(device: str | None) -> Renderer:
    name = device or os.environ.get("KRS_DEVICE") or ""
    with _opening:
        if name not in _opened:
            _opened[name] = Renderer(name or None)
        return _opened[name]


def devices() -> list[SimpleNamespace]:
    """The Vulkan devices of this machine: `name`, `usable`, `preferred`, ..."""
    count = ffi.new("size_t *")
    size = ffi.sizeof("KrsDevice")
    status = lib.krs_devices_sized(ffi.NULL, size, 0, count)
    found = ffi.new("KrsDevice[]", count[0])
    if status == lib.KRS_OK:
        status = lib.krs_devices_sized(found, size, len(found), count)
    if status == lib.KRS_NO_DEVICE:
        return []
    native.check(status, "cannot list the devices")
    return [native.tell(device) for device in found[0:min(len(found), count[0])]]


# ---- pictures ----


class Picture:
    """A picture, row by row from the top.  Where nothing is hit the depth is infinite, and all but colour and steps is 0.

    `arrays` has the AOVs by their names, which are attributes as well: `color` (R, G, B, A), `depth`, `position`,
    `normal`, `albedo`, `component`, `level`, `instance`, `steps`, `noise`.  One that was not asked for is None.
    """

    arrays: dict[str, np.ndarray]
    color: np.ndarray
    depth: np.ndarray
    position: np.ndarray
    normal: np.ndarray
    albedo: np.ndarray
    component: np.ndarray
    level: np.ndarray
    instance: np.ndarray
    steps: np.ndarray
    lights: np.ndarray | None  # of each light, with `light_groups`
    mattes: list[np.ndarray] | None  # of components, instances and materials: the most covered first
    world_to_camera: np.ndarray  # for row vectors
    world_to_ndc: np.ndarray
    stats: SimpleNamespace

    def __init__(self, handle: Handle, scene: Any):
        picture = handle.pointer
        self._handle, self._scene = handle, scene
        self.width, self.height, self.samples = picture.width, picture.height, picture.samples
        window = picture.window
        self.window = (window.x, window.y, window.width, window.height)
        shape = (window.height, window.width)
        self.arrays = {}
        for aov in AOVS:
            for array in aov["arrays"]:
                pointer, numbers = getattr(picture, array["member"]), array["numbers"]
                if pointer:
                    dtype = np.float32 if array["type"] == "float" else np.uint32
                    self.arrays[array["member"]] = native.view(
                        handle, pointer, shape if numbers == 1 else (*shape, numbers), dtype)
        self.lights = self.mattes = None
        if picture.lights:
            self.lights = native.view(handle, picture.lights, (picture.light_count, *shape, 3), np.float32)
        if picture.mattes[0]:
            matte, ranks = native.dtype_of("KrsMatte"), lib.KRS_MATTE_RANKS
            self.mattes = [native.view(handle, picture.mattes[kind], (*shape, ranks, 3), np.uint32).view(matte)[..., 0]
                           for kind in range(lib.KRS_MATTE_COUNT)]
        fields = dict(ffi.typeof("KrsPicture").fields)
        for member in ("world_to_camera", "world_to_ndc"):
            setattr(self, member, native.numbers(getattr(picture, member), fields[member].type))
        self.stats = native.tell(picture.stats)

    def __getattr__(self, name: str) -> np.ndarray | None:
        if name in _BITS:
            return self.arrays.get(name)
        raise AttributeError(f"a picture has no `{name}`")

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.color, dtype, copy=True) if copy else np.asarray(self.color, dtype)

    def __repr__(self) -> str:
        return f"<krs.Picture {self.window[2]}x{self.window[3]}: {', '.join(self.arrays)}>"

    def srgb(self, stops: float = 0, alpha: bool = False) -> np.ndarray:
        """What a screen shows, by the curve, exposure and white balance of the scene: bytes, 3 or 4 for each pixel."""
        pixels = np.empty((*self.color.shape[:2], 4 if alpha else 3), np.uint8)
        status = lib.krs_picture_to_srgb8(self._handle.pointer, self._scene.pointer, stops, pixels.shape[2],
                                          native.pointer(pixels, "uint8_t *"))
        native.check(status, "the picture has no colour")
        return pixels

    def png(self, stops: float = 0) -> bytes:
        """The bytes of a PNG file."""
        pixels = self.srgb(stops)
        height, width, _ = pixels.shape
        lines = np.zeros((height, 1 + 3 * width), np.uint8)  # each line begins with its filter: none
        lines[:, 1:] = pixels.reshape(height, -1)

        def chunk(name: bytes, data: bytes) -> bytes:
            return packing.pack(">I", len(data)) + name + data + packing.pack(">I", zlib.crc32(name + data))

        header = packing.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"sRGB", b"\0")
                + chunk(b"IDAT", zlib.compress(lines.tobytes(), 6)) + chunk(b"IEND", b""))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .png file, or all AOVs as an .npz of NumPy."""
        if os.fspath(path).endswith(".npz"):
            np.savez_compressed(path, **self.arrays)
        elif not os.fspath(path).endswith(".png"):
            raise ValueError(f"{os.fspath(path)!r}: a picture is saved as .png or .npz; `krs render` writes .exr")
        else:
            with open(path, "wb") as file:
                file.write(self.png())

    def _repr_png_(self) -> bytes:
        return self.png()


# ---- rendering ----


def _rendering(compiled: Any, renderer: Renderer, purpose: str) -> Handle:
    """A scene with its shaders, which are compiled once."""
    key = (renderer, purpose)
    renderings = compiled.__dict__.setdefault("renderings", {})
    if key not in renderings:
        made = ffi.new("KrsRendering **")
        status = lib.krs_rendering_new(renderer.pointer, compiled.pointer, getattr(lib, purpose), made)
        if status == lib.KRS_BAD_SCENE:
            raise ArgumentError(ffi.string(lib.krs_scene_too_large(compiled.pointer).message).decode())
        native.check(status, renderer.message("cannot compile the shaders"))
        renderings[key] = Handle(made[0], lib.krs_rendering_free, renderer, compiled)
    return renderings[key]


def _purpose(scene: Scene, options: dict[str, Any]) -> str:
    integrator = options.get("integrator") or _image(scene).integrator or "preview"
    return ("KRS_FOR_PATHS" if integrator not in ("preview", "default") else
            "KRS_FOR_LANES" if lib.krs_scene_too_large(scene._compiled.pointer) else "KRS_FOR_FIRST_PICTURES")


def _image(scene: Scene) -> SimpleNamespace:
    """The `image` block."""
    image = ffi.new("KrsImage *")
    lib.krs_scene_image_sized(scene._compiled.pointer, image, ffi.sizeof("KrsImage"))
    return native.tell(image[0])


def _state(scene: Scene, studio: bool) -> Any:
    """The values of a scene, as a state of the one for pictures."""
    from krs.scene import State
    state = State(scene._compiled.for_pictures(studio))
    for name, value in scene._set.items():
        state.set(name, value)
    state.set_time(scene.time)
    state.set_zones(scene._zones)
    lib.krs_state_fit_camera(state.pointer)
    return state


def _aov_bits(aovs: Iterable[str]) -> int:
    bits = 0
    for name in aovs:
        if name not in _BITS:
            raise ArgumentError(f"a picture has no `{name}`; it has {', '.join(_BITS)}")
        bits |= _BITS[name]
    return bits


def render(scene: Scene, size: tuple[int, int] | None = None, *, camera: int | str | Camera = 0,
           aovs: Iterable[str] | None = None, crop: tuple[int, int, int, int] | None = None, studio: bool = True,
           device: str | None = None, progress: Callable[[float], Any] | None = None, **options: Any) -> Picture:
    """A picture of a scene, with all AOVs or those that are named.

    `size` is (width, height), that of the scene's `image` block or 1280 by 720 unless given; `crop` is (x, y, width,
    height) of a part.  `camera` is a number, a name, or one that was moved.  `studio`: a scene without lights gets some, and
    a floor, as `krs render` shows it.  `device` is as for the command.  Other options are members of KrsRenderOptions:
    `samples`, `integrator` ("preview", "direct", "path"), `noise`, `seed`, `bounces`, `light_groups`, `mattes` and so on.

    >>> from krs import compile
    >>> picture = compile("show sphere(1); camera { eye: [0, 0, 5] }").render((32, 24), studio=False)
    >>> picture.color.shape, float(round(picture.depth[12, 16], 2))
    ((24, 32, 4), 4.0)
    """
    from krs.scene import Camera, find_camera
    done = Progress(progress)
    given = dict(options)
    if size is not None:
        width, height = native.vector(size, 2, "`size`, a width and a height,")
        given.update(width=int(width), height=int(height))
    if crop is not None:
        place = native.vector(crop, 4, "`crop`")
        given["crop"] = {name: int(number) for name, number in zip(("x", "y", "width", "height"), place)}
    moved = None
    if isinstance(camera, Camera):
        moved = camera._struct
    else:
        given["camera"] = find_camera(scene._compiled.pointer, camera)
    with scene._state.lock:
        state = _state(scene, studio)
    struct = native.fill(ffi.new("KrsRenderOptions *"), given, "render")
    struct.aovs = 0 if aovs is None else _aov_bits(aovs)
    struct.progress = done.pointer
    renderer = _renderer(device)
    with renderer.lock:
        rendering = _rendering(scene._compiled.for_pictures(studio), renderer, _purpose(scene, options))
        picture = ffi.new("KrsPicture **")
        if moved is None:
            status = lib.krs_render_sized(rendering.pointer, state.pointer, struct, ffi.sizeof("KrsRenderOptions"), picture)
        else:
            status = _render_moved(rendering, state, struct, moved, _image(scene), picture)
        native.check(status, renderer.message("cannot render"), done)
    return Picture(Handle(picture[0], lib.krs_picture_free), scene._compiled.for_pictures(studio))


def _render_moved(rendering: Handle, state: Any, struct: Any, camera: Any, image: SimpleNamespace, picture: Any) -> int:
    """As krs_render, by a camera that the scene does not have."""
    film = ffi.new("KrsFilm **")
    noisy = struct.noise or image.noise
    samples = struct.samples or image.samples or (lib.KRS_DEFAULT_NOISY_SAMPLES if noisy else lib.KRS_DEFAULT_SAMPLES)
    status = lib.krs_film_new_sized(rendering.pointer, struct, ffi.sizeof("KrsRenderOptions"), film)
    if status == lib.KRS_OK:
        status = lib.krs_film_add_sized(film[0], state.pointer, camera, ffi.sizeof("KrsCamera"), samples)
    if status == lib.KRS_OK:
        status = lib.krs_film_read(film[0], 0, picture)
    lib.krs_film_free(film[0])
    return status


# ---- questions ----


def ask(scene: Scene, device: str, function: Any, *arguments: Any) -> None:
    """Asks a device what `function` answers of a state."""
    renderer = _renderer(device)
    with scene._state.lock, renderer.lock:
        rendering = _rendering(scene._compiled, renderer, "KRS_FOR_QUESTIONS")
        status = function(rendering.pointer, scene._state.pointer, *arguments)
        native.check(status, renderer.message("the device cannot answer"))
