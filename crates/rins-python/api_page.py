"""Writes the page of the book that lists the functions and classes of the Python package, from their docstrings.

``python3 api_page.py`` writes it; with ``--check`` it is compared instead. It reads the sources and imports nothing of them.
"""

from __future__ import annotations

import ast
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "crates/rins-python/python/rins"
PAGE = ROOT / "docs/src/python-api.md"

HEAD = """# All functions and classes in Python

`help(rins.calibrate)` shows these texts. The page is generated from them. [Python](python.md) is the introduction; the fields of results
are documented in `rins.schema`.
"""

MODULES = {
    "rins": ["_commands", "_recording", "_rig", "_live", "_result", "_table", "_errors"],
    "rins.distributed": ["distributed", "_rigs", "_tasks"],
    "rins.plot": ["plot"],
    "rins.readers": ["readers"],
}
"""The modules, and the files of the package in which their names are defined."""

Definition = ast.FunctionDef | ast.ClassDef


def parsed(name: str) -> ast.Module:
    return ast.parse((PACKAGE / f"{name}.py").read_text(encoding="utf-8"))


def public(module: ast.Module) -> list[str]:
    """The names in ``__all__``."""
    for statement in module.body:
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "__all__":
            names: list[str] = ast.literal_eval(statement.value)
            return names
    raise SystemExit("a module has no __all__")


def signature(name: str, function: ast.FunctionDef, is_method: bool) -> str:
    arguments = function.args
    if is_method and arguments.args and arguments.args[0].arg in ("self", "cls"):
        arguments.args.pop(0)
    result = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    line = f"{name}({ast.unparse(arguments)}){result}"
    if len(line) <= 100:
        return line
    parts = "".join(f"\n    {part}," for part in split(ast.unparse(arguments)))
    return f"{name}({parts}\n){result}"


def split(arguments: str) -> list[str]:
    """The arguments of a signature: at commas outside of brackets."""
    parts, depth = [""], 0
    for character in arguments:
        depth += (character in "([{") - (character in ")]}")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]


def documentation(node: Definition) -> str:
    return ast.get_docstring(node) or ""


def decorators(node: ast.FunctionDef) -> list[str]:
    return [ast.unparse(one) for one in node.decorator_list]


def entry(name: str, node: Definition) -> str:
    """A definition with its docstring; of a class also its public methods and properties."""
    text = f"\n### `{name}`\n\n```text\n"
    if isinstance(node, ast.FunctionDef):
        return text + f"{signature(name, node, False)}\n\n{documentation(node)}\n```\n"
    methods = [one for one in node.body if isinstance(one, ast.FunctionDef)]
    made = next((one for one in methods if one.name == "__init__"), None)
    text += f"{signature(name, made, True) if made else f'class {name}'}\n\n{documentation(node)}\n"
    for method in methods:
        if method.name.startswith("_") or not documentation(method):
            continue
        is_property = "property" in decorators(method)
        returns = ast.unparse(method.returns) if method.returns else ""
        head = f"{method.name}: {returns}" if is_property else signature(method.name, method, True)
        body = "\n".join("    " + line if line else "" for line in documentation(method).splitlines())
        text += f"\n{head}\n{body}\n"
    return text + "```\n"


def page() -> str:
    text = HEAD
    for module, files in MODULES.items():
        own = "__init__" if module == "rins" else files[0]
        names = [name for name in public(parsed(own)) if name != "__version__"]
        definitions = {
            node.name: node
            for file in files
            for node in parsed(file).body
            if isinstance(node, (ast.FunctionDef, ast.ClassDef))
        }
        text += f"\n## `{module}`\n"
        for name in sorted(names, key=str.lower):
            text += entry(f"{module}.{name}", definitions[name])
    return text


def main() -> None:
    if "--check" not in sys.argv[1:]:
        PAGE.write_text(page(), encoding="utf-8")
    elif PAGE.read_text(encoding="utf-8") != page():
        raise SystemExit(f"{PAGE}: old; python3 crates/rins-python/api_page.py writes it")


if __name__ == "__main__":
    main()
