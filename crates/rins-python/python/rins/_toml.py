"""Writing of rig files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

_BARE = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")


def _text(value: str) -> str:
    """A basic string of TOML."""
    escaped = {'"': '\\"', "\\": "\\\\"}
    letters = (escaped.get(c, c) if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in value)
    return '"' + "".join(letters) + '"'


def _key(key: str) -> str:
    return key if key and set(key) <= _BARE else _text(key)


def value(item: object) -> str:
    """A value in one line.

    Raises
    ------
    TypeError
        If TOML has no such value.
    """
    if isinstance(item, str):
        return _text(item)
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, (int, float)):
        return repr(item)
    if isinstance(item, Mapping):
        pairs = (f"{_key(str(key))} = {value(one)}" for key, one in item.items())
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(item, Sequence):
        return "[" + ", ".join(value(one) for one in item) + "]"
    raise TypeError(
        f"{item!r} is {type(item).__name__}, expected a text, a number, a list or a dict"
    )


def document(sections: Mapping[str, Mapping[str, object]]) -> str:
    """A file of sections; a mapping whose values are all mappings is written as subsections."""
    lines: list[str] = []
    for name, section in sections.items():
        nested = {
            key: one
            for key, one in section.items()
            if name in ("imu", "tolerance", "truth") and isinstance(one, Mapping)
        }
        plain = {key: one for key, one in section.items() if key not in nested}
        if plain or not nested:
            lines.append(f"[{_key(name)}]")
            lines.extend(f"{_key(key)} = {value(one)}" for key, one in plain.items())
            lines.append("")
        for key, one in nested.items():
            lines.append(f"[{_key(name)}.{_key(key)}]")
            lines.extend(f"{_key(inner)} = {value(item)}" for inner, item in one.items())
            lines.append("")
    return "\n".join(lines)
