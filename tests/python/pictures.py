"""Pictures and their AOVs, beside rays of the host."""
import gc
import struct
import unittest
import weakref
import zlib

import numpy as np

import krs
from krs import native

SCENE = """
camera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }
camera side { eye: [5, 0, 0], target: [0, 0, 0], fov: 40deg }
light sun { direction: [1, 2, 3] }
param r = 1 in [0.5, 2];
let ball = sphere(r).paint(#ff0000);
let cube = box([1, 1, 1]).move([1, 0, 0]);
show ball;
show cube;
"""
SIZE = WIDTH, HEIGHT = 48, 32


def camera_rays():
    """Through the centres of pixels, by the rules of docs: row 0 is the top, the field of view is vertical."""
    x = (np.arange(WIDTH) + 0.5 - WIDTH / 2) / (HEIGHT / 2)
    y = -(np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / (HEIGHT / 2)
    across, up = np.meshgrid(x, y)
    tangent = np.tan(np.radians(20))
    return np.stack([across * tangent, up * tangent, -np.ones_like(across)], axis=-1)


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = krs.compile(SCENE)
        try:
            cls.picture = cls.scene.render(SIZE)
        except krs.DeviceError as why:
            raise unittest.SkipTest(f"no device: {why}")

    def test_shapes(self):
        """a picture has all AOVs, as arrays of its size"""
        vectors = {"color": 4, "position": 3, "normal": 3, "albedo": 3}
        self.assertEqual(set(self.picture.arrays), {*vectors, "depth", "component", "level", "instance", "steps"})
        for name, array in self.picture.arrays.items():
            self.assertEqual(array.shape, (HEIGHT, WIDTH, vectors[name]) if name in vectors else (HEIGHT, WIDTH), name)
            self.assertIs(getattr(self.picture, name), array)
        self.assertEqual(np.asarray(self.picture).shape, (HEIGHT, WIDTH, 4))
        self.assertIsNone(self.picture.noise)

    def test_depth(self):
        """depths, positions and parts are those of rays of the host"""
        rays = camera_rays()
        hits = self.scene.raycast([0, 0, 5], rays)
        clear = np.abs(self.scene.distance(self.picture.position)) < 1  # all
        same = (self.picture.component == hits.component)
        self.assertGreater(same.mean(), 0.99)  # but for outlines
        hit = same & hits.hit & clear
        self.assertGreater(hit.sum(), 200)
        np.testing.assert_allclose(self.picture.depth[hit], 5 - hits.point[..., 2][hit], atol=5e-3)
        np.testing.assert_allclose(self.picture.position[hit], hits.point[hit], atol=5e-3)
        self.assertTrue(np.all(np.isinf(self.picture.depth[same & ~hits.hit])))
        red = self.picture.albedo[self.picture.component == 1]
        np.testing.assert_allclose(red, np.tile([1, 0, 0], (len(red), 1)), atol=1e-3)

    def test_values(self):
        """a picture is of the values and the time of the scene, and of the camera that is asked for"""
        larger = self.scene.values(r=2).render(SIZE, aovs=["component"])
        self.assertGreater((larger.component == 1).sum(), 2 * (self.picture.component == 1).sum())
        self.assertEqual(set(larger.arrays), {"component", "level", "instance"})
        side = self.scene.render(SIZE, camera="side", aovs=["component", "depth"])
        self.assertAlmostEqual(float(side.depth[HEIGHT // 2, WIDTH // 2]), 3.5, places=2)
        camera = self.scene.camera("side")
        camera.orbit(-np.pi / 2, 0)
        np.testing.assert_allclose(np.abs(camera.eye), [0, 0, 5], atol=1e-9)
        camera.dolly(None, 0.5)
        np.testing.assert_allclose(np.abs(camera.eye), [0, 0, 2.5], atol=1e-9)
        camera.aim(np.array([0, 1, 0]))
        np.testing.assert_allclose(camera.target, [0, 1, 0], atol=1e-9)
        camera = self.scene.camera("side")
        camera.eye, camera.target = [0, 0, 5], (0, 0, 0)
        moved = self.scene.render(SIZE, camera=camera, aovs=["component"])
        np.testing.assert_array_equal(moved.component, self.picture.component)
        crop = self.scene.render(SIZE, crop=(10, 5, 20, 8), aovs=["component"])
        np.testing.assert_array_equal(crop.component, self.picture.component[5:13, 10:30])

    def test_mattes(self):
        """mattes count the rays of each pixel, by what they hit"""
        picture = self.scene.render(SIZE, samples=4, mattes=True)
        components = picture.mattes[0]
        self.assertEqual(components.shape, (HEIGHT, WIDTH, 6))
        self.assertEqual(components["rays"].sum(axis=-1).max(), 4)
        first = components[..., 0]
        whole = first["rays"] == 4
        self.assertGreater(whole.sum(), 100)
        self.assertEqual(set(first["part"][whole]), {1, 2})

    def test_png(self):
        """a scene shows itself as a PNG of what a screen shows"""
        data = self.picture.png()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        chunks, at = {}, 8
        while at < len(data):
            length, name = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + length]
            self.assertEqual(zlib.crc32(name + body), struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0])
            chunks[name] = body
            at += 12 + length
        self.assertEqual(struct.unpack(">II", chunks[b"IHDR"][:8]), SIZE)
        rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(HEIGHT, -1)
        np.testing.assert_array_equal(rows[:, 1:].reshape(HEIGHT, WIDTH, 3), self.picture.srgb())
        self.assertEqual(self.picture.srgb(alpha=True).shape, (HEIGHT, WIDTH, 4))
        self.assertLess(self.picture.srgb(-2).mean(), self.picture.srgb().mean())
        small = krs.compile("show sphere(1);")
        self.assertTrue(small._repr_png_().startswith(b"\x89PNG"))

    def test_studio(self):
        """a scene without light is shown in a studio, and asked without it"""
        scene = krs.compile("show sphere(1); camera { eye: [0, 1, 6] }")
        shown, bare = scene.render(SIZE), scene.render(SIZE, studio=False)
        self.assertLessEqual({1, 2}, set(np.unique(shown.component)))
        self.assertEqual(set(np.unique(bare.component)), {0, 1})
        self.assertEqual(len(scene.components), 1)

    def test_freed(self):
        """a scene that was rendered is freed, behind its shaders"""
        scene = krs.compile("show sphere(1);")
        scene.render((8, 8))
        compiled = scene._compiled.for_pictures(True)
        rendering, = compiled.renderings.values()
        self.assertIn(compiled._owned, rendering._owned.needs)
        refs = [weakref.ref(x) for x in (scene._compiled, compiled, rendering)]
        owned = compiled._owned
        del scene, compiled, rendering
        gc.collect()
        self.assertEqual([ref() for ref in refs], [None] * 3)
        self.assertEqual((owned.users, owned.free), ([], []))

    def test_in_place(self):
        """AOVs are memory of the library"""
        pointer = int(native.ffi.cast("uintptr_t", self.picture._handle.pointer.depth))
        self.assertEqual(self.picture.depth.ctypes.data, pointer)

    def test_formats(self):
        """a file that would be no PNG is not written"""
        with self.assertRaisesRegex(ValueError, "krs render"):
            self.picture.save("picture.exr")

    def test_questions(self):
        """a device answers as the host does, in single precision"""
        points = np.random.default_rng(5).uniform(-3, 3, (5000, 3)).astype(np.float32)
        found = self.scene.distance(points, device="")
        self.assertEqual(found.dtype, np.float32)
        np.testing.assert_allclose(found, self.scene.distance(points), atol=2e-6)
        rays = camera_rays()
        there, here = (self.scene.raycast([0, 0, 5], rays, device=device) for device in ("", None))
        same = there.hit == here.hit
        self.assertGreater(same.mean(), 0.99)
        np.testing.assert_allclose(there.t[same & here.hit], here.t[same & here.hit], atol=1e-4)
        np.testing.assert_array_equal(there.component[same], here.component[same])
        with self.assertRaisesRegex(krs.ArgumentError, "finite|number"):
            self.scene.distance([[np.inf, 0, 0]], device="")

    def test_devices(self):
        """the device of the picture is one of the machine"""
        self.assertIn(self.picture.stats.device, [device.name for device in krs.devices()])
