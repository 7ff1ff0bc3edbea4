"""What the package raises, and what it warns of."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence


@dataclass(frozen=True)
class Diagnostic:
    """What the compiler says of a place in a text."""

    kind: str  # "error", "warning" or "note"
    code: str  # "E0312"
    message: str
    source: str  # the name of the text
    line: int  # from 1, as the column
    column: int
    text: str  # as the command prints it, with the line

    def __str__(self) -> str:
        return f"{self.source}:{self.line}:{self.column}: {self.kind}[{self.code}]: {self.message}"


class Error(Exception):
    """Whatever the library refuses, or fails at."""


class SceneError(Error):
    """The scene has mistakes: `diagnostics` has all of them; `code`, `source`, `line` and `column` are those of the first."""

    def __init__(self, diagnostics: Sequence[Diagnostic]):
        self.diagnostics = list(diagnostics)
        errors = [d for d in self.diagnostics if d.kind == "error"]
        first = errors[0] if errors else Diagnostic("error", "", "the scene is refused", "", 0, 0, "")
        self.code, self.source, self.line, self.column = first.code, first.source, first.line, first.column
        super().__init__("\n" + "\n".join(d.text.rstrip() for d in errors) if errors else first.message)


class ArgumentError(Error, ValueError):
    """A number or a name that cannot be: out of range, not finite, unknown."""


class DeviceError(Error):
    """There is no Vulkan device, or it failed."""


class MemoryLimit(Error, MemoryError):
    """Memory has run out, or the limit of an option is reached."""


class Interrupted(Error):
    """`progress` returned False."""


class InternalError(Error):
    """A bug of the library or of the driver."""


class SceneWarning(UserWarning):
    """What the compiler warns of."""
