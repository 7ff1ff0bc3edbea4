"""Scenes in a page: the web component with a slider for each parameter, served by this process to this machine alone."""
from __future__ import annotations

import base64
import http.server
import json
import mimetypes
import os
import secrets
import threading
import webbrowser
import weakref
from pathlib import Path
from typing import Any

import numpy as np

from krs.errors import Error
from krs.scene import Scene

_HERE = Path(__file__).parent
_WEB = _HERE / "web"  # the package for pages
_TYPES = {".mjs": "text/javascript", ".wasm": "application/wasm", ".ttf": "font/ttf"}


def _plain(value: Any) -> list[float]:
    return [float(number) for number in np.atleast_1d(value)]


class View:
    """A page that shows a scene: an `<iframe>` in a notebook, or `.open()` in a browser.

    Pulling a slider sets the parameter of the scene, too; what is set here later is shown when the page is loaded again.
    """

    def __init__(self, scene: Scene, size: tuple[int, int], studio: bool, playing: bool):
        self.scene, self.size, self._studio, self._playing = scene, size, studio, playing
        self.url = _server().add(self)

    def page(self) -> str:
        """The HTML of the page."""
        scene = self.scene
        given = {"text": scene.text, "name": scene.name, "studio": self._studio, "time": scene.time, "playing": self._playing,
                 "values": {name: _plain(scene[name]) for name in scene.parameters},
                 "files": {path: base64.b64encode(data).decode() for path, data in scene.files().items()}}
        text = json.dumps(given).replace("</", "<\\/")
        return (_HERE / "view.html").read_text(encoding="utf-8").replace("{{scene}}", text).replace("{{web}}", "../web/")

    def set(self, values: dict[str, Any]) -> None:
        """What sliders were pulled to."""
        for name, value in values.items():
            self.scene[name] = value

    def open(self) -> None:
        """Opens the page in a browser."""
        webbrowser.open(self.url)

    def _repr_html_(self) -> str:
        width, height = self.size
        return f'<iframe src="{self.url}" width="{width}" height="{height}" style="border: 0"></iframe>'

    def __repr__(self) -> str:
        return f"<krs.View of {self.scene.name} at {self.url}>"


class _Handler(http.server.BaseHTTPRequestHandler):
    server: _Server  # type: ignore[assignment]

    def _place(self) -> tuple[str, str] | None:
        """What behind the secret word of this process is asked for; None: somebody else asks."""
        parts = self.path.split("?")[0].split("/", 3)
        return (parts[2], parts[3]) if len(parts) == 4 and secrets.compare_digest(parts[1], self.server.word) else None

    def _answer(self, status: int, data: bytes = b"", kind: str = "text/plain") -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(data)))
        self.send_header("Cache-Control", "no-store" if kind == "text/html; charset=utf-8" else "max-age=3600")
        self.end_headers()
        self.wfile.write(data)

    def do_GET(self) -> None:
        place = self._place()
        view = self.server.views.get(place[0]) if place else None
        if place and place[0] == "web":
            file = (_WEB / place[1]).resolve()
            if _WEB.resolve() in file.parents and file.is_file():
                kind = _TYPES.get(file.suffix) or mimetypes.guess_type(file.name)[0] or "text/plain"
                return self._answer(200, file.read_bytes(), kind)
        elif place and view and not place[1]:
            return self._answer(200, view.page().encode(), "text/html; charset=utf-8")
        self._answer(404)

    def do_POST(self) -> None:
        place = self._place()
        view = self.server.views.get(place[0]) if place else None
        if not place or not view or place[1] != "values":
            return self._answer(404)
        try:
            view.set(json.loads(self.rfile.read(int(self.headers.get("Content-Length", 0)))))
        except (ValueError, TypeError, KeyError, Error) as reason:
            return self._answer(400, str(reason).encode())
        self._answer(200)

    def log_message(self, *_: Any) -> None:
        pass


class _Server(http.server.ThreadingHTTPServer):
    """Pages of this process; their addresses have a word that nobody guesses."""

    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.word = secrets.token_urlsafe(16)
        self.views: weakref.WeakValueDictionary[str, View] = weakref.WeakValueDictionary()
        self._count = 0
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def add(self, view: View) -> str:
        self._count += 1
        self.views[str(self._count)] = view
        return f"http://127.0.0.1:{self.server_address[1]}/{self.word}/{self._count}/"


_running: _Server | None = None
_starting = threading.Lock()


def _server() -> _Server:
    global _running
    with _starting:
        if _running is None:
            _running = _Server()
        return _running


def view(scene: Scene | Any, size: tuple[int, int] = (640, 420), *, studio: bool = True, playing: bool = True) -> View:
    """Shows a scene in a notebook, turned by the mouse, with a slider for each parameter.

    The browser must be on this machine.  `scene` may also be what `krs.show` builds.
    """
    if not (_WEB / "index.mjs").is_file():
        raise Error("this package was made without the one for pages: `make web python` makes both")
    return View(scene if isinstance(scene, Scene) else scene.compile(), size, studio, playing)
