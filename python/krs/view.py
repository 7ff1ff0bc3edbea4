"""Scenes in a page: the web component with a slider for each parameter, served by this process to this machine alone."""
from __future__ import annotations

import base64
import json
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from krs.errors import Error
from krs.scene import Scene

if TYPE_CHECKING:
    from krs.server import Server

_HERE = Path(__file__).parent
WEB = _HERE / "web"  # the package for pages


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
        import webbrowser
        webbrowser.open(self.url)

    def _repr_html_(self) -> str:
        width, height = self.size
        return f'<iframe src="{self.url}" width="{width}" height="{height}" style="border: 0"></iframe>'

    def __repr__(self) -> str:
        return f"<krs.View of {self.scene.name} at {self.url}>"


_running: Server | None = None
_starting = threading.Lock()


def _server() -> Server:
    """The server of this process, from the first page on."""
    global _running
    from krs.server import Server
    with _starting:
        if _running is None:
            _running = Server()
        return _running


def view(scene: Scene | Any, size: tuple[int, int] = (640, 420), *, studio: bool = True, playing: bool = True) -> View:
    """Shows a scene in a notebook, turned by the mouse, with a slider for each parameter.

    The browser must be on this machine.  `scene` may also be what `krs.show` builds.
    """
    if not (WEB / "index.mjs").is_file():
        raise Error("this package was made without the one for pages: `make web python` makes both")
    return View(scene if isinstance(scene, Scene) else scene.compile(), size, studio, playing)
