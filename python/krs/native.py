"""The C library: how it is found, and what stands between it and Python.

Functions of the library run without Python's lock, so other threads go on.  Structs are those of its headers, and arrays
are handed over in place.
"""
from __future__ import annotations

import os
import threading
from types import SimpleNamespace
from typing import Any, Callable

import numpy as np

from krs import errors
from krs._declarations import ffi
from krs._tables import VERSION


def _load() -> tuple[Any, str]:
    """KRS_LIBRARY, the library in this folder, or that of the system; and its path."""
    minor = VERSION.rsplit(".", 1)[0]
    beside = os.path.join(os.path.dirname(__file__), "libkrs.so")
    path = os.environ.get("KRS_LIBRARY") or (beside if os.path.exists(beside) else f"libkrs.so.{minor}")
    try:
        library = ffi.dlopen(path)
    except OSError as reason:
        raise ImportError(f"cannot load the library of krs: {reason}; KRS_LIBRARY names another") from None
    found = ffi.string(library.krs_version()).decode()
    if found.rsplit(".", 1)[0] != minor:
        raise ImportError(f"{path} is krs {found}, and this package needs {minor}")
    return library, path


lib, path = _load()
version = ffi.string(lib.krs_version()).decode()
_c = ffi.dlopen(None)


# ---- what the library owns ----


class _Owned:
    """An object of the library, and how many need it.  It is freed before those that it needs itself.

    Objects of Python that refer to each other in a circle end in any order, as all do when Python ends.  So users are
    counted here.  What is done to the lists is one step, whatever thread or collector comes between.
    """

    def __init__(self, pointer: Any, free: Callable[[Any], None], needs: list[_Owned]):
        self.pointer, self.needs = pointer, needs
        self.free, self.users = [free], [True]
        for other in needs:
            other.users.append(True)

    def release(self) -> None:
        self.users.pop()
        if self.users:
            return
        try:
            free = self.free.pop()
        except IndexError:
            return
        free(self.pointer)
        for other in self.needs:
            other.release()


class Handle:
    """An object of the library.  It is freed when nobody refers to this one, or to what needs it."""

    _owned: _Owned | None = None

    def __init__(self, pointer: Any, free: Callable[[Any], None], *needs: Handle):
        self.pointer = pointer
        self._owned = _Owned(pointer, free, [other._owned for other in needs if other._owned])
        self.lock = threading.Lock()

    def __del__(self) -> None:
        if self._owned:
            self._owned.release()


class _Block:
    """Memory of an object, for NumPy."""

    def __init__(self, owner: Any, pointer: Any, shape: tuple[int, ...], dtype: Any):
        self.owner = owner
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": np.dtype(dtype).str,
                                    "data": (int(ffi.cast("uintptr_t", pointer)), False)}


def view(owner: Any, pointer: Any, shape: tuple[int, ...], dtype: Any) -> np.ndarray:
    """An array that is memory of the library, and keeps its owner."""
    if 0 in shape:
        return np.empty(shape, dtype)
    return np.asarray(_Block(owner, pointer, shape, dtype))


def take_text(pointer: Any) -> str:
    """A text that the library hands out."""
    try:
        return ffi.string(pointer).decode()
    finally:
        _c.free(pointer)


# ---- arrays ----

_dtypes = {"_Bool": np.bool_, "double": np.float64, "float": np.float32, "uint32_t": np.uint32, "int": np.int32,
           "size_t": np.uintp, "int64_t": np.int64, "uint64_t": np.uint64}


def dtype_of(name: str) -> np.dtype:
    """A struct of numbers as NumPy has it."""
    names, formats, offsets = [], [], []
    for member, field in ffi.typeof(name).fields:
        kind = field.type
        names.append(member)
        formats.append((_dtypes[kind.item.cname], (kind.length,)) if kind.kind == "array" else _dtypes[kind.cname])
        offsets.append(field.offset)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": ffi.sizeof(name)})


def block(values: Any, what: str, dtype: Any = np.float64) -> np.ndarray:
    """Numbers as one block; an array that is such is not copied."""
    try:
        return np.ascontiguousarray(values, dtype=dtype)
    except (TypeError, ValueError) as reason:
        raise errors.ArgumentError(f"{what} must be numbers, in rows of one length: {reason}") from None


def vector(values: Any, count: int, what: str) -> np.ndarray:
    """So many numbers."""
    array = np.ravel(block(values, what))
    if array.size != count:
        raise errors.ArgumentError(f"{what} must have {count} numbers, not {array.size}")
    return array


def rows(values: Any, columns: int, what: str, dtype: Any = np.float64) -> np.ndarray:
    """Vectors as one block; an array that is such is not copied."""
    array = block(values, what, dtype)
    if array.ndim == 0 or array.shape[-1] != columns:
        raise errors.ArgumentError(f"{what} must be an array of vectors of {columns}, not of shape {array.shape}")
    return array


def target(out: np.ndarray | None, shape: tuple[int, ...], dtype: Any) -> np.ndarray:
    """The array of the caller, if it fits, or a new one."""
    if out is None:
        return np.empty(shape, dtype)
    if out.shape != shape or out.dtype != dtype or not out.flags.c_contiguous or not out.flags.writeable:
        raise errors.ArgumentError(f"`out` must be a writable block of {np.dtype(dtype)} of shape {shape}")
    return out


def pointer(array: np.ndarray, kind: str) -> Any:
    return ffi.cast(kind, array.__array_interface__["data"][0])


# ---- structs ----


def _choice(kind: Any, value: Any, member: str) -> int:
    """A number of an enum, by its word: "path" of KRS_INTEGRATOR_PATH."""
    if not isinstance(value, str):
        return int(value)
    words = {name.lower(): number for name, number in kind.relements.items() if not name.endswith("_COUNT")}
    ending = "_" + value.lower().replace("-", "_")
    found = [number for name, number in words.items() if name.endswith(ending)]
    if not found:
        start = os.path.commonprefix(list(words))
        known = ", ".join(name[len(start):].replace("_", "-") for name in words)
        raise errors.ArgumentError(f"`{member}` cannot be {value!r}; it is one of {known}")
    return found[0]


def fill(struct: Any, values: dict[str, Any], what: str) -> Any:
    """Sets members of a struct by their names."""
    kind = ffi.typeof(struct)
    fields = dict((kind.item if kind.kind == "pointer" else kind).fields)
    for member, value in values.items():
        if member not in fields:
            raise errors.ArgumentError(f"{what} has no option `{member}`")
        kind = fields[member].type
        if kind.kind == "struct":
            fill(getattr(struct, member), value, f"`{member}`")
        elif kind.kind == "array":
            setattr(struct, member, vector(value, kind.length, f"`{member}`").tolist())
        else:
            setattr(struct, member, _choice(kind, value, member) if kind.kind == "enum"
                    else bool(value) if kind.cname == "_Bool" else value)
    return struct


def numbers(value: Any, kind: Any) -> np.ndarray:
    """A copy of an array of numbers."""
    shape = []
    while kind.kind == "array":
        shape.append(kind.length)
        kind = kind.item
    return np.frombuffer(ffi.buffer(value), _dtypes[kind.cname]).reshape(shape).copy()


def tell(struct: Any) -> SimpleNamespace:
    """The numbers and texts of a struct, by the names of its members."""
    told: dict[str, Any] = {}
    for member, field in ffi.typeof(struct).fields:
        value, kind = getattr(struct, member), field.type
        if kind.kind == "struct":
            told[member] = tell(value)
        elif kind.kind == "array" and kind.item.cname == "char":
            told[member] = ffi.string(value).decode()
        elif kind.kind == "array" and kind.item.kind != "pointer":
            told[member] = numbers(value, kind)
        elif kind.cname == "char *":
            told[member] = ffi.string(value).decode() if value else None
        elif kind.kind in ("primitive", "enum"):
            told[member] = value
    return SimpleNamespace(**told)


# ---- callbacks and failures ----


class Progress:
    """Tells how far the work is, and ends it: by False, by an exception, or by an interrupt of the user."""

    def __init__(self, callback: Callable[[float], Any] | None):
        self._callback = callback
        self.raised: BaseException | None = None
        self.pointer = ffi.callback("bool(void *, double)", self._tell, error=False, onerror=self._keep)

    def _tell(self, _user: Any, done: float) -> bool:
        answer = None if self._callback is None else self._callback(done)
        return bool(answer) if isinstance(answer, (bool, np.bool_)) else True

    def _keep(self, _kind: Any, exception: BaseException, _trace: Any) -> None:
        self.raised = exception


_kinds = {lib.KRS_BAD_ARGUMENT: errors.ArgumentError, lib.KRS_NO_DEVICE: errors.DeviceError,
          lib.KRS_OUT_OF_MEMORY: errors.MemoryLimit, lib.KRS_INTERRUPTED: errors.Interrupted}


# What is known without asking what was done.
_messages = {lib.KRS_OUT_OF_MEMORY: "memory has run out, or the limit of an option is reached",
             lib.KRS_INTERRUPTED: "`progress` returned False, which ends the work"}


def check(status: int, message: str, progress: Progress | None = None) -> None:
    """Raises what a status means; `message` is that of an argument that cannot be, and of failures that have no other."""
    if progress is not None and progress.raised is not None:
        raise progress.raised
    if status != lib.KRS_OK:
        raise _kinds.get(status, errors.InternalError)(_messages.get(status, message))


def make(function: Any, owner: Any, struct: Any, kind: str, message: str, progress: Progress | None = None) -> Any:
    """What a function makes of an object by options, which are NULL or a struct."""
    made = ffi.new(f"{kind} **")
    size = ffi.sizeof(ffi.typeof(struct).item)
    check(function(owner, struct, size, made), message, progress)
    return made[0]
