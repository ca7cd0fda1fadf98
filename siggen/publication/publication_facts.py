"""What only the authors can say about a set that is to be published: licence, authors, citation, place."""

from __future__ import annotations

import datetime
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from siggen.errors import ConfigError, Problem
from siggen.keys.yaml_source import read_yaml
from siggen.publication.spdx_licence import is_spdx_licence, nearest_spdx_licence

UNSET = "unset"
TEMPLATE = """# What `siggen publish` needs from you. Replace every `unset`.
license: unset               # SPDX identifier, such as cc-by-4.0, cc0-1.0, odc-by-1.0
title: unset
version: 1.0.0               # of the set, as you count it
published: unset             # date, such as 2026-11-30
publisher: unset             # who keeps it: Zenodo, Hugging Face, your institute
url: unset                   # where it will be: https://...
doi: null                    # if it has one already, such as 10.5281/zenodo.1234567
with_recordings: false       # true: paths and lines that were fitted to your recordings may be published
citation: unset              # as others shall cite it, one text
authors:
  - name: unset              # Family, Given
    affiliation: null
    orcid: null              # such as 0000-0002-1825-0097
"""
NEEDED = ("license", "title", "version", "published", "publisher", "url", "citation")
OPTIONAL = ("doi", "with_recordings")
DOI = re.compile(r"10\.\d{4,9}/\S+")
ORCID = re.compile(r"\d{4}-\d{4}-\d{4}-\d{3}[\dX]")


@dataclass(frozen=True, slots=True)
class Author:
    """One author: name as 'Family, Given', institute and ORCID where given."""

    name: str
    affiliation: str | None = None
    orcid: str | None = None


@dataclass(frozen=True, slots=True)
class PublicationFacts:
    """What the authors say; `license` is an SPDX identifier, `published` a date as YYYY-MM-DD.

    `with_recordings` allows numbers that come from recordings: a family of paths, a table of lines.
    """

    license: str
    title: str
    version: str
    published: str
    publisher: str
    url: str
    citation: str
    authors: tuple[Author, ...]
    doi: str | None = None
    with_recordings: bool = False

    @property
    def year(self) -> int:
        """Year of publication."""
        return int(self.published[:4])


def read_publication_facts(path: Path) -> PublicationFacts:
    """Read the authors' file.

    Raises
    ------
    UsageError
        If it cannot be read.
    ConfigError
        Naming everything that is unset, missing or of another form, at once.
    """
    raw = read_yaml(path)
    problems = [*_unknown(raw), *_wrong(raw), *_author_problems(raw.get("authors"))]
    if problems:
        raise ConfigError(problems, str(path))
    authors = tuple(Author(**author) for author in raw["authors"])
    optional = {name: raw[name] for name in OPTIONAL if name in raw}
    return PublicationFacts(authors=authors, **optional, **{name: raw[name] for name in NEEDED})


def _unknown(raw: Mapping[str, Any]) -> list[Problem]:
    known = (*NEEDED, *OPTIONAL, "authors")
    return [Problem(str(key), "a key", f"allowed: {', '.join(known)}") for key in list(raw)[:20] if key not in known]


def _wrong(raw: Mapping[str, Any]) -> list[Problem]:
    found = []
    for name in NEEDED:
        value = raw.get(name, UNSET)
        if not isinstance(value, str) or not value.strip() or value == UNSET:
            received = UNSET if value == UNSET else f"{str(value)[:40]!r}"
            found.append(Problem(name, received, f"allowed: {ALLOWED[name]}"))
        elif not _has_form(name, value):
            found.append(Problem(name, f"the text '{value[:60]}'", f"allowed: {ALLOWED[name]}{_meant(name, value)}"))
    doi = raw.get("doi")
    if doi is not None and not (isinstance(doi, str) and DOI.fullmatch(doi)):
        found.append(Problem("doi", f"{str(doi)[:60]!r}", "allowed: null, or a DOI such as 10.5281/zenodo.1234567"))
    if not isinstance(fitted := raw.get("with_recordings", False), bool):
        found.append(Problem("with_recordings", f"{str(fitted)[:40]!r}", "allowed: true or false"))
    return found


ALLOWED = {
    "license": "the SPDX identifier of the licence that you give, such as cc-by-4.0; siggen gives none",
    "title": "a text",
    "version": "a text of three numbers, such as 1.0.0",
    "published": "a date, such as 2026-11-30",
    "publisher": "a text, such as Zenodo",
    "url": "where it will be, https://...",
    "citation": "a text, as others shall cite the set",
}


def _meant(name: str, value: str) -> str:
    nearest = nearest_spdx_licence(value) if name == "license" else None
    return f". Did you mean {nearest}?" if nearest else ""


def _has_form(name: str, value: str) -> bool:
    match name:
        case "license":
            return is_spdx_licence(value)
        case "version":
            return bool(re.fullmatch(r"\d+\.\d+\.\d+", value))
        case "published":
            return _is_date(value)
        case "url":
            return bool(re.fullmatch(r"https?://\S+", value))
    return True


def _is_date(value: str) -> bool:
    try:
        return datetime.date.fromisoformat(value).isoformat() == value
    except ValueError:
        return False


def _author_problems(authors: object) -> list[Problem]:
    if not isinstance(authors, list) or not authors:
        return [Problem("authors", "none", "allowed: a list with at least one name")]
    found = []
    for place, author in enumerate(authors):
        name = author.get("name", UNSET) if isinstance(author, Mapping) else UNSET
        if not isinstance(name, str) or name.strip() in ("", UNSET):
            found.append(Problem(f"authors.{place}.name", UNSET, "allowed: Family, Given"))
            continue
        found += [
            Problem(f"authors.{place}.{key}", "a key", "allowed: name, affiliation, orcid")
            for key in author
            if key not in ("name", "affiliation", "orcid")
        ]
        orcid = author.get("orcid")
        if orcid is not None and not (isinstance(orcid, str) and ORCID.fullmatch(orcid)):
            allowed = "allowed: null, or an ORCID such as 0000-0002-1825-0097"
            found.append(Problem(f"authors.{place}.orcid", f"{str(orcid)[:40]!r}", allowed))
    return found
