"""Meshes, grids, sections and figures of solids."""
import ctypes
import gc
import threading
import time
import unittest
import weakref
from collections import Counter

import numpy as np

import krs
from krs import native
from krs.native import ffi

RING = "show torus(2, 0.5);"
VOLUME = 2 * np.pi ** 2 * 2 * 0.5 ** 2


def ring_distance(points):
    """Of the ring, around y."""
    return np.hypot(np.hypot(points[..., 0], points[..., 2]) - 2, points[..., 1]) - 0.5


class Meshes(unittest.TestCase):
    def test_closed(self):
        """a mesh is closed, within its error, and has the volume of the solid"""
        mesh = krs.compile(RING).mesh(0.01)
        edges = mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        counted = Counter(map(tuple, edges.tolist()))
        self.assertEqual(set(counted.values()), {1})
        self.assertTrue(all((b, a) in counted for a, b in counted))
        self.assertLessEqual(mesh.error, 0.01)
        self.assertLess(abs(mesh.volume - VOLUME), mesh.error * 4 * np.pi ** 2)
        self.assertGreater(mesh.volume, 0.97 * VOLUME)
        self.assertLess(np.abs(ring_distance(mesh.vertices)).max(), 0.01)
        self.assertLess(abs(mesh.area / (4 * np.pi ** 2) - 1), 0.02)

    def test_in_place(self):
        """arrays of a mesh are memory of the library, which lives as long as they do"""
        mesh = krs.compile(RING).mesh(0.1, draft=True)
        pointers = mesh._handle.pointer.vertices, mesh._handle.pointer.triangles
        for array, pointer in zip((mesh.vertices, mesh.triangles), pointers):
            self.assertEqual(array.ctypes.data, int(ffi.cast("uintptr_t", pointer)))
        freed, vertices, copy = weakref.ref(mesh._handle), mesh.vertices, mesh.vertices.copy()
        del mesh, array
        gc.collect()
        self.assertIsNotNone(freed())
        np.testing.assert_array_equal(vertices, copy)
        del vertices
        self.assertIsNone(freed())

    def test_components(self):
        """a component is chosen by its name, and a box cuts what has no end"""
        scene = krs.compile("let ball = sphere(1); show ball; show plane();")
        self.assertLess(abs(scene.mesh(0.02, component="ball").volume - 4 / 3 * np.pi), 0.15)
        cut = scene.mesh(0.05, component=2, within=([-1, -1, -1], [1, 1, 1]))
        self.assertAlmostEqual(cut.volume, 4, places=6)
        self.assertEqual(cut.vertices.min(), -1)

    def test_simplify(self):
        """triangles are left out within a further error"""
        mesh = krs.compile("show sphere(1);").mesh(0.01)
        fewer = mesh.simplify(0.05)
        self.assertLess(len(fewer.triangles), len(mesh.triangles) / 2)
        self.assertLess(np.abs(np.linalg.norm(fewer.vertices, axis=1) - 1).max(), 0.06)

    def test_trimesh(self):
        """trimesh takes the arrays, where it is installed"""
        try:
            import trimesh  # noqa: F401
        except ImportError:
            self.skipTest("no trimesh")
        mesh = krs.compile(RING).mesh(0.05).trimesh()
        self.assertTrue(mesh.is_watertight)

    def test_progress(self):
        """who is told the progress may end the work, by False or by an exception"""
        scene, told = krs.compile(RING), []
        scene.mesh(0.02, progress=told.append)
        self.assertTrue(told and all(0 <= done <= 1 for done in told) and told == sorted(told))
        with self.assertRaisesRegex(krs.Interrupted, "`progress` returned False"):
            scene.mesh(0.02, progress=lambda done: False)
        with self.assertRaises(krs.Interrupted):
            scene.mesh(0.02, progress=lambda done: np.float64(done) < 0)
        self.assertGreater(scene.mesh(0.05, progress=lambda done: 0).volume, 0)  # 0 is an answer of other functions

        def interrupt(done):
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            scene.mesh(0.02, progress=interrupt)
        self.assertLess(scene.distance([2, 0, 0]), 0)  # it goes on

    def test_others(self):
        """figures, sections and grids are those of closed forms"""
        scene = krs.compile(RING)
        figures = scene.measure(error=0.02)
        self.assertLessEqual(abs(figures.volume - VOLUME), figures.volume_error)
        self.assertLess(figures.volume_error, 0.05 * VOLUME)
        self.assertTrue(figures.orientations and abs(figures.wall.thickness - 1) < 1e-3)
        section = scene.section([0, 0, 0], [0, 1, 0], 1e-4)
        self.assertEqual(sorted(np.sign(section.areas)), [-1, 1])
        self.assertLess(abs(section.area - np.pi * (2.5 ** 2 - 1.5 ** 2)), 0.01)
        points = section.in_space(section.contours[0])
        np.testing.assert_allclose(ring_distance(points), 0, atol=2e-4)
        grid = scene.grid(0.25)
        at = np.stack(np.meshgrid(*(grid.origin[i] + grid.cell * np.arange(grid.values.shape[i]) for i in range(3)),
                                  indexing="ij"), axis=-1)
        np.testing.assert_allclose(grid.values, ring_distance(at), atol=1e-5)


class Threads(unittest.TestCase):
    def test_at_once(self):
        """two threads compute at once, and find what one finds"""
        scene = krs.compile("param r = 1 in [0, 9]; show sphere(r) | box([1, 2, 3]);")
        points = np.random.default_rng(1).normal(size=(20000, 3))
        alone = [scene.values(r=r).distance(points) for r in (1, 2)]
        found = [None, None]

        def work(number):
            own = scene.values(r=number + 1)
            for _ in range(20):
                found[number] = own.distance(points)
        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for one, other in zip(alone, found):
            np.testing.assert_array_equal(one, other)

    def goes_on(self, call):
        """Whether Python goes on in the middle of a call in another thread."""
        span, ticks = [], []

        def work():
            begun = time.perf_counter()
            call()
            span.extend((begun, time.perf_counter()))
        thread = threading.Thread(target=work)
        thread.start()
        while thread.is_alive():
            ticks.append(time.perf_counter())
            time.sleep(0.001)
        begun, ended = span
        quarter = (ended - begun) / 4
        self.assertGreater(quarter, 0.01)
        return any(begun + quarter < tick < ended - quarter for tick in ticks)

    def test_lock(self):
        """Python goes on while the library computes, and would not if its lock were held"""
        scene = krs.compile("show union([sphere(0.1).move([i, sin(i), 0]) for i in 0..40], blend: 0.3);")
        points = np.random.default_rng(1).uniform(-40, 40, (400000, 3))
        out = np.empty(len(points))
        self.assertTrue(self.goes_on(lambda: scene.distance(points, out=out)))
        held = ctypes.PyDLL(native.path).krs_distance
        held.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p]
        state = int(ffi.cast("uintptr_t", scene._state.pointer))
        self.assertFalse(self.goes_on(lambda: held(state, points.ctypes.data, len(points), out.ctypes.data)))


def resident():
    """Bytes of this process in memory."""
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * 4096


class Memory(unittest.TestCase):
    def test_freed(self):
        """scenes, states and meshes are freed, in the order that the library wants"""
        scene = krs.compile(RING)
        other = scene.values()
        refs = [weakref.ref(x) for x in (scene._compiled, scene._state, other._state)]
        del scene
        gc.collect()
        self.assertEqual([ref() is None for ref in refs], [False, True, False])
        del other
        gc.collect()
        self.assertTrue(all(ref() is None for ref in refs))

    def test_many(self):
        """many scenes need no more memory than one"""
        def use():
            scene = krs.compile("param r = 1 in [0.5, 2]; show box([r, 1, 1]) | sphere(0.6);")
            scene.r = 2
            scene.distance(np.zeros((1000, 3)))
            scene.mesh(0.05)
            str(scene)
        for _ in range(3):
            use()
        before = resident()
        for _ in range(30):
            use()
        self.assertLess(resident() - before, 12 << 20)

    def test_handles(self):
        """what failed in its making is not freed, and circles are freed in the order that the library wants"""
        freed = []

        class Failed(native.Handle):
            def __init__(self):
                raise ValueError
        with self.assertRaises(ValueError):
            Failed()
        handle = native.Handle("pointer", freed.append)
        del handle
        self.assertEqual(freed, ["pointer"])
        for order in ((0, 1, 2), (2, 1, 0), (1, 2, 0)):
            freed.clear()
            whole = native.Handle("whole", freed.append)
            part = native.Handle("part", freed.append, whole)
            circle = [whole, part, native.Handle("piece", freed.append, part, whole)]
            for number in order:
                circle[number].__del__()  # as a collector does
                circle[number]._owned = None
            self.assertEqual(freed, ["piece", "part", "whole"])
