"""Writes `rins/schema.py`, the typed dicts of all results, from the JSON schemas in `docs/schema`.

`python schema_types.py` writes the file; `python schema_types.py --check` compares it.
"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
SCHEMAS = HERE.parents[1] / "docs" / "schema"
TYPES = HERE / "python" / "rins" / "schema.py"

HEADER = '''"""The fields of all results as typed dicts.

Made from the JSON schemas of the results by `schema_types.py`; do not edit.
"""

from __future__ import annotations

from typing import NotRequired, TypedDict
'''

SCALARS = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}


def kind(schema: Any) -> str:
    """The Python type of a schema."""
    if schema is True or not schema:
        return "Any"
    if "$ref" in schema:
        return str(schema["$ref"].rsplit("/", 1)[1])
    for key in ("anyOf", "oneOf"):
        if key in schema:
            return " | ".join(dict.fromkeys(kind(one) for one in schema[key]))
    if "allOf" in schema and len(schema["allOf"]) == 1:
        return kind(schema["allOf"][0])
    if "const" in schema or "enum" in schema:
        return "str"
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    return " | ".join(of_type(one, schema) for one in types) or "Any"


def of_type(name: str, schema: dict[str, Any]) -> str:
    if name == "array":
        return f"list[{kind(schema.get('items', True))}]"
    if name == "object":
        values = schema.get("additionalProperties", True)
        return f"dict[str, {kind(values) if values is not False else 'Any'}]"
    return SCALARS[name]


def prose(text: str, indent: str) -> str:
    lines = textwrap.wrap(
        text.replace("\\", "\\\\").replace('"""', "'''"),
        width=96,
        initial_indent=indent + '"""',
        subsequent_indent=indent,
        break_long_words=False,
    )
    return "\n".join(lines) + '"""'


def definition(name: str, schema: dict[str, Any]) -> str:
    properties = schema.get("properties")
    if properties is None:
        return f"{name} = {kind(schema)}"
    required = set(schema.get("required", []))
    if not all(key.isidentifier() and not keyword.iskeyword(key) for key in properties):
        return functional(name, schema, required)
    lines = [f"class {name}(TypedDict):"]
    lines.append(prose(schema.get("description", name), "    "))
    for key, one in properties.items():
        of = kind(one)
        lines.append(f"\n    {key}: {of if key in required else f'NotRequired[{of}]'}")
        if "description" in one:
            lines.append(prose(one["description"], "    "))
    return "\n".join(lines)


def functional(name: str, schema: dict[str, Any], required: set[str]) -> str:
    """A typed dict with a key that is no name in Python."""
    lines = [f"{name} = TypedDict(", f'    "{name}",', "    {"]
    for key, one in schema["properties"].items():
        of = kind(one)
        lines.append(f'        "{key}": "{of if key in required else f"NotRequired[{of}]"}",')
    return "\n".join([*lines, "    },", ")", prose(schema.get("description", name), "")])


def text() -> str:
    schemas = [
        json.loads(path.read_text(encoding="utf-8")) for path in sorted(SCHEMAS.glob("*.json"))
    ]
    variants: dict[str, list[Any]] = {}
    for schema in schemas:
        for name, one in schema.get("$defs", {}).items():
            known = variants.setdefault(name, [])
            if one not in known:
                known.append(one)
    definitions: dict[str, str] = {}
    for schema in schemas:
        # A name with several meanings is preceded by that of the result.
        stem = schema["title"].removesuffix("Result")
        names = {
            name: stem + name if len(variants[name]) > 1 else name
            for name in schema.get("$defs", {})
        }
        whole = json.dumps(schema)
        for name, new in names.items():
            whole = whole.replace(f'"#/$defs/{name}"', f'"#/$defs/{new}"')
        schema = json.loads(whole)
        for name, one in [*schema.get("$defs", {}).items(), (schema["title"], schema)]:
            definitions[names.get(name, name)] = definition(names.get(name, name), one)
    body = "\n\n\n".join(definitions[name] for name in sorted(definitions))
    return f"{HEADER}\n\n{body}\n"


if __name__ == "__main__":
    made = text()
    if "--check" in sys.argv:
        if TYPES.read_text(encoding="utf-8") != made:
            raise SystemExit(f"{TYPES} is not that of the schemas; run schema_types.py")
    else:
        TYPES.write_text(made, encoding="utf-8")
