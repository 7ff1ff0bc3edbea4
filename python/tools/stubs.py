#!/usr/bin/env python3
"""stubs.py FILE: writes the words of the language with their parameters, for editors and type checkers (words.pyi)."""
import inspect
import sys

from krs import words

HEAD = '''"""Made by stubs.py of what the library lists."""
import builtins
import inspect
from typing import Any
from krs.expressions import Expression, Value

class Library:
    def __init__(self, path: builtins.str) -> None: ...
    def __getattr__(self, name: builtins.str) -> Any: ...

class Word:
    word: dict[builtins.str, Any]
    __signature__: inspect.Signature
    def __call__(self, *arguments: Value, **named: Value) -> Expression: ...
    def of(self, receiver: Expression) -> Any: ...

def use(path: builtins.str) -> Library: ...
words: dict[builtins.str, Any]
methods: dict[builtins.str, Word]
'''
STARS = {inspect.Parameter.VAR_POSITIONAL: "*"}


def parameters(word, first=()):
    given = word.__signature__.parameters.values()
    return ", ".join([*first, *(STARS.get(p.kind, "") + f"{p.name}: Value" + ("" if p.default is p.empty else " = ...")
                                for p in given)])


def function(name, word, indent="", first=()):
    doc = (word.__doc__ or "").replace("\\", "\\\\").replace("\n", "\n    " + indent)
    return f'{indent}def {name}({parameters(word, first)}) -> Expression:\n{indent}    """{doc}"""\n'


def main(path):
    with open(path, "w") as stub:
        stub.write(HEAD + "\nclass Methods:\n")
        for name, word in words.methods.items():
            stub.write(function(words.python_name(name), word, "    ", ["self"]))
        stub.write("    def __getattr__(self, name: builtins.str) -> Expression: ...\n\n")
        for name in words.__all__:
            word = getattr(words, name)
            stub.write(function(name, word) if isinstance(word, words.Word) else f"{name}: Expression\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
