"""What a program of its own draws on a page: its style, its script, and the data that it reads."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

# What could end the script element, open a comment in it, or end a line of JSON for older readers; and what turns text.
IN_SCRIPT: dict[int, str] = str.maketrans(
    {sign: f"\\u{ord(sign):04x}" for sign in "<>&\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"}
)


@dataclass(frozen=True, slots=True)
class Live:
    """A part of a page that is drawn when the page opens.

    Attributes
    ----------
    style, script : str
        Our own text, never that of a set.
    data : mapping of str to value
        What JSON can hold, by the name of the element that holds it; the script reads each when it is wanted.
    """

    style: str = ""
    script: str = ""
    data: Mapping[str, Any] = field(default_factory=dict)


STILL = Live()
"""A page that nothing is drawn on."""


def script_json(value: Any) -> str:
    """Return JSON that may stand inside a script element: nothing in it can close the element or open another.

    Raises
    ------
    ValueError
        If a number is not finite, which JSON cannot hold.
    """
    return json.dumps(value, allow_nan=False, separators=(",", ":"), ensure_ascii=False).translate(IN_SCRIPT)
