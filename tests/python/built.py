"""Scenes that are built of expressions."""
import builtins
import functools
import operator
import os
import pkgutil
import unittest

import numpy as np

import krs
from krs import expressions, words

POINTS = np.random.default_rng(3).uniform(-3, 3, (500, 3))


def expand(chosen):
    return " ".join(str(chosen).split())


class Built(unittest.TestCase):
    def same(self, built, text):
        """They compile to the same distances."""
        np.testing.assert_array_equal(built.compile().distance(POINTS), krs.compile(text).distance(POINTS))

    def test_text(self):
        """expressions print as one would write them, with as few parentheses as needed"""
        a, b, c = krs.sphere(1), krs.box([1, 2, 3]), krs.torus(major=1, minor=0.25)
        for built, text in (
                (a | b - c, "sphere(1) | box([1, 2, 3]) - torus(major: 1, minor: 0.25)"),
                ((a | b) - c, "(sphere(1) | box([1, 2, 3])) - torus(major: 1, minor: 0.25)"),
                (a - (b - c), "sphere(1) - (box([1, 2, 3]) - torus(major: 1, minor: 0.25))"),
                (a & b | c, "sphere(1) & box([1, 2, 3]) | torus(major: 1, minor: 0.25)"),
                ((a | b).move([1, 0, 0]), "(sphere(1) | box([1, 2, 3])).move([1, 0, 0])"),
                (a.round(0.1).paint("#c8553d"), "sphere(1).round(0.1).paint(#c8553d)"),
                (-krs.x ** 2, "-x ^ 2"), ((-krs.x) ** 2, "(-x) ^ 2"), (2 ** krs.x ** -1, "2 ^ x ^ -1"),
                (krs.x - (krs.y - 1), "x - (y - 1)"), (1 - krs.x * 2 / krs.y, "1 - x * 2 / y"),
                (krs.p.xz, "p.xz"), (krs.p[1], "p[1]"), ((krs.x < 1) == True, "(x < 1) == true"),  # noqa: E712
                (krs.choose(krs.x < 0, 1e-7, -1e22), "if x < 0 then 1e-07 else -1e22"),
                (krs.sin(krs.deg(30) * krs.time), "sin(30deg * time)"), (krs.tomato, "tomato"),
                (krs.capsule([0, 0, 0], to=[0, 1, 0]), "capsule([0, 0, 0], to: [0, 1, 0])"),
                (krs.capsule(from_=[0, 0, 0]), "capsule(from: [0, 0, 0])"),
                (krs.union([a, b], blend=0.2), "union([sphere(1), box([1, 2, 3])], blend: 0.2)"),
                (krs.text('say "x"\n'), r'text("say \"x\"\n")'),
                (krs.translate(np.array([1, 2.5, 3])) * krs.scale(np.float32(0.5)), "translate([1, 2.5, 3]) * scale(0.5)"),
                (krs.rotate([0, 1, 0], 1).inverse(), "rotate([0, 1, 0], 1).inverse()")):
            self.assertEqual(str(built), text)

    def test_distances(self):
        """what is built has the distances of the text"""
        r = krs.param("r", 1, 0.5, 2)
        self.same(krs.sphere(r).round(0.1) | krs.box([1, 2, 1]).move([2, 0, 0]).rotate([0, 1, 0], krs.deg(30)),
                  "param r = 1 in [0.5, 2]; show sphere(r).round(0.1) | box([1, 2, 1]).move([2, 0, 0]).rotate([0, 1, 0], 30deg);")
        self.same(krs.algebraic(krs.x ** 2 + 2 * krs.y ** 4 + krs.z ** 2 == 1), "show algebraic(x^2 + 2 * y^4 + z^2 == 1);")
        self.same(krs.show(krs.use("std/terrain.krs").terrain(seed=3)), 'use "std/terrain.krs"; show terrain(seed: 3);')

    def test_definitions(self):
        """definitions come once, before those that need them"""
        a = krs.let("a", krs.sphere(krs.param("r", 1, 0.5, 2, doc="Half its width.")))
        b = krs.let("b", a.move([1, 0, 0]) | a)
        self.assertEqual(str(krs.show(b, b.move([0, 3, 0]))),
                         "/// Half its width.\nparam r = 1 in [0.5, 2];\nlet a = sphere(r);\nlet b = a.move([1, 0, 0]) | a;\n"
                         "show b;\nshow b.move([0, 3, 0]);\n")
        with self.assertRaisesRegex(krs.ArgumentError, "two meanings"):
            str(krs.show(a | krs.let("a", krs.sphere(2))))
        with self.assertRaises(krs.ArgumentError):
            krs.let("two words", krs.sphere())
        sun = krs.light("sun", direction=[1, 2, 1])
        text = str(krs.show(krs.sphere(1), sun, krs.sky(sun=sun, turbidity=3), krs.camera(eye=[0, 0, 5]), krs.camera("far", eye=[0, 0, 9])))
        scene = krs.compile(text)
        self.assertEqual(text.count("light sun"), 1)
        np.testing.assert_array_equal(scene.camera("far").eye, [0, 0, 9])

    def test_lines(self):
        """long texts have lines that are not too long, in the canonical layout"""
        parts = [krs.sphere(0.1 * i).move([i, 0, 0]).paint("#c8553d") for i in range(1, 9)]
        shapes = (krs.union(parts, blend=0.25), functools.reduce(operator.or_, parts),
                  krs.hull([[float(i), i * i / 7, 0] for i in range(60)], radius=0.1),
                  krs.box([1, 1, 1]).move([1.25, 2.25, 3.25]).rotate([0, 1, 0], krs.deg(30)).scale(1.25).round(0.0625).shell(0.125).paint("#c8553d"),
                  functools.reduce(lambda sequence, part: sequence.kernel(part), parts, krs.kernel(parts[0])),
                  krs.field(sum((krs.sin(krs.p.x * i + 0.5) for i in range(1, 20)), krs.y)).within(krs.box([2, 2, 2])))
        for shape in shapes:
            text = str(krs.show(shape))
            self.assertLessEqual(max(map(len, text.splitlines())), 110, text)
            self.assertGreater(text.count("\n"), 1)
            self.assertEqual(krs.format(text), text)
            krs.compile(text)

    def test_long_chains(self):
        """chains of thousands of parts are unions, in time that grows as they do"""
        parts = [krs.sphere(0.01).move([0.1 * i, 0, 0]) for i in range(4000)]
        built = functools.reduce(operator.or_, parts)
        before = built | krs.box([1, 1, 1])
        other = built | krs.box([2, 2, 2])
        self.assertIn("box([1, 1, 1])", str(before))
        self.assertNotIn("box([1, 1, 1])", str(other))
        self.assertEqual(len(built.compile().components), 1)
        self.assertAlmostEqual(built.compile().distance([399.9, 1, 0]), 0.99)

    def test_refused(self):
        """what cannot be is said at once, or by the compiler with its place"""
        with self.assertRaisesRegex(TypeError, "sphere.*radius"):
            krs.sphere(radus=1)
        with self.assertRaisesRegex(TypeError, "move"):
            krs.sphere(1).move()
        with self.assertRaisesRegex(AttributeError, "there is `move`"):
            krs.sphere(1).mov([1, 0, 0])
        with self.assertRaises(AttributeError):
            krs.sphre(1)
        for wrong in (None, {"a": 1}, b"x", object()):
            with self.assertRaises(TypeError):
                krs.sphere(wrong)
            with self.assertRaises(TypeError):
                krs.sphere(1) | wrong
        with self.assertRaises(krs.ArgumentError):
            krs.sphere(float("inf"))
        with self.assertRaises(TypeError):
            if krs.x < 1:
                pass
        with self.assertRaises(krs.SceneError) as said:
            krs.show(krs.sphere(krs.sphere(1))).compile()
        self.assertEqual((said.exception.line, said.exception.column), (1, 13))

    def test_every_shape(self):
        """each shape of the library compiles with its defaults"""
        shapes = [w["name"] for w in words._words if w["kind"] == "shape" and "file" not in w]
        self.assertGreater(len(shapes), 25)
        for name in shapes:
            shape = getattr(krs, name)()
            try:
                shape.compile(figures=True)
            except krs.SceneError as error:
                # One whose default asks for something else says so.
                self.assertIn(error.code, ("E0301", "E0303", "E0309"), f"{name}: {error}")


class Words(unittest.TestCase):
    def test_docs(self):
        """words have the library's parameters, defaults and comments"""
        import inspect
        self.assertEqual(str(inspect.signature(krs.box)), "(size=[1, 1, 1])")
        self.assertEqual(str(inspect.signature(krs.capsule)), "(from_=[0, -0.5, 0], to=[0, 0.5, 0], radius=0.25)")
        self.assertEqual(str(inspect.signature(krs.union)), "(*shapes, blend=..., kind=..., steps=...)")
        self.assertIn("full edge lengths", krs.box.__doc__)
        self.assertIn("move", dir(krs.sphere(1)))
        self.assertIn("barth_sextic", dir(krs.use("std/surfaces.krs")))

    def test_names(self):
        """no word of the language is hidden by the package, nor by Python"""
        modules = {module.name for module in pkgutil.iter_modules(krs.__path__)}
        hidden = (set(krs.__all__) | modules | {"compile", "format", "view"}) & set(words.words)
        self.assertEqual(hidden, set())
        for name in words.__all__:
            self.assertIs(getattr(krs, name), getattr(words, name))
        self.assertEqual({m for m in words.methods if m in vars(expressions.Expression)}, set())
        self.assertFalse(set(krs.__all__) & set(dir(builtins)))

    def test_stub(self):
        """words.pyi has all of them"""
        with open(os.path.join(os.path.dirname(krs.__file__), "words.pyi")) as stub:
            text = stub.read()
        for name in words.__all__:
            self.assertTrue(f"\ndef {name}(" in text or f"\n{name}: Expression" in text, name)
        for name in words.methods:
            self.assertIn(f"\n    def {name}(self", text)
        compile_builtin = builtins.compile
        compile_builtin(text, "words.pyi", "exec")
