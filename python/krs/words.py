"""The words of the language as functions and values: shapes, functions of numbers, maps, colours, ...

They are those of the library that is loaded, with its parameters, defaults and comments.  `use` has those of other files.
"""
from __future__ import annotations

import inspect
import json
import keyword
from typing import Any

from krs import native
from krs.expressions import Expression, Use, Value, _Atom, _Call, _Member, expression
from krs.native import check, ffi, lib


def _list() -> list[dict[str, Any]]:
    made = ffi.new("char **")
    check(lib.krs_words(ffi.NULL, made), "there is no memory for the words of the language")
    return json.loads(native.take_text(made[0]))


class _Default:
    """A default as the library writes it."""

    def __init__(self, text: str):
        self._text = text

    def __repr__(self) -> str:
        return self._text


def python_name(name: str) -> str:
    """A word of Python has a `_` behind it."""
    return name + "_" if keyword.iskeyword(name) else name


def signature(word: dict[str, Any]) -> inspect.Signature:
    """The parameters of a word.  Behind one that takes many all are named."""
    parameters, kind = [], inspect.Parameter.POSITIONAL_OR_KEYWORD
    for given in word.get("parameters", ()):
        name = python_name(given["name"])
        if given.get("many"):
            parameters.append(inspect.Parameter(name, inspect.Parameter.VAR_POSITIONAL))
            kind = inspect.Parameter.KEYWORD_ONLY
            continue
        default = _Default(given.get("default", "...")) if given.get("optional") else inspect.Parameter.empty
        parameters.append(inspect.Parameter(name, kind, default=default))
    # The language has parameters with a default before others; Python has them not.
    needed = [p for p in parameters if p.default is p.empty and p.kind is not p.VAR_POSITIONAL]
    if needed and any(p.default is not p.empty for p in parameters[: parameters.index(needed[-1])]):
        parameters = [p.replace(default=_Default("")) if p in needed else p for p in parameters]
    return inspect.Signature(parameters)


class Word:
    """A function of the language: its call is an expression."""

    def __init__(self, word: dict[str, Any], *needs: Any):
        self.word, self.needs = word, needs
        self.__name__ = word["name"]
        self.__signature__ = signature(word)
        takes = [f"{p['name']}: {p['takes']}" for p in word["parameters"] if "takes" in p]
        self.__doc__ = "\n\n".join(filter(None, (word.get("about"), ", ".join(takes))))

    def __repr__(self) -> str:
        return f"<krs.{self.__name__}{self.__signature__}>"

    def _check(self, arguments: tuple[Value, ...], named: dict[str, Value]) -> None:
        try:
            self.__signature__.bind(*arguments, **named)
        except TypeError as reason:
            raise TypeError(f"{self.__name__}{self.__signature__}: {reason}") from None

    def __call__(self, *arguments: Value, **named: Value) -> Expression:
        self._check(arguments, named)
        return _Call(self.__name__, arguments, named, *self.needs)

    def of(self, receiver: Expression) -> Any:
        """The same as a method."""
        return _Bound(self, receiver)


class _Bound:
    def __init__(self, method: Word, receiver: Expression):
        self._method, self._receiver = method, receiver
        self.__name__, self.__doc__, self.__signature__ = method.__name__, method.__doc__, method.__signature__

    def __call__(self, *arguments: Value, **named: Value) -> Expression:
        self._method._check(arguments, named)
        return _Member(self._receiver, self.__name__, arguments, named)


class Library:
    """The names of another file: what is taken from here brings its `use` along.

    >>> import krs
    >>> trees = krs.use("std/trees.krs")
    >>> print(krs.show(trees.tree().scale(0.5)), end="")
    use "std/trees.krs";
    show tree().scale(0.5);
    """

    def __init__(self, path: str):
        self._use = Use(path)
        self._words = {w["name"]: w for w in _words if w.get("file") == path}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        word = self._words.get(name)
        if word is None and self._words:
            raise AttributeError(f"{self._use.path} has no `{name}`")
        if word is None or word["kind"] == "value":  # of files that are not the library's nothing is known
            return _Atom(name, 10, self._use)
        return Word(word, self._use)

    def __dir__(self) -> list[str]:
        return list(self._words)


def use(path: str) -> Library:
    """The names of another file: of `std/`, or one whose path is relative to the scene."""
    return Library(path)


_words = _list()
methods = {w["name"]: Word(w) for w in _words if w["kind"] == "method"}
words = {w["name"]: _Atom(w["name"]) if w["kind"] == "value" else Word(w)
         for w in _words if w["kind"] != "method" and "file" not in w}
_named = {python_name(name): word for name, word in words.items()}
__all__ = list(_named)


def __getattr__(name: str) -> Any:
    """Words stay out of the names of this module, which needs Python's own `any` and `len`."""
    try:
        return _named[name]
    except KeyError:
        raise AttributeError(f"the language has no `{name}`") from None
