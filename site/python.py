#!/usr/bin/env python3
"""python.py FOLDER: prints what a package of Python has for its users, as JSON: names, parameters and docstrings."""
import ast
import json
import pathlib
import sys

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def is_public(node):
    return not node.name.startswith("_")


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id.endswith("property") for d in node.decorator_list)


def function(node):
    arguments = "" if is_property(node) else f"({ast.unparse(node.args)})"
    returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return {"name": node.name, "signature": f"{node.name}{arguments}{returns}", "doc": ast.get_docstring(node)}


def fields(node):
    """Members of a class that are declared with their types."""
    return [ast.unparse(line) for line in node.body
            if isinstance(line, ast.AnnAssign) and not ast.unparse(line.target).startswith("_")]


def klass(node):
    members = [function(part) for part in node.body if isinstance(part, FUNCTIONS) and is_public(part)]
    bases = f"({', '.join(map(ast.unparse, node.bases))})" if node.bases else ""
    return {"name": node.name, "signature": f"class {node.name}{bases}", "doc": ast.get_docstring(node), "fields": fields(node),
            "members": members}


def exported(tree):
    """The names that `from krs import *` has, by the modules that they come from."""
    names = next(set(ast.literal_eval(node.value)) for node in tree.body
                 if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__")
    found = {}
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            found.setdefault(node.module.split(".")[-1], set()).update(names & {alias.name for alias in node.names})
    return found


def bases(tree, names):
    """Classes from which exported ones have members."""
    return {ast.unparse(base) for node in tree.body if isinstance(node, ast.ClassDef) and node.name in names for base in node.bases}


def module(path, names):
    tree = ast.parse(path.read_text())
    names = names | bases(tree, names)
    return {"name": path.stem, "doc": ast.get_docstring(tree),
            "has": [klass(node) if isinstance(node, ast.ClassDef) else function(node) for node in tree.body
                    if isinstance(node, (ast.ClassDef, *FUNCTIONS)) and node.name in names]}


def main(folder):
    folder = pathlib.Path(folder)
    names = exported(ast.parse((folder / "__init__.py").read_text()))
    print(json.dumps([module(folder / f"{name}.py", names[name]) for name in names]))


if __name__ == "__main__":
    main(*sys.argv[1:])
