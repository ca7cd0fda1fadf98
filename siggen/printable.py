"""Texts of strangers, such as names in a file, on a terminal and in Markdown: shown, never obeyed.

A terminal obeys ESC and other control characters, and turns text at signs of direction such as U+202E. A viewer of
Markdown obeys tags. Names of a set, of columns, of files and of models come from wherever the files do.
"""

from __future__ import annotations

import unicodedata

OBEYED = frozenset(("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"))
"""Categories of Unicode that are no visible sign: control, format, surrogates, private, unassigned, ends of lines."""
TAGS = {"&": "&amp;", "<": "&lt;", ">": "&gt;", "`": "&#96;", "|": "&#124;", "[": "&#91;", "]": "&#93;"}


def printable(text: object, *, lines: bool = False) -> str:
    r"""Return a text in which all that is no visible sign stands as \x1b or \u202e; `lines` keeps ends of lines."""
    kept = "\n\t" if lines else ""
    return "".join(
        sign if sign in kept or unicodedata.category(sign) not in OBEYED else _escaped(sign) for sign in str(text)
    )


def markdown(text: object) -> str:
    """Return a text as words of one line of Markdown: no tag, no link, no code, no cell of a table."""
    return "".join(TAGS.get(sign, sign) for sign in printable(text))


def _escaped(sign: str) -> str:
    number = ord(sign)
    return f"\\x{number:02x}" if number < 0x100 else f"\\u{number:04x}" if number < 0x10000 else f"\\U{number:08x}"
