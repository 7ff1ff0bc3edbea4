"""A page of krs.view in a browser."""
import json
import os
import subprocess
import unittest

import krs
from views import scene


class Browser(unittest.TestCase):
    def test_browser(self):
        """a browser shows the scene, and its sliders set parameters here, too"""
        shown = scene()
        picture = [os.environ["PICTURE"]] if "PICTURE" in os.environ else []
        view = krs.view(shown)
        run = subprocess.run(["node", os.path.join(os.path.dirname(__file__), "view.mjs"), view.url, *picture], capture_output=True, text=True, timeout=110)
        self.assertEqual(run.returncode, 0, run.stderr)
        told = json.loads(run.stdout)
        self.assertEqual((told["errors"], told["inputs"]), ([], ["range", "number", "number", "number", "color"]))
        self.assertEqual(told["before"]["values"], {"r": [1], "shift": [0, 0, 0], "tint": [1, 0, 0]})
        self.assertEqual((told["after"]["values"]["r"], shown.r), ([1.75], 1.75))
        before, after = told["before"]["pixels"], told["after"]["pixels"]
        self.assertGreater(before[0], 3 * max(before[1], before[2], 20))  # red in the middle
        self.assertLess(max(before[4:7]), 20)  # black above it
        self.assertGreater(after[4], 100)  # where the larger ball is
        self.assertEqual(told["after"]["values"]["tint"], shown.tint.tolist())
        self.assertAlmostEqual(shown.tint[1], 0.2158605, places=6)  # #ff8000, linear
