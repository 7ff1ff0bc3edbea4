"""What is asked of scenes, beside closed forms."""
import pickle
import unittest
import warnings

import numpy as np

import krs
from krs import native

RANDOM = np.random.default_rng(7)


def box_distance(points, size):
    q = np.abs(points) - np.asarray(size) / 2
    return np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)


class Questions(unittest.TestCase):
    def test_distances(self):
        """distances are those of closed forms, for arrays of any shape"""
        points = RANDOM.uniform(-3, 3, (40, 25, 3))
        ball = krs.compile("show sphere(1.5);").distance(points)
        self.assertEqual(ball.shape, (40, 25))
        np.testing.assert_allclose(ball, np.linalg.norm(points, axis=-1) - 1.5, rtol=0, atol=1e-12)
        box = krs.compile("show box([1, 2, 3]);").distance(points)
        np.testing.assert_allclose(box, box_distance(points, [1, 2, 3]), rtol=0, atol=1e-12)
        self.assertIsInstance(krs.compile("show sphere(1);").distance([0, 0, 3]), float)
        self.assertEqual(krs.compile("show sphere(1);").distance(np.empty((0, 3))).shape, (0,))

    def test_normals(self):
        """normals of a ball point away from its middle"""
        points = RANDOM.normal(size=(500, 3))
        normals = krs.compile("show sphere(1);").normals(points)
        np.testing.assert_allclose(normals, points / np.linalg.norm(points, axis=1)[:, None], rtol=0, atol=1e-9)

    def test_rays(self):
        """rays hit a ball where a quadratic equation says, or miss it"""
        origins, directions = RANDOM.normal(size=(2, 800, 3))
        origins *= 4 / np.linalg.norm(origins, axis=1)[:, None]
        directions = directions / np.linalg.norm(directions, axis=1)[:, None] - origins / 4
        hits = krs.compile("show box([9, 9, 9]).move([0, 90, 0]); let ball = sphere(1.5); show ball;").raycast(
            origins, 7 * directions, farthest=20)
        unit = directions / np.linalg.norm(directions, axis=1)[:, None]
        b = np.einsum("ij,ij->i", origins, unit)
        root = b ** 2 - (4 ** 2 - 1.5 ** 2)
        meets = (root > 1e-6) & (b < 0)
        self.assertGreater(meets.sum(), 100)
        self.assertGreater((~meets).sum(), 100)
        clear = np.abs(root) > 1e-6  # others graze it
        np.testing.assert_array_equal(hits.hit[clear], meets[clear])
        np.testing.assert_allclose(hits.t[meets], -b[meets] - np.sqrt(root[meets]), rtol=0, atol=1e-8)
        np.testing.assert_allclose(hits.point[meets], 1.5 * hits.normal[meets], rtol=0, atol=1e-7)
        self.assertEqual(set(hits.component[meets]), {2})
        self.assertEqual(set(hits.component[~hits.hit]), {0})

    def test_one_origin(self):
        """one origin may be that of all rays"""
        hits = krs.compile("show sphere(1);").raycast([0, 0, 5], [[0, 0, -2], [0, 0, 1]])
        self.assertEqual(hits.hit.tolist(), [True, False])
        self.assertEqual(hits.t[0], 4)

    def test_probe(self):
        """a probe tells part and material"""
        scene = krs.compile("material tin { color: #ffffff, roughness: 0.25 } "
                            "show sphere(1).paint(tin); show sphere(1).move([9, 0, 0]);")
        told = scene.probe([[0, 0, 2], [9, 0, 2]])
        self.assertEqual(told.component.tolist(), [1, 2])
        self.assertEqual(told.roughness[0], 0.25)
        self.assertEqual(scene.materials[told.material[0] - 1], "tin")

    def test_in_place(self):
        """arrays are neither copied on their way in nor out"""
        points = RANDOM.normal(size=(10, 3))
        self.assertTrue(np.shares_memory(native.rows(points, 3, "points"), points))
        scene, out = krs.compile("show sphere(1);"), np.full(10, np.nan)
        self.assertIs(scene.distance(points, out=out), out)
        np.testing.assert_allclose(out, np.linalg.norm(points, axis=1) - 1)
        hits = scene.raycast(points, -points)
        self.assertTrue(np.shares_memory(hits.t, hits))
        for wrong in (np.empty(9), np.empty(10, np.float32), np.empty(20)[::2]):
            with self.assertRaises(krs.ArgumentError):
                scene.distance(points, out=wrong)

    def test_refused(self):
        """numbers that cannot be are refused, and say why"""
        scene = krs.compile("show sphere(1);")
        for call in (lambda: scene.distance([[0, 0, np.nan]]), lambda: scene.distance([1, 2]), lambda: scene.distance(3),
                     lambda: scene.raycast([0, 0, 5], [0, 0, 0]), lambda: scene.mesh(1e-12),
                     lambda: krs.compile("show plane();").mesh(0.1), lambda: scene.mesh(0.1, component="none"),
                     lambda: scene.mesh(0.1, eror=2), lambda: scene.render((8, 8), aovs=["deep"]),
                     lambda: scene.render((8, 8), integrator="paths"), lambda: scene.render((8, 8), camera="left")):
            with self.assertRaises(krs.ArgumentError) as said:
                call()
            self.assertGreater(len(str(said.exception)), 15)

    def test_sizes(self):
        """arrays of wrong sizes are refused in words of the caller, wherever they go"""
        scene, camera = krs.compile("show sphere(1);"), krs.compile("show sphere(1);").camera()

        def set_eye(eye):
            camera.eye = eye

        def set_zones(zones):
            scene.zones = zones
        for call, words in (
                (lambda: scene.distance([[0, 0, 1], [2, 3]]), "points must be numbers, in rows of one length"),
                (lambda: scene.distance("abc"), "points must be numbers"),
                (lambda: scene.raycast([[0, 0, 5]] * 3, [[0, 0, 1]] * 2), r"origins of shape \(3, 3\) and directions of shape \(2, 3\)"),
                (lambda: scene.raycast([0, 0], [0, 0, 1]), "origins must be an array of vectors of 3"),
                (lambda: scene.raycast([0, 0, 1], [[0], [1]]), "directions must be an array of vectors of 3"),
                (lambda: set_eye([1, 2]), "`eye` must have 3 numbers, not 2"), (lambda: set_eye([1, 2, 3, 4]), "`eye` must have 3 numbers, not 4"),
                (lambda: camera.aim([1, 2]), "must have 3 numbers, not 2"), (lambda: camera.fit([0, 0, 0], [1, 1], 1), "must have 3 numbers, not 2"),
                (lambda: scene.mesh(0.1, within=[0, 1]), "`within`, two corners of a box, must have 6 numbers, not 2"),
                (lambda: scene.section([0, 0], [0, 1, 0]), "`point` must have 3 numbers, not 2"),
                (lambda: scene.render(8), "`size`, a width and a height, must have 2 numbers, not 1"),
                (lambda: scene.render((8, 8), crop=(1, 2, 3)), "`crop` must have 4 numbers, not 3"),
                (lambda: set_zones([1, 2, 3]), "zones must be an array of balls")):
            with self.assertRaisesRegex(krs.ArgumentError, words):
                call()
        camera.eye = (0, 0, 7)
        self.assertEqual(camera.eye.tolist(), [0, 0, 7])
        set_zones([[0, 0, 9, 1]])
        self.assertEqual(scene.zones.shape, (1, 4))
        set_zones([])
        self.assertEqual(scene.zones.shape, (0, 4))


class Values(unittest.TestCase):
    text = """
/// How wide it is.
param r = 1 in [0.5, 2];
param tint = #ff0000;
param lit = 1 in 0..2;
show sphere(r).move([0, time, 0]).paint(tint);
"""

    def test_parameters(self):
        """parameters are attributes, with their ranges and comments"""
        scene = krs.compile(self.text)
        self.assertEqual(list(scene.parameters), ["r", "tint", "lit"])
        r, tint, lit = scene.parameters.values()
        self.assertEqual((r.default, r.low, r.high, r.doc, r.line, r.column), (1, 0.5, 2, "How wide it is.", 3, 7))
        self.assertTrue(tint.color and lit.whole and not r.color)
        scene.r = 2
        self.assertEqual((scene.r, scene["r"], scene.distance([0, 0, 3])), (2, 2, 1))
        scene.tint = [0, 1, 0]
        self.assertEqual(scene.probe([[0, 0, 3]]).color.tolist(), [[0, 1, 0]])
        scene.time = 3
        self.assertEqual((scene.time, scene.distance([0, 3, 0])), (3, -2))
        self.assertIn("tint", dir(scene))
        with self.assertRaises(ValueError):
            scene.tint[0] = 1  # it would change nothing

    def test_refused(self):
        """what no parameter can be changes nothing"""
        scene = krs.compile(self.text)
        for name, value in (("r", 3), ("r", [1, 2]), ("r", np.nan), ("tint", 1)):
            with self.assertRaises(krs.ArgumentError):
                setattr(scene, name, value)
        with self.assertRaisesRegex(AttributeError, "there is `tint`"):
            scene.tin = 3
        with self.assertRaises(AttributeError):
            scene.radius
        self.assertEqual((scene.r, scene.distance([0, 0, 3])), (1, 2))

    def test_unbounded(self):
        """a time at which no slope is known says where"""
        scene = krs.compile("show field(y - 0.1 * sin(x / (time - 2))).within(box([2, 2, 2]));")
        with self.assertRaisesRegex(krs.ArgumentError, r"no slope bounds scene.krs:1:\d+"):
            scene.time = 2

    def test_values(self):
        """the same scene at other values does not follow it"""
        scene = krs.compile(self.text)
        scene.zones = [[0, 0, 1, 0.5]]
        other = scene.values(r=2, time=1)
        self.assertEqual((other.r, other.time, scene.r, scene.time), (2, 1, 1, 0))
        scene.r = 0.5
        self.assertEqual(other.distance([0, 1, 4]), 2)
        self.assertEqual(other.zones.tolist(), scene.zones.tolist())

    def test_pickled(self):
        """other processes get the same scene at the same values"""
        scene = krs.compile(self.text, name="part.krs", figures=True)
        scene.r, scene.time, scene.zones = 2, 1, [[0, 0, 1, 0.5]]
        other = pickle.loads(pickle.dumps(scene))
        self.assertEqual((other.r, other.time, other.name), (2, 1, "part.krs"))
        points = RANDOM.normal(size=(50, 3))
        np.testing.assert_array_equal(other.distance(points), scene.distance(points))

    def test_zones(self):
        """zones are empty"""
        scene = krs.compile(self.text)
        self.assertLess(scene.distance([0, 0, 0.9]), 0)
        scene.zones = [[0, 0, 1, 0.5]]
        self.assertGreater(scene.distance([0, 0, 0.9]), 0.3)
        with self.assertRaises(krs.ArgumentError):
            scene.zones = np.ones((17, 4))

    def test_what_there_is(self):
        """a scene tells its components and its box"""
        scene = krs.compile("let ball = sphere(1); show ball; show box([1, 1, 4]).move([3, 0, 0]); show plane();")
        self.assertEqual([c.name for c in scene.components], ["ball", "component 2", "component 3"])
        np.testing.assert_allclose(scene.box, [[-1, -1, -2], [3.5, 1, 2]])
        self.assertTrue(scene.components[0].exact)
        self.assertIn("float krs_distance(vec3 p)", scene.glsl())
        self.assertNotEqual(scene.glsl("essl"), scene.glsl())


class Mistakes(unittest.TestCase):
    def test_place(self):
        """a mistake has its place, and all of them are told"""
        with self.assertRaises(krs.SceneError) as said:
            krs.compile("show sphere(1);\nshow sphre(1);\n  show box(radius: 2);", name="part.krs")
        error = said.exception
        self.assertEqual((error.source, error.line, error.column, error.code), ("part.krs", 2, 6, "E0201"))
        self.assertIn("`sphere`", str(error))
        with self.assertRaises(krs.SceneError) as said:
            krs.compile("  show box(radius: 2);")
        self.assertEqual((said.exception.line, said.exception.column), (1, 12))
        with self.assertRaises(krs.SceneError):
            krs.format("show (;")
        with self.assertRaises(FileNotFoundError):
            krs.compile("nothing.krs")

    def test_warnings(self):
        """what is warned of is a warning of Python; notes are kept"""
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            scene = krs.compile("let x = 3; print(x); show sphere(x);")
        self.assertEqual([w.category for w in heard], [krs.SceneWarning])
        self.assertIn("scene.krs:1:5: warning[W0201]", str(heard[0].message))
        self.assertEqual([d.kind for d in scene.diagnostics if d.message == "3"], ["note"])

    def test_load(self):
        """files come from a function, whose exceptions arrive"""
        files = {"parts/ball.krs": "def ball() = sphere(2);"}
        scene = krs.compile('use "ball.krs"; show ball();', name="parts/scene.krs", load=files.get)
        self.assertEqual(scene.distance([0, 0, 5]), 3)
        with self.assertRaises(krs.SceneError):
            krs.compile('use "none.krs"; show ball();', load=files.get)
        with self.assertRaises(ZeroDivisionError):
            krs.compile('use "ball.krs"; show ball();', load=lambda path: 1 / 0)

    def test_memory_limit(self):
        """a limit of memory is kept"""
        with self.assertRaises(MemoryError):
            krs.compile("let a = [[i, i] for i in 0..900000]; show sphere(1);", memory_limit=1 << 20)
