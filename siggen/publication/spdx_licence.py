"""Identifiers of the SPDX licence list: which are on it, and which one a misspelled text is nearest to."""

from __future__ import annotations

import re
from difflib import get_close_matches
from functools import cache

from siggen.errors import UsageError, how_to_install

OWN = re.compile(r"LicenseRef-[A-Za-z0-9.-]+")
"""How SPDX names a licence that is not on its list (specification, clause 'Other licensing information')."""

LIKENESS = 0.6
"""Least ratio of `difflib` for a suggestion, its own default: less alike is no misspelling."""
FILLING = ("the", "license", "licence")


def is_spdx_licence(said: str) -> bool:
    """Return whether a text is an identifier of the list, in any case, or one of SPDX's form for own licences."""
    return said.lower() in _identifiers() or bool(OWN.fullmatch(said))


def nearest_spdx_licence(said: str) -> str | None:
    """Return the identifier most like a text, from those that begin with it if there are any; None if none is alike.

    `FILLING` is left out, spaces are hyphens.
    """
    wanted = "-".join(word for word in said.lower().split() if word not in FILLING)
    longer = [name for name in _identifiers() if wanted and name.startswith(wanted)]
    near = get_close_matches(wanted, longer or _identifiers(), n=1, cutoff=0.0 if longer else LIKENESS)
    return _identifiers()[near[0]] if near else None


@cache
def _identifiers() -> dict[str, str]:
    """Return identifier by its lower case: licences of the list that are not deprecated, without exceptions."""
    try:
        from license_expression import get_license_index
    except ImportError:
        raise UsageError(f"the list of licences needs license-expression: {how_to_install('diagnostics')}") from None
    listed = (
        entry["spdx_license_key"]
        for entry in get_license_index()
        if not entry["is_exception"] and not entry["is_deprecated"]
    )
    return {name.lower(): name for name in listed if name and not name.startswith("LicenseRef-")}
