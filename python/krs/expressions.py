"""Scenes without text: expressions of the language, made by calls and operators, which print as readable `.krs`."""
from __future__ import annotations

import difflib
import math
import os
from typing import TYPE_CHECKING, Any, Iterable, Iterator, Union

import numpy as np

from krs.errors import ArgumentError

if TYPE_CHECKING:
    from krs.scene import Scene
    from krs.words import Methods
else:

    class Methods:
        """Methods of the language are found by their names."""


WIDTH = 100  # of lines
# What binds tighter has a greater number; as in docs/language.md.
_COMPARES, _UNION, _INTERSECTION, _SUM, _PRODUCT, _MINUS, _POWER, _POSTFIX = range(3, 11)
_IF = 1
# Chains of more parts than this are calls: texts have 1000 levels at most.
_LONG_CHAIN = 32
_CHAINS = {"|": "union", "&": "intersection"}

Value = Union["Expression", float, int, bool, str, Iterable[Any], np.ndarray]


# ---- texts of values ----


def _number(value: float) -> str:
    if not math.isfinite(value):
        raise ArgumentError(f"{value} is no number of a scene")
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text.replace("e+", "e")


def _string(value: str) -> str:
    is_color = len(value) == 7 and value[0] == "#" and all(c in "0123456789abcdefABCDEF" for c in value[1:])
    return value if is_color else '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def expression(value: Value) -> Expression:
    """Whatever a scene can have as a value."""
    if isinstance(value, Expression):
        return value
    if isinstance(value, (bool, np.bool_)):
        return _Atom("true" if value else "false")
    if isinstance(value, (int, float, np.number)):
        return _Atom(_number(value), _MINUS if value < 0 else _POSTFIX)
    if isinstance(value, str):
        return _Atom(_string(value))
    if isinstance(value, np.ndarray):
        return expression(value.tolist())
    if isinstance(value, Iterable) and not isinstance(value, (bytes, dict)):
        return _List([expression(item) for item in value])
    raise TypeError(f"{value!r} is no value of a scene")


# ---- expressions ----


class Expression(Methods):
    """A value of the language: a number, a vector, a shape, a map, a material, ...

    Operators are those of the language, with `**` for `^`; methods are those of shapes, with the same parameters.  One that is
    a word of Python has a `_` behind it: `krs.capsule(from_=[0, 0, 0])`.

    >>> import krs
    >>> print(krs.sphere(1) | krs.box([1, 2, 1]).move([2, 0, 0]) - krs.cylinder(radius=0.2))
    sphere(1) | box([1, 2, 1]).move([2, 0, 0]) - cylinder(radius: 0.2)
    """

    _level = _POSTFIX
    _children: tuple[Any, ...] = ()  # expressions and definitions
    _flat: str | None = None

    # -- text --

    def _write(self) -> str:
        """In one line."""
        raise NotImplementedError

    def _break(self, column: int) -> str:
        """In several lines, of which those behind the first begin with their blanks."""
        return self._text()

    def _text(self) -> str:
        if self._flat is None:
            self._flat = self._write()
        return self._flat

    def _lay(self, column: int) -> str:
        text = self._text()
        return text if column + len(text) <= WIDTH else self._break(column)

    def _within(self, level: int) -> Expression:
        """In parentheses, if what is around binds tighter."""
        return self if self._level >= level else _Parentheses(self)

    def __str__(self) -> str:
        return self._lay(0)

    __repr__ = __str__

    # -- operators --

    def __or__(self, other: Value) -> Expression:
        return _chain("|", _UNION, self, other)

    def __ror__(self, other: Value) -> Expression:
        return _chain("|", _UNION, other, self)

    def __and__(self, other: Value) -> Expression:
        return _chain("&", _INTERSECTION, self, other)

    def __rand__(self, other: Value) -> Expression:
        return _chain("&", _INTERSECTION, other, self)

    def __add__(self, other: Value) -> Expression:
        return _chain("+", _SUM, self, other)

    def __radd__(self, other: Value) -> Expression:
        return _chain("+", _SUM, other, self)

    def __sub__(self, other: Value) -> Expression:
        return _chain("-", _SUM, self, other)

    def __rsub__(self, other: Value) -> Expression:
        return _chain("-", _SUM, other, self)

    def __mul__(self, other: Value) -> Expression:
        return _chain("*", _PRODUCT, self, other)

    def __rmul__(self, other: Value) -> Expression:
        return _chain("*", _PRODUCT, other, self)

    def __truediv__(self, other: Value) -> Expression:
        return _chain("/", _PRODUCT, self, other)

    def __rtruediv__(self, other: Value) -> Expression:
        return _chain("/", _PRODUCT, other, self)

    def __mod__(self, other: Value) -> Expression:
        return _chain("%", _PRODUCT, self, other)

    def __rmod__(self, other: Value) -> Expression:
        return _chain("%", _PRODUCT, other, self)

    def __pow__(self, other: Value) -> Expression:
        return _Power(self, other)

    def __rpow__(self, other: Value) -> Expression:
        return _Power(other, self)

    def __neg__(self) -> Expression:
        return _Prefix("-", self)

    def __invert__(self) -> Expression:
        return _Prefix("not ", self, _COMPARES - 1)

    def __lt__(self, other: Value) -> Expression:
        return _Compared("<", self, other)

    def __le__(self, other: Value) -> Expression:
        return _Compared("<=", self, other)

    def __gt__(self, other: Value) -> Expression:
        return _Compared(">", self, other)

    def __ge__(self, other: Value) -> Expression:
        return _Compared(">=", self, other)

    def __eq__(self, other: Any) -> Expression:  # type: ignore[override]
        return _Compared("==", self, other)

    def __ne__(self, other: Any) -> Expression:  # type: ignore[override]
        return _Compared("!=", self, other)

    __hash__ = object.__hash__
    __array_ufunc__ = None  # arrays leave operators to expressions
    __iter__ = None  # it has indices, but nobody knows yet how many

    def __bool__(self) -> bool:
        raise TypeError("nobody knows yet whether this is true; `krs.choose` chooses in the scene")

    def __getitem__(self, index: Value) -> Expression:
        return _Index(self, expression(index))

    def __call__(self, *arguments: Value, **named: Value) -> Expression:
        """A texture at a place, or a material with parameters."""
        return _Call(self, arguments, named)

    # -- members --

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        from krs.words import methods
        if name in methods:
            return methods[name].of(self)
        if 1 <= len(name) <= 4 and any(set(name) <= set(letters) for letters in ("xyzw", "rgba")):
            return _Member(self, name, None, {})
        near = difflib.get_close_matches(name, methods, 1)
        hint = f"; there is `{near[0]}`" if near else ""
        raise AttributeError(f"there is no method `{name}`{hint}")

    def __dir__(self) -> list[str]:
        from krs.words import methods
        return [*super().__dir__(), *methods]

    def inverse(self) -> Expression:
        """Of a map of space."""
        return _Member(self, "inverse", (), {})

    def alpha(self, *place: Value) -> Expression:
        """The alpha of a texture at a place."""
        return _Member(self, "alpha", place, {})

    @property
    def size(self) -> Expression:
        """Pixels of a texture, across and up."""
        return _Member(self, "size", None, {})

    # -- scenes --

    def compile(self, **options: Any) -> Scene:
        """The scene that shows this shape."""
        return show(self).compile(**options)


class _Atom(Expression):
    def __init__(self, text: str, level: int = _POSTFIX, *children: Any):
        self._flat, self._level, self._children = text, level, children


class _Light(_Atom):
    """The name of a light, which is shown by its block."""


class _Parentheses(Expression):
    def __init__(self, inner: Expression):
        self._children = (inner,)

    def _write(self) -> str:
        return f"({self._children[0]._text()})"

    def _break(self, column: int) -> str:
        return f"({self._children[0]._lay(column + 1)})"


def _in_lines(opening: str, parts: Iterable[tuple[str, Expression]], closing: str, column: int) -> str:
    """Parts below each other, behind an opening bracket; each has a name or none."""
    inner = column + len(opening)
    return opening + (",\n" + " " * inner).join(name + part._lay(inner + len(name)) for name, part in parts) + closing


class _List(Expression):
    def __init__(self, items: list[Expression]):
        self._children = tuple(items)

    def _write(self) -> str:
        return "[" + ", ".join(item._text() for item in self._children) + "]"

    def _break(self, column: int) -> str:
        if all(isinstance(item, (_Atom, _List)) and len(item._text()) < WIDTH // 2 for item in self._children):
            return self._fill(column)
        return _in_lines("[", (("", item) for item in self._children), "]", column)

    def _fill(self, column: int) -> str:
        """Numbers, as many in a line as there is room for."""
        lines, line = [], ""
        for item in self._children:
            piece = item._text() + ", "
            if line and column + 1 + len(line) + len(piece) > WIDTH:
                lines.append(line.rstrip())
                line = ""
            line += piece
        return "[" + ("\n" + " " * (column + 1)).join([*lines, line[:-2]]) + "]"


def _python_name(name: str) -> str:
    """A parameter's name without the `_` that words of Python have behind it."""
    return name[:-1] if name.endswith("_") else name


class _Arguments(Expression):
    """What has arguments in parentheses, behind a head."""

    _arguments: tuple[tuple[str, Expression], ...] | None

    def _give(self, arguments: Iterable[Value] | None, named: dict[str, Value]) -> None:
        self._arguments = None if arguments is None else (
            *(("", expression(value)) for value in arguments),
            *((_python_name(name) + ": ", expression(value)) for name, value in named.items()))

    def _values(self) -> list[Expression]:
        return [value for _, value in self._arguments or ()]

    def _in_a_line(self) -> str:
        return "" if self._arguments is None else "(" + ", ".join(n + v._text() for n, v in self._arguments) + ")"


class _Call(_Arguments):
    def __init__(self, called: Expression | str, arguments: Iterable[Value], named: dict[str, Value], *needs: Any):
        self._called = _Atom(called) if isinstance(called, str) else called._within(_POSTFIX)
        self._give(arguments, named)
        self._children = (*needs, self._called, *self._values())

    def _head(self) -> str:
        return self._called._text()

    def _write(self) -> str:
        return self._head() + self._in_a_line()

    def _break(self, column: int) -> str:
        return _in_lines(self._head() + "(", self._arguments or (), ")", column)


class _Member(_Arguments):
    def __init__(self, of: Expression, name: str, arguments: Iterable[Value] | None, named: dict[str, Value]):
        self._of, self._name = of._within(_POSTFIX), name
        self._give(arguments, named)
        self._children = (self._of, *self._values())

    def _write(self) -> str:
        return f"{self._of._text()}.{self._name}{self._in_a_line()}"

    def _break(self, column: int) -> str:
        text = self._of._lay(column)
        last = text.rsplit("\n", 1)[-1]
        at = len(last) if "\n" in text else column + len(text)
        flat = f".{self._name}{self._in_a_line()}"
        if at + len(flat) <= WIDTH:
            return text + flat
        if column + 4 + len(flat) <= WIDTH or self._arguments is None:
            return f"{text}\n{' ' * (column + 4)}{flat}"
        return text + "\n" + " " * (column + 4) + _in_lines(f".{self._name}(", self._arguments, ")", column + 4)


class _Index(Expression):
    def __init__(self, of: Expression, index: Expression):
        self._children = (of._within(_POSTFIX), index)

    def _write(self) -> str:
        return f"{self._children[0]._text()}[{self._children[1]._text()}]"


class _Chain(Expression):
    """Operands with operators of one level between them, from left to right."""

    def __init__(self, level: int, first: Expression, rest: tuple[tuple[str, Expression], ...]):
        self._level, self._first, self._rest = level, first, rest
        self._children = (first, *(operand for _, operand in rest))

    def _write(self) -> str:
        return self._first._text() + "".join(f" {operator} {operand._text()}" for operator, operand in self._rest)

    def _break(self, column: int) -> str:
        return self._first._lay(column + 2) + "".join(
            f"\n{' ' * column}{operator} {operand._lay(column + 2)}" for operator, operand in self._rest)


def _chain(operator: str, level: int, left: Value, right: Value) -> Expression:
    try:
        first, second = expression(left), expression(right)
    except TypeError:
        return NotImplemented
    # A long union is a list: appending to it takes no longer for the next part.
    if isinstance(first, _Union) and first._word == _CHAINS.get(operator):
        return first._joined(second)
    if isinstance(first, _Chain) and first._level == level:
        chain = _Chain(level, first._first, (*first._rest, (operator, second._within(level + 1))))
    else:
        chain = _Chain(level, first._within(level), ((operator, second._within(level + 1)),))
    if operator in _CHAINS and len(chain._rest) >= _LONG_CHAIN:
        return _Union(_CHAINS[operator], list(chain._children))
    return chain


class _Union(Expression):
    """`union([...])` of a long chain.  Chains that go on share the list of their parts."""

    def __init__(self, word: str, parts: list[Expression]):
        self._word, self._parts, self._count = word, parts, len(parts)

    def _joined(self, part: Expression) -> _Union:
        if self._count < len(self._parts):  # another chain went on from here
            self._parts = self._parts[: self._count]
        self._parts.append(part)
        return _Union(self._word, self._parts)

    @property
    def _children(self) -> tuple[Expression, ...]:  # type: ignore[override]
        return tuple(self._parts[: self._count])

    def _write(self) -> str:
        return f"{self._word}([" + ", ".join(part._text() for part in self._children) + "])"

    def _break(self, column: int) -> str:
        return _in_lines(f"{self._word}([", (("", part) for part in self._children), "])", column)


class _Power(Expression):
    _level = _POWER

    def __init__(self, base: Value, exponent: Value):
        self._children = (expression(base)._within(_POSTFIX), expression(exponent)._within(_MINUS))

    def _write(self) -> str:
        return f"{self._children[0]._text()} ^ {self._children[1]._text()}"


class _Prefix(Expression):
    def __init__(self, operator: str, operand: Expression, level: int = _MINUS):
        self._operator, self._level, self._children = operator, level, (operand._within(level),)

    def _write(self) -> str:
        return self._operator + self._children[0]._text()


class _Compared(Expression):
    _level = _COMPARES

    def __init__(self, operator: str, left: Value, right: Value):
        self._operator = operator
        self._children = (expression(left)._within(_UNION), expression(right)._within(_UNION))

    def _write(self) -> str:
        return f"{self._children[0]._text()} {self._operator} {self._children[1]._text()}"

    def _break(self, column: int) -> str:
        left, right = self._children
        return f"{left._lay(column)}\n{' ' * column}{self._operator} {right._lay(column + len(self._operator) + 1)}"


class _Choice(Expression):
    _level = _IF

    def __init__(self, condition: Value, yes: Value, no: Value):
        self._children = (expression(condition), expression(yes), expression(no))

    def _write(self) -> str:
        condition, yes, no = (child._text() for child in self._children)
        return f"if {condition} then {yes} else {no}"

    def _break(self, column: int) -> str:
        condition, yes, no = self._children
        return (f"if {condition._lay(column + 3)}\n{' ' * column}then {yes._lay(column + 5)}"
                f"\n{' ' * column}else {no._lay(column + 5)}")


def choose(condition: Value, yes: Value, no: Value) -> Expression:
    """`if condition then yes else no`."""
    return _Choice(condition, yes, no)


def deg(angle: float) -> Expression:
    """An angle in degrees, as the text has it: `30deg`."""
    return _Atom(_number(angle) + "deg", _MINUS if angle < 0 else _POSTFIX)


class Sequence(Expression):
    """A `krs` block: kernels, and mirrors and maps that what is there so far goes through.

    >>> import krs
    >>> twig = krs.capsule([0, 0, 0], [0, 0.4, 0], radius=0.03)
    >>> bush = krs.kernel(twig)
    >>> for _ in range(2):
    ...     bush = bush.mobius(krs.translate([0, 0.4, 0]) * krs.scale(0.9)).reflect(krs.plane([1, 0, 0], 0)).kernel(twig)
    >>> print(krs.show(bush), end="")
    show krs {
        kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.03);
        mobius translate([0, 0.4, 0]) * scale(0.9);
        reflect plane([1, 0, 0], 0);
        kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.03);
        mobius translate([0, 0.4, 0]) * scale(0.9);
        reflect plane([1, 0, 0], 0);
        kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.03);
    };
    """

    def __init__(self, stages: tuple[tuple[str, Expression], ...]):
        self._stages = stages
        self._children = tuple(value for _, value in stages)

    def _stage(self, word: str, value: Value) -> Sequence:
        return Sequence((*self._stages, (word, expression(value))))

    def kernel(self, shape: Value) -> Sequence:
        """Adds a shape."""
        return self._stage("kernel", shape)

    def reflect(self, mirror: Value) -> Sequence:
        """Keeps what is on one side of a plane, or outside of a sphere, and adds its image."""
        return self._stage("reflect", mirror)

    def mobius(self, map: Value) -> Sequence:
        """Replaces all that is there by its image under a map."""
        return self._stage("mobius", map)

    def _write(self) -> str:
        return "krs {\n" + "".join(f"{word} {value._lay(len(word) + 9)};\n" for word, value in self._stages) + "}"


def kernel(shape: Value) -> Sequence:
    """A sequence that begins with a shape."""
    return Sequence((("kernel", expression(shape)),))


# ---- definitions ----


class Definition:
    """A statement that gives a name a meaning."""

    def __init__(self, name: str, statement: str, children: Iterable[Any] = (), lay: Any = None):
        if name and not (name.isascii() and name.isidentifier()):
            raise ArgumentError(f"{name!r} is no name of the language")
        self.name, self._statement, self._children, self._lay = name, statement, tuple(children), lay

    def text(self) -> str:
        return self._lay() if self._lay else self._statement


def _block(word: str, name: str | None, properties: dict[str, Value]) -> tuple[str, list[Expression]]:
    """`word name { property: value }`."""
    values = {_python_name(key): expression(value) for key, value in properties.items()}
    head = f"{word} {name}" if name else word
    flat = f"{head} {{ " + ", ".join(f"{key}: {value._text()}" for key, value in values.items()) + " }"
    if len(flat) > WIDTH:
        flat = f"{head} {{\n" + ",\n".join(f"{key}: {value._lay(len(key) + 6)}" for key, value in values.items()) + "\n}"
    return flat, list(values.values())


def let(name: str, value: Value) -> Expression:
    """A name for a value; the scene defines it once, wherever it is used.

    >>> import krs
    >>> wheel = krs.let("wheel", krs.torus(0.3, 0.1))
    >>> print(krs.show(wheel.move([-1, 0, 0]) | wheel.move([1, 0, 0])), end="")
    let wheel = torus(0.3, 0.1);
    show wheel.move([-1, 0, 0]) | wheel.move([1, 0, 0]);
    """
    given = expression(value)
    head = f"let {name} = "
    return _Atom(name, _POSTFIX, Definition(name, "", [given], lambda: f"{head}{given._lay(len(head))};"))


def param(name: str, default: Value, low: Value | None = None, high: Value | None = None, *, whole: bool = False,
          doc: str | None = None) -> Expression:
    """A parameter of the scene, with its range; `whole`: the numbers 0 and 1."""
    given = expression(default)
    limits = []
    if whole:
        text = " in 0..2"
    elif low is not None or high is not None:
        if low is None or high is None:
            raise ArgumentError("a range has two ends")
        limits = [expression(low), expression(high)]
        text = f" in [{limits[0]._text()}, {limits[1]._text()}]"
    else:
        text = ""
    comment = "".join(f"/// {line}\n" for line in (doc or "").splitlines())
    statement = f"{comment}param {name} = {given._text()}{text};"
    return _Atom(name, _POSTFIX, Definition(name, statement, [given, *limits]))


def material(name: str, **properties: Value) -> Expression:
    """A material, for `.paint`: color="#c8553d", roughness=0.3, ..."""
    statement, children = _block("material", name, properties)
    return _Atom(name, _POSTFIX, Definition(name, statement, children))


def light(name: str, **properties: Value) -> Expression:
    """A light: direction or position, color, intensity, ..."""
    statement, children = _block("light", name, properties)
    return _Light(name, _POSTFIX, Definition(name, statement, children))


def _surroundings(word: str) -> Any:
    def make(name: str | None = None, **properties: Value) -> Definition:
        statement, children = _block(word, name, properties)
        return Definition(name or "", statement, children)
    make.__name__ = make.__qualname__ = word
    make.__doc__ = f"A `{word}` block, for `show`."
    return make


camera = _surroundings("camera")
sky, fog, medium, image, zone = (_surroundings(word) for word in ("sky", "fog", "medium", "image", "zone"))


class Use(Definition):
    """A `use` of a file."""

    def __init__(self, path: str):
        super().__init__("", f'use "{path}";')
        self.path = path


# ---- scenes ----


def _walk(roots: Iterable[Any]) -> Iterator[Definition]:
    """Definitions that are needed, each once, and behind those that it needs."""
    seen: set[int] = set()
    stack: list[tuple[Any, bool]] = [(root, False) for root in reversed(list(roots))]
    while stack:
        node, done = stack.pop()
        if done:
            yield node
            continue
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, Definition):
            stack.append((node, True))
        stack.extend((child, False) for child in reversed(node._children))


class Sketch:
    """A scene that is built of expressions: `str` is its text, `compile` compiles it."""

    def __init__(self, shown: list[Expression], blocks: list[Any]):
        self._shown, self._blocks = shown, blocks

    def _statements(self) -> Iterator[str]:
        uses: dict[str, str] = {}
        definitions: dict[str, str] = {}
        blocks: list[str] = []
        for definition in _walk([*self._blocks, *self._shown]):
            text = definition.text()
            if isinstance(definition, Use):
                uses[definition.path] = text
            elif definition.name and definitions.setdefault(definition.name, text) != text:
                raise ArgumentError(f"`{definition.name}` has two meanings: {definitions[definition.name]} {text}")
            elif not definition.name:
                blocks.append(text)
        yield from uses.values()
        yield from blocks
        yield from definitions.values()
        for value in self._shown:
            yield f"show {value._lay(5)};"

    def __str__(self) -> str:
        from krs.scene import format
        return format("\n".join(self._statements()) + "\n")

    def __repr__(self) -> str:
        return str(self)

    def compile(self, **options: Any) -> Scene:
        from krs.scene import compile
        return compile(self, **options)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the text."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(str(self))

    def _repr_png_(self) -> bytes:
        return self.compile()._repr_png_()


def show(*things: Value | Definition, **named: Value) -> Sketch:
    """A scene of shapes, each a component, with cameras, lights and other blocks.  Components may have names.

    >>> import krs
    >>> r = krs.param("r", 1, 0.5, 2)
    >>> clay = krs.material("clay", color="#c8553d", roughness=0.6)
    >>> sketch = krs.show(krs.camera(eye=[3, 2, 5]), krs.plane(), ball=krs.sphere(r).paint(clay))
    >>> print(sketch, end="")
    camera { eye: [3, 2, 5] }
    param r = 1 in [0.5, 2];
    material clay { color: #c8553d, roughness: 0.6 }
    let ball = sphere(r).paint(clay);
    show plane();
    show ball;
    >>> sketch.compile().r
    1.0
    """
    blocks = [thing for thing in things if isinstance(thing, (Definition, _Light))]
    shown = [expression(thing) for thing in things if not isinstance(thing, (Definition, _Light))]
    return Sketch([*shown, *(let(name, value) for name, value in named.items())], blocks)
