"""Keys that files had before, and how to write now what they said."""

from __future__ import annotations

NOW = {
    "grows_from": "write grows: NAME of the milder state; a state without it begins anew",
    "sham": "write acts: false",
}
"""Last part of the path of a former key -> the words of its refusal."""
