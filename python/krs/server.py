"""A server of pages, for browsers of this machine alone."""
from __future__ import annotations

import http.server
import json
import mimetypes
import secrets
import threading
import weakref
from typing import Any

from krs.errors import Error
from krs.view import WEB, View

_TYPES = {".mjs": "text/javascript", ".wasm": "application/wasm", ".ttf": "font/ttf"}


class Handler(http.server.BaseHTTPRequestHandler):
    server: Server  # type: ignore[assignment]

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
            file = (WEB / place[1]).resolve()
            if WEB.resolve() in file.parents and file.is_file():
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


class Server(http.server.ThreadingHTTPServer):
    """Pages of this process; their addresses have a word that nobody guesses."""

    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.word = secrets.token_urlsafe(16)
        self.views: weakref.WeakValueDictionary[str, View] = weakref.WeakValueDictionary()
        self._count = 0
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def add(self, view: View) -> str:
        self._count += 1
        self.views[str(self._count)] = view
        return f"http://127.0.0.1:{self.server_address[1]}/{self.word}/{self._count}/"
