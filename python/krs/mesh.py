"""What is made of solids: meshes, grids and sections, as arrays that are memory of the library."""
from __future__ import annotations

from typing import Any

import numpy as np

from krs import native
from krs.native import Handle, Progress, check, ffi, lib


class Mesh:
    """Triangles near a surface.  They are closed, do not cross, and are counter-clockwise seen from outside.

    `vertices` has a row for each corner, `triangles` their numbers.  `error` is the largest distance from the surface, as
    far as it is proven; other members are those of KrsMesh.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    error: float
    unresolved: int  # places where the surface may be farther away than that
    unresolved_at: np.ndarray
    estimate: bool  # nothing is proven
    colored: bool
    steps: bool

    def __init__(self, handle: Handle):
        mesh = handle.pointer
        self._handle = handle
        self.__dict__.update(vars(native.tell(mesh[0])))
        self.vertices = native.view(handle, mesh.vertices, (mesh.vertex_count, 3), np.float64)
        self.triangles = native.view(handle, mesh.triangles, (mesh.triangle_count, 3), np.uint32)

    def __repr__(self) -> str:
        return f"<krs.Mesh of {len(self.vertices)} vertices and {len(self.triangles)} triangles, error {self.error:.3g}>"

    def _corners(self) -> np.ndarray:
        return self.vertices[self.triangles]

    @property
    def volume(self) -> float:
        """What the triangles enclose."""
        a, b, c = np.moveaxis(self._corners(), 1, 0)
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)

    @property
    def area(self) -> float:
        a, b, c = np.moveaxis(self._corners(), 1, 0)
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)

    def simplify(self, error: float) -> Mesh:
        """Leaves out triangles that are not needed to stay within a further error."""
        done = Progress(None)
        struct = ffi.new("KrsMeshOptions *", {"error": error, "progress": done.pointer})
        made = native.make(lib.krs_mesh_simplify_sized, self._handle.pointer, struct, "KrsMesh",
                           "the error must be above 0", done)
        return Mesh(Handle(made, lib.krs_mesh_free, self._handle))

    def trimesh(self) -> Any:
        """A trimesh.Trimesh of the same arrays, where trimesh is installed."""
        import trimesh
        return trimesh.Trimesh(self.vertices, self.triangles, process=False)


class Grid:
    """Samples at points (first + [i, j, k]) * cell: `values[i, j, k]`, negative inside."""

    values: np.ndarray
    first: np.ndarray
    cell: float

    def __init__(self, handle: Handle, done: Progress):
        shape = ffi.new("KrsGridShape *")
        lib.krs_grid_shape_sized(handle.pointer, shape, ffi.sizeof("KrsGridShape"))
        self.cell, self.first = shape.cell, np.array(ffi.unpack(shape.first, 3))
        count = ffi.unpack(shape.count, 3)
        self.values = np.empty(count, np.float32, order="F")
        side = lib.KRS_BRICK_SIDE

        def take(_user: Any, brick: Any) -> bool:
            at = ffi.unpack(brick.at, 3)
            data = np.frombuffer(ffi.buffer(brick.values, 4 * side ** 3), np.float32).reshape((side,) * 3, order="F")
            room = tuple(slice(i, min(i + side, n)) for i, n in zip(at, count))
            self.values[room] = data[tuple(slice(0, r.stop - r.start) for r in room)]
            return True

        visit = ffi.callback("bool(void *, const KrsGridBrick *)", take, error=False, onerror=done._keep)
        check(lib.krs_grid_visit(handle.pointer, visit, ffi.NULL), "cannot sample", done)

    @property
    def origin(self) -> np.ndarray:
        """Where the first sample is."""
        return self.first * self.cell


class Section:
    """Closed contours in a plane.  `contours` are arrays of points, outer ones counter-clockwise, those of holes clockwise."""

    def __init__(self, handle: Handle, plane: Any):
        section = handle.pointer
        points = native.view(handle, section.points, (section.point_count, 2), np.float64)
        rows = [section.contours[i] for i in range(section.contour_count)]
        self.contours: list[np.ndarray] = [points[r.first:r.first + r.count] for r in rows]
        self.areas = np.array([r.area for r in rows])
        self.bulges: list[np.ndarray] | None = None
        if section.bulges:
            bulges = native.view(handle, section.bulges, (section.point_count,), np.float64)
            self.bulges = [bulges[r.first:r.first + r.count] for r in rows]
        self._axes = np.empty((2, 3))
        lib.krs_plane_axes(plane, *(native.pointer(row, "double *") for row in self._axes))
        self._plane = np.array([ffi.unpack(plane.point, 3), ffi.unpack(plane.normal, 3)])

    @property
    def area(self) -> float:
        return float(self.areas.sum())

    def in_space(self, contour: np.ndarray) -> np.ndarray:
        """Points of a contour in the scene."""
        point, normal = self._plane
        unit = normal / np.linalg.norm(normal)
        return contour @ self._axes + unit * (unit @ point)
