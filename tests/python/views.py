"""Scenes in a page."""
import json
import os
import unittest
import urllib.error
import urllib.request

import krs

WEB = os.path.exists(os.path.join(os.path.dirname(krs.__file__), "web/index.mjs"))
TEXT = """use "ball.krs";
camera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }
light { direction: [0, 0, 1], intensity: 3 }
sky { zenith: black, horizon: black, ground: black }
param r = 1 in [0.5, 2];
param shift = [0, 0, 0];
param tint = #ff0000;
show ball(r).move(shift).paint(tint);
"""


def get(url, data=None):
    try:
        with urllib.request.urlopen(url, data, timeout=60) as answer:
            return answer.status, answer.read(), answer.headers["Content-Type"]
    except urllib.error.HTTPError as error:
        return error.code, error.read(), ""


def scene():
    return krs.compile(TEXT, load={"ball.krs": "def ball(r) = sphere(r); // </script>"}.get)


class Views(unittest.TestCase):
    def test_without(self):
        """a package without the one for pages says how both are made"""
        if WEB:
            self.skipTest("it has it")
        with self.assertRaisesRegex(krs.Error, "make web python"):
            krs.view(scene())

    def test_page(self):
        """a page has the scene, its values and the files that it reads, and takes values back"""
        if not WEB:
            self.skipTest("made without `make web`")
        shown = scene()
        shown.r = 1.5
        view = krs.view(shown, (300, 200))
        self.assertIn(f'src="{view.url}"', view._repr_html_())
        status, page, kind = get(view.url)
        self.assertEqual((status, kind), (200, "text/html; charset=utf-8"))
        data = json.loads(page.split(b'id="scene">')[1].split(b"</script>")[0])
        self.assertEqual((data["text"], data["values"]), (TEXT, {"r": [1.5], "shift": [0, 0, 0], "tint": [1, 0, 0]}))
        self.assertEqual(list(data["files"]), ["ball.krs"])
        self.assertEqual(get(view.url + "values", b'{"r": [1.75]}')[0], 200)
        self.assertEqual(shown.r, 1.75)
        for wrong in (b'{"r": [9]}', b"{", b'{"q": [1]}'):
            self.assertEqual(get(view.url + "values", wrong)[0], 400)
        self.assertEqual(shown.r, 1.75)
        root = view.url.rsplit("/", 2)[0]
        status, module, kind = get(root + "/web/index.mjs")
        self.assertEqual((status, kind), (200, "text/javascript"))
        self.assertEqual(get(root + "/web/krs.wasm")[2], "application/wasm")

    def test_strangers(self):
        """nobody else gets in, and nothing else is served"""
        if not WEB:
            self.skipTest("made without `make web`")
        gone = krs.view(scene()).url
        self.assertEqual(get(gone)[0], 404)  # nobody holds it any more
        view = krs.view(scene())
        root = view.url.rsplit("/", 2)[0]
        for path in ("/web/../native.py", "/web/..%2fnative.py", "/web//etc/passwd", "/web/", "/9999/", "/"):
            self.assertEqual(get(root + path)[0], 404, path)
        port = root.rsplit("/", 1)[0]
        for path in ("/", "/guess/web/index.mjs", f"/{'x' * 22}/1/"):
            self.assertEqual(get(port + path)[0], 404, path)
        self.assertTrue(view.url.startswith("http://127.0.0.1:"))
