"""Compiled scenes: what they have, and what can be asked of them."""
from __future__ import annotations

import difflib
import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Iterator, Mapping

import numpy as np
from numpy.typing import ArrayLike

from krs import native
from krs.errors import ArgumentError, Diagnostic, SceneError, SceneWarning
from krs.mesh import Grid, Mesh, Section
from krs.native import Handle, Progress, check, ffi, lib

HIT = native.dtype_of("KrsHit")


@dataclass(frozen=True)
class Parameter:
    """A `param` of a scene.  Angles are in radians, colours linear Rec.709."""

    name: str
    default: float | np.ndarray
    low: float | np.ndarray  # of the permitted range, which may have no end
    high: float | np.ndarray
    color: bool
    degrees: bool  # the text gives it in degrees
    whole: bool  # 0 or 1
    doc: str | None
    source: str  # the text, and where the name stands in it, from 1
    line: int
    column: int


class Camera:
    """Where a picture is seen from: members are those of `camera` blocks, and can be set.

    `orbit`, `look`, `pan`, `dolly`, `fly`, `roll`, `fit`, `axis` and `aim` move it as a mouse does.
    """

    def __init__(self, struct: Any):
        object.__setattr__(self, "_struct", struct)

    def __getattr__(self, name: str) -> Any:
        fields = dict(ffi.typeof("KrsCamera").fields)
        if name in fields:
            value = getattr(self._struct, name)
            return native.numbers(value, fields[name].type) if fields[name].type.kind == "array" else value
        if name.startswith("_") or not hasattr(lib, f"krs_camera_{name}"):
            raise AttributeError(f"a camera has no `{name}`")
        function = getattr(lib, f"krs_camera_{name}")
        return lambda *arguments: function(self._struct, *map(self._argument, arguments))

    @staticmethod
    def _argument(value: Any) -> Any:
        return (ffi.NULL if value is None else value if np.ndim(value) == 0 else
                native.vector(value, 3, "a place or a direction").tolist())

    def __setattr__(self, name: str, value: Any) -> None:
        native.fill(self._struct, {name: value}, "a camera")

    def __repr__(self) -> str:
        members = vars(native.tell(self._struct[0]))
        return "Camera(" + ", ".join(f"{name}={value!r}" for name, value in members.items()) + ")"

    def copy(self) -> Camera:
        return Camera(ffi.new("KrsCamera *", self._struct[0]))


# ---- compiling ----


@ffi.callback("void(void *, const KrsDiagnostic *)")
def _listen(user: Any, told: Any) -> None:
    kind = "error" if told.error else "note" if told.note else "warning"
    texts = (ffi.string(text).decode(errors="replace") for text in (told.code, told.message, told.source))
    code, message, source = texts
    ffi.from_handle(user).append(Diagnostic(kind, code, message, source, told.line, told.column,
                                            ffi.string(told.text).decode(errors="replace")))


@ffi.callback("void(void *, const char *)")
def _note(user: Any, path: Any) -> None:
    ffi.from_handle(user)[os.fsdecode(ffi.string(path))] = None


class _Loader:
    """Supplies files that a scene uses, from a function of the caller."""

    def __init__(self, load: Callable[[str], bytes | str | None]):
        self._load = load
        self._kept: Any = None
        self.raised: BaseException | None = None
        self.pointer = ffi.callback("const char *(void *, const char *, size_t *)", self._supply, error=ffi.NULL,
                                    onerror=self._keep)

    def _supply(self, _user: Any, path: Any, length: Any) -> Any:
        text = self._load(ffi.string(path).decode())
        if text is None:
            return ffi.NULL
        data = text.encode() if isinstance(text, str) else bytes(text)
        self._kept = ffi.new("char[]", data)  # until the next call
        length[0] = len(data)
        return self._kept

    def _keep(self, _kind: Any, exception: BaseException, _trace: Any) -> None:
        self.raised = exception


def _compile(text: bytes, name: str, options: dict[str, Any]) -> tuple[Any, list[Diagnostic], list[str]]:
    """A KrsScene, what is said of it, and the files that it is read from."""
    said: list[Diagnostic] = []
    opened: dict[str, None] = {}
    handle, files = ffi.new_handle(said), ffi.new_handle(opened)
    struct = ffi.new("KrsOptions *", {"diagnostic": _listen, "user": handle, "opened": _note, "opened_user": files})
    given = dict(options)
    root = given.pop("root", None)
    load = given.pop("load", None)
    native.fill(struct, given, "compile")
    kept = ffi.new("char[]", os.fsencode(root)) if root is not None else ffi.NULL
    struct.root = kept
    loader = _Loader(load) if load is not None else None
    if loader is not None:
        struct.load = loader.pointer
    scene = ffi.new("KrsScene **")
    status = lib.krs_compile_text_sized(text, len(text), os.fsencode(name), struct, ffi.sizeof("KrsOptions"), scene)
    if loader is not None and loader.raised is not None:
        lib.krs_scene_free(scene[0])
        raise loader.raised
    if status in (lib.KRS_BAD_SCENE, lib.KRS_IO_ERROR):
        raise SceneError(said)
    check(status, f"cannot compile {name}")
    return scene[0], said, list(opened)


class _Compiled(Handle):
    """A scene as it is compiled, which never changes."""

    def __init__(self, text: bytes, name: str, options: dict[str, Any]):
        self.text, self.name, self.options = text, name, options
        pointer, self.diagnostics, self.opened = _compile(text, name, options)
        super().__init__(pointer, lib.krs_scene_free)
        self.parameters = {p.name: p for p in self._parameters()}
        self._pictures: dict[bool, _Compiled] = {}

    def _parameters(self) -> Iterator[Parameter]:
        for index in range(lib.krs_parameter_count(self.pointer)):
            p = self.ask(lib.krs_parameter_sized, "KrsParameter", index)
            single = p.components == 1
            low, high, value = (n[0] if single else n[: p.components] for n in (p.low, p.high, p.value))
            yield Parameter(p.name, value, low, high, p.color, bool(p.degrees), p.whole, p.doc, p.source, p.line, p.column)

    def ask(self, function: Any, kind: str, index: int) -> SimpleNamespace:
        struct = ffi.new(f"{kind} *")
        check(function(self.pointer, index, struct, ffi.sizeof(kind)), f"there is no number {index}")
        return native.tell(struct[0])

    def for_pictures(self, studio: bool) -> _Compiled:
        """The scene as pictures have it: in a studio, if that is wanted, and with what makes frames fast."""
        with self.lock:
            if studio not in self._pictures:
                options = {**self.options, "studio": studio, "pictures": True}
                self._pictures[studio] = _Compiled(self.text, self.name, options)
            return self._pictures[studio]


class State(Handle):
    """Values of a compiled scene; one thread at a time uses it."""

    def __init__(self, compiled: _Compiled):
        made = ffi.new("KrsState **")
        check(lib.krs_state_new(compiled.pointer, made), "there is no memory for a state")
        super().__init__(made[0], lib.krs_state_free, compiled)
        self.compiled = compiled

    def refusal(self, reason: str) -> str:
        place = lib.krs_state_unbounded(self.pointer)
        return f"{reason}: no slope bounds {ffi.string(place).decode()} then" if place else reason

    def set(self, name: str, value: np.ndarray) -> None:
        status = lib.krs_state_set(self.pointer, name.encode(), native.pointer(value, "double *"), value.size)
        check(status, self.refusal(f"`{name}` cannot be {value.tolist()}"))

    def set_time(self, time: float) -> None:
        check(lib.krs_state_set_time(self.pointer, time), self.refusal(f"the time cannot be {time}"))

    def set_zones(self, zones: np.ndarray) -> None:
        status = lib.krs_state_set_zones(self.pointer, native.pointer(zones, "const double (*)[4]"), len(zones))
        check(status, "zones are at most 16 balls, [x, y, z, radius]")


def _is_text(source: str) -> bool:
    return any(sign in source for sign in ";{\n")


def compile(source: str | os.PathLike[str] | Any, *, name: str | None = None, root: str | os.PathLike[str] | None = None,
            load: Callable[[str], bytes | str | None] | None = None, **options: Any) -> Scene:
    """Compiles a file, a text, or what was built of expressions.

    A string with `;`, `{` or more than one line is a text; any other is the path of a file.  `name` is what diagnostics
    call it, and paths of `use` are relative to its folder.  `root` is the only folder that is read, and `load` supplies
    files in place of the system.  Other options are members of `KrsOptions`: `assembly`, `gradients`, `memory_limit` and
    so on.

    Mistakes raise SceneError; what is warned of is a SceneWarning.

    >>> compile("show sphere(1);").distance([0, 3, 0])
    2.0
    """
    if not isinstance(source, (str, os.PathLike)):
        source, name = str(source), name or "scene.krs"
    if isinstance(source, str) and _is_text(source):
        text, name = source.encode(), name or "scene.krs"
    else:
        text, name = Path(source).read_bytes(), name or os.fspath(source)
    given = {key: value for key, value in (("root", root), ("load", load)) if value is not None}
    compiled = _Compiled(text, name, {**given, **options})
    for told in compiled.diagnostics:
        if told.kind == "warning":
            warnings.warn(str(told), SceneWarning, stacklevel=2)
    return Scene(compiled)


# ---- scenes ----


class Scene:
    """A compiled scene, at some values of its parameters and some time.

    Each parameter is an attribute, which can be set; `scene[name]` is the same.  Threads that compute at once have scenes
    of their own, which `values` makes; what is compiled is shared.
    """

    _compiled: _Compiled
    _state: State
    _set: dict[str, np.ndarray]
    _zones: np.ndarray

    def __init__(self, compiled: _Compiled):
        for attribute, value in (("_compiled", compiled), ("_state", State(compiled)), ("_set", {}),
                                 ("_zones", np.empty((0, 4)))):
            object.__setattr__(self, attribute, value)

    # -- values --

    def __getitem__(self, name: str) -> Any:
        """The value of a parameter: a number, or an array that cannot be written to."""
        if name not in self.parameters:
            near = difflib.get_close_matches(name, self.parameters, 1)
            hint = f"; there is `{near[0]}`" if near else ""
            raise KeyError(f"the scene has no parameter `{name}`{hint}")
        value = self._set.get(name)
        if value is None:
            return self.parameters[name].default
        return float(value[0]) if value.size == 1 else value

    def __setitem__(self, name: str, value: ArrayLike) -> None:
        default = np.atleast_1d(self[name])
        numbers = np.array(value, dtype=np.float64, ndmin=1)
        if numbers.shape != default.shape:
            raise ArgumentError(f"`{name}` has {default.size} numbers, not {numbers.size}")
        parameter = self.parameters[name]
        if not (np.all(numbers >= parameter.low) and np.all(numbers <= parameter.high)):
            raise ArgumentError(f"`{name}` must be from {parameter.low} to {parameter.high}, not {numbers.tolist()}")
        with self._state.lock:
            self._state.set(name, numbers)
        numbers.flags.writeable = False
        self._set[name] = numbers

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as missing:
            raise AttributeError(missing.args[0]) from None

    def __setattr__(self, name: str, value: Any) -> None:
        if hasattr(type(self), name):
            object.__setattr__(self, name, value)
            return
        try:
            self[name] = value
        except KeyError as missing:
            raise AttributeError(missing.args[0]) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.parameters]

    @property
    def time(self) -> float:
        """Seconds of the frame."""
        return lib.krs_state_time(self._state.pointer)

    @time.setter
    def time(self, seconds: float) -> None:
        with self._state.lock:
            self._state.set_time(seconds)

    @property
    def zones(self) -> np.ndarray:
        """Balls [x, y, z, radius] that are kept empty, at most 16."""
        return self._zones

    @zones.setter
    def zones(self, balls: ArrayLike) -> None:
        zones = native.block(balls, "zones").copy()
        if zones.size % 4 or (zones.size and zones.shape[-1] != 4):
            raise ArgumentError(f"zones must be an array of balls [x, y, z, radius], not of shape {zones.shape}")
        zones = zones.reshape(-1, 4)
        with self._state.lock:
            self._state.set_zones(zones)
        zones.flags.writeable = False
        object.__setattr__(self, "_zones", zones)

    def values(self, *, time: float | None = None, **values: ArrayLike) -> Scene:
        """The same scene at other values, which does not follow this one: for threads, and for comparisons.

        >>> ball = compile("param r = 1 in [0, 9]; show sphere(r);")
        >>> ball.values(r=2).distance([3, 0, 0]), ball.r
        (1.0, 1.0)
        """
        other = Scene(self._compiled)
        for name, set_to in self._set.items():
            other[name] = set_to
        if len(self._zones):
            other.zones = self._zones
        if time is not None or self.time != 0:
            other.time = self.time if time is None else time
        for name, value in values.items():
            other[name] = value
        return other

    def __reduce__(self) -> Any:
        """Other processes compile the text anew, at the same values."""
        compiled = self._compiled
        return _restore, (compiled.text, compiled.name, compiled.options, dict(self._set), self.time, self._zones)

    # -- what there is --

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """Parameters by their names, in the order of the text."""
        return self._compiled.parameters

    @property
    def text(self) -> str:
        """The text of the scene."""
        return self._compiled.text.decode()

    @property
    def name(self) -> str:
        """What diagnostics call the text."""
        return self._compiled.name

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings, and the notes of `print`."""
        return list(self._compiled.diagnostics)

    def files(self) -> dict[str, bytes]:
        """Files that the scene is read from, but for its own: by their paths, as they are now."""
        load = self._compiled.options.get("load")
        read = load or (lambda path: Path(path).read_bytes() if os.path.isfile(path) else None)
        found = {path: read(path) for path in self._compiled.opened if path != self.name}
        return {path: data.encode() if isinstance(data, str) else data for path, data in found.items() if data is not None}

    @property
    def components(self) -> list[SimpleNamespace]:
        """What each `show` shows: name, box (`low`, `high`), slope, whether it is `exact`, and so on as KrsComponent has it."""
        count = lib.krs_component_count(self._compiled.pointer)
        return [self._compiled.ask(lib.krs_component_sized, "KrsComponent", index) for index in range(count)]

    @property
    def materials(self) -> list[str]:
        """Names of materials, for the numbers that hits have: from 1 on."""
        count = lib.krs_material_count(self._compiled.pointer)
        names = (lib.krs_material_name(self._compiled.pointer, number) for number in range(1, count + 1))
        return [ffi.string(name).decode() if name else "" for name in names]

    @property
    def box(self) -> np.ndarray | None:
        """Two corners of the box around all that has an end, at these values; None: nothing has."""
        corners = np.empty((2, 3))
        with self._state.lock:
            found = lib.krs_state_box(self._state.pointer, *(native.pointer(row, "double *") for row in corners))
        return corners if found else None

    def __str__(self) -> str:
        return format(self.text, self.name)

    def __repr__(self) -> str:
        values = "".join(f", {name}={self[name]}" for name in self.parameters)
        return f"<krs.Scene {self.name}: {len(self.components)} components{values}>"

    def glsl(self, target: str = "glsl", **options: Any) -> str:
        """The scene as a shader: "glsl" or "essl"; options are those of KrsTextOptions."""
        struct = native.fill(ffi.new("KrsTextOptions *"), options, "glsl")
        number = native._choice(ffi.typeof("KrsTarget"), target, "target")
        made = ffi.new("char **")
        status = lib.krs_text_sized(self._compiled.pointer, number, struct, ffi.sizeof("KrsTextOptions"), made)
        if status == lib.KRS_BAD_SCENE:
            large = lib.krs_scene_too_large(self._compiled.pointer)
            raise ArgumentError(ffi.string(large.message).decode())
        check(status, "cannot print the scene")
        return native.take_text(made[0])

    def camera(self, which: int | str = 0) -> Camera:
        """A camera of the scene, by its number or its name; without one, that which shows everything."""
        struct = ffi.new("KrsCamera *")
        with self._state.lock:
            lib.krs_state_fit_camera(self._state.pointer)
            number = find_camera(self._compiled.pointer, which)
            status = lib.krs_state_camera_sized(self._state.pointer, number, struct, ffi.sizeof("KrsCamera"))
        check(status, f"there is no camera {which!r}")
        return Camera(struct)

    # -- questions --

    def _ask(self, device: str | None, here: Any, there: Any, message: str, *arguments: Any) -> None:
        """Asks the host, or a device."""
        if device is not None:
            from krs.picture import ask
            ask(self, device, there, *arguments)
            return
        with self._state.lock:
            status = here(self._state.pointer, *arguments)
        check(status, message)

    def distance(self, points: ArrayLike, out: np.ndarray | None = None, device: str | None = None) -> Any:
        """Signed distances, negative inside: never above the distance to the nearest surface.  `points` has any shape (..., 3).

        `device`, "" for the usual one, asks a Vulkan device, in single precision: for millions of points.

        >>> compile("show box([2, 2, 2]);").distance([[0, 0, 0], [2, 0, 0], [2, 2, 1]])
        array([-1.        ,  1.        ,  1.41421356])
        """
        dtype, kind = (np.float64, "double") if device is None else (np.float32, "float")
        at = native.rows(points, 3, "points", dtype)
        found = native.target(out, at.shape[:-1], dtype)
        self._ask(device, lib.krs_distance, lib.krs_device_distance, "coordinates must be finite",
                  native.pointer(at, f"const {kind} (*)[3]"), at.size // 3, native.pointer(found, f"{kind} *"))
        return found if found.ndim else float(found)

    def normals(self, points: ArrayLike, out: np.ndarray | None = None) -> np.ndarray:
        """Unit gradients of the distance, outwards; 0 where there is none.

        >>> compile("show sphere(1);").normals([0, 5, 0])
        array([0., 1., 0.])
        """
        at = native.rows(points, 3, "points")
        found = native.target(out, at.shape, np.float64)
        self._ask(None, lib.krs_normal, None, "coordinates must be finite",
                  native.pointer(at, "const double (*)[3]"), at.size // 3, native.pointer(found, "double (*)[3]"))
        return found

    def probe(self, points: ArrayLike, device: str | None = None) -> np.recarray:
        """All that is known at points, an array with the members of KrsHit: `distance`, `normal`, `component`, `color`, ...

        >>> compile("show sphere(1).paint(red);").probe([[0, 2, 0], [0, 0, 3]]).color
        array([[1., 0., 0.],
               [1., 0., 0.]])
        """
        at = native.rows(points, 3, "points")
        hits = np.zeros(at.shape[:-1], HIT)
        self._ask(device, lib.krs_probe_sized, lib.krs_device_probe_sized, "coordinates must be finite",
                  native.pointer(at, "const double (*)[3]"), at.size // 3, native.pointer(hits, "KrsHit *"), HIT.itemsize)
        return hits.view(np.recarray)

    def raycast(self, origins: ArrayLike, directions: ArrayLike, farthest: float = np.inf, tolerance: float = 0,
                device: str | None = None) -> np.recarray:
        """Where rays hit first, an array with the members of KrsHit: `hit`, `t`, `point`, `normal`, `component`, ...

        Directions have any length but 0; `t` counts along the unit direction.  One origin, or one direction, may be that of
        all rays.  `unresolved` rays hit nothing before `t`.

        >>> hits = compile("show sphere(1);").raycast([[0, 0, 9], [0, 3, 9]], [0, 0, -1])
        >>> hits.hit, hits.t[0]
        (array([ True, False]), 8.0)
        """
        starts, along = native.rows(origins, 3, "origins"), native.rows(directions, 3, "directions")
        try:
            starts, along = map(np.ascontiguousarray, np.broadcast_arrays(starts, along))
        except ValueError:
            raise ArgumentError(f"origins of shape {starts.shape} and directions of shape {along.shape} make no rays: "
                                "there must be as many of both, or one of either") from None
        hits = np.zeros(starts.shape[:-1], HIT)
        self._ask(device, lib.krs_raycast_sized, lib.krs_device_raycast_sized,
                  "numbers must be finite, directions not 0, and `farthest` and `tolerance` not negative",
                  native.pointer(starts, "const double (*)[3]"), native.pointer(along, "const double (*)[3]"), starts.size // 3,
                  farthest, tolerance, native.pointer(hits, "KrsHit *"), HIT.itemsize)
        return hits.view(np.recarray)

    # -- solids --

    def _solid(self, kind: str, options: dict[str, Any], progress: Progress) -> Any:
        """Options of what is made of solids: a component by its name, and a box that is looked at."""
        within = options.pop("within", None)
        if within is not None:
            low, high = native.vector(within, 6, "`within`, two corners of a box,").reshape(2, 3)
            options.update(within=True, low=low, high=high)
        component = options.get("component", 0)
        if isinstance(component, str):
            names = [c.name for c in self.components]
            if component not in names:
                raise ArgumentError(f"no component is called {component!r}, but {', '.join(map(str, names))}")
            options["component"] = names.index(component) + 1
        struct = native.fill(ffi.new(f"{kind} *"), options, kind)
        struct.progress = progress.pointer
        return struct

    def mesh(self, error: float = 0, *, progress: Callable[[float], Any] | None = None, **options: Any) -> Mesh:
        """A closed mesh within an error of the surface; 0: a 200th of the longest side of the box.

        Options are members of KrsMeshOptions: `component`, a name or a number from 1; `within`, two corners of a box, for
        what has no end; `even`, `simplify`, `draft` and so on.  `progress` is called with the part that is done; False
        ends the work, with krs.Interrupted.

        >>> ball = compile("show sphere(1);").mesh(0.02)
        >>> ball.vertices.shape[1], bool(abs(ball.volume - 4.18879) < 0.1)
        (3, True)
        """
        done = Progress(progress)
        struct = self._solid("KrsMeshOptions", {"error": error, **options}, done)
        with self._state.lock:
            made = native.make(lib.krs_mesh_sized, self._state.pointer, struct, "KrsMesh",
                               "what is meshed has no end, is no solid, or the error is too small", done)
        return Mesh(Handle(made, lib.krs_mesh_free, self._compiled))

    def measure(self, *, progress: Callable[[float], Any] | None = None, **options: Any) -> SimpleNamespace:
        """Figures of a part, as KrsMeasures has them: `volume` and `volume_error`, `center`, `area`, the thinnest `wall`, ...

        Options are members of KrsMeasureOptions: `error`, `component`, `within`, `up`, `overhang`, `nozzle`.
        """
        done = Progress(progress)
        struct = self._solid("KrsMeasureOptions", options, done)
        with self._state.lock:
            made = native.make(lib.krs_measure_sized, self._state.pointer, struct, "KrsMeasures",
                               "what is measured has no end, or is no solid", done)
        told = native.tell(made[0])
        told.orientations = [native.tell(made.orientations[i]) for i in range(made.orientation_count)]
        lib.krs_measures_free(made)
        return told

    def grid(self, cell: float, *, progress: Callable[[float], Any] | None = None, **options: Any) -> Grid:
        """Signed distances at points whose coordinates are whole multiples of the side of a cell.

        Options are members of KrsGridOptions: `exact`, `band`, `fog`, `component`, `within`.
        """
        done = Progress(progress)
        struct = self._solid("KrsGridOptions", {"cell": cell, **options}, done)
        with self._state.lock:
            made = native.make(lib.krs_grid_new_sized, self._state.pointer, struct, "KrsGrid",
                               "what is sampled has no end, is no solid, or there are too many samples", done)
            return Grid(Handle(made, lib.krs_grid_free, self._state), done)

    def section(self, point: ArrayLike, normal: ArrayLike, error: float = 0, *,
                progress: Callable[[float], Any] | None = None, **options: Any) -> Section:
        """Closed contours where a plane cuts the solid, which is on their left, seen from where the normal points.

        Options are members of KrsSliceOptions: `component`, `within`, `arcs`.
        """
        done = Progress(progress)
        struct = self._solid("KrsSliceOptions", {"error": error, **options}, done)
        plane = native.fill(ffi.new("KrsSectionPlane *"), {"point": point, "normal": normal}, "section")
        section = ffi.new("KrsSection **")
        with self._state.lock:
            slicer = native.make(lib.krs_slicer_new_sized, self._state.pointer, struct, "KrsSlicer",
                                 "what is cut has no end, is no solid, or the error is too small", done)
            status = lib.krs_slice(slicer, plane, 1, section)
            lib.krs_slicer_free(slicer)
        check(status, "the plane must have a direction", done)
        return Section(Handle(section[0], lib.krs_section_free), plane)

    # -- pictures --

    def render(self, size: tuple[int, int] | None = None, **options: Any) -> Any:
        """A picture of `size` (width, height), with all its AOVs: see krs.picture.render."""
        from krs.picture import render
        return render(self, size, **options)

    def _repr_png_(self) -> bytes:
        """What notebooks show: a preview, which takes seconds whatever the scene's `image` block asks for."""
        return self.render((480, 320), samples=4, integrator="preview").png()


def _restore(text: bytes, name: str, options: dict[str, Any], values: dict[str, np.ndarray], time: float,
             zones: np.ndarray) -> Scene:
    scene = Scene(_Compiled(text, name, options))
    scene.zones = zones
    return scene.values(time=time, **values)


def find_camera(scene: Any, which: int | str) -> int:
    """The number of a camera."""
    if not isinstance(which, str):
        return which
    count = lib.krs_camera_count(scene)
    names = [ffi.string(name).decode() if name else None for name in (lib.krs_camera_name(scene, i) for i in range(count))]
    if which not in names:
        raise ArgumentError(f"no camera is called {which!r}, but {', '.join(n for n in names if n) or 'none has a name'}")
    return names.index(which)


def format(text: str, name: str = "scene.krs") -> str:
    """The canonical layout of a text: blanks change, but no word, comment or break between lines.

    >>> print(format("show   sphere( 1 );"), end="")
    show sphere(1);
    """
    said: list[Diagnostic] = []
    handle = ffi.new_handle(said)
    struct = ffi.new("KrsOptions *", {"diagnostic": _listen, "user": handle})
    made, same, data = ffi.new("char **"), ffi.new("bool *"), text.encode()
    status = lib.krs_format_text_sized(data, len(data), os.fsencode(name), struct, ffi.sizeof("KrsOptions"), made, same)
    if status == lib.KRS_BAD_SCENE:
        raise SceneError(said)
    check(status, "cannot lay out the text")
    return native.take_text(made[0])
