"""The card of a published set: the set's own, with licence, authors, physics, numbers, audit and class labels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import yaml

from siggen.errors import DatasetError
from siggen.gearbox.description import assumed_numbers_section, physics_section
from siggen.gearbox.design import SetDesign
from siggen.publication.publication_facts import PublicationFacts

BEFORE = "\n## Columns of `data/`"
FENCE = "---\n"


def published_card(
    card: str, design: SetDesign, facts: PublicationFacts, info: Sequence[Mapping[str, Any]], audit: str
) -> str:
    """Return the card; `card` is the set's own, whose measured section it keeps.

    Raises
    ------
    DatasetError
        If the set's card is not one that siggen wrote.
    """
    start, _, rest = card.partition(FENCE)
    header, fence, body = rest.partition(FENCE)
    place = body.find(BEFORE)
    if start or not fence or place < 0:
        raise DatasetError(
            "README.md of the set is not a card of siggen; `siggen generate` makes it again once deleted"
        )
    own = "\n".join([physics_section(design), audit, assumed_numbers_section(design)])
    body = f"{body[: place + 1]}{own}\n{body[place + 1 :]}"
    return f"{FENCE}{_header(yaml.safe_load(header), facts, info)}{FENCE}{body.rstrip()}\n\n{_closing(facts)}"


def _header(found: dict[str, Any], facts: PublicationFacts, info: Sequence[Mapping[str, Any]]) -> str:
    first = {"pretty_name": facts.title, "license": facts.license.lower()}
    header = {**first, **found, **first, "dataset_info": list(info)}
    return yaml.safe_dump(header, sort_keys=False, allow_unicode=True, width=1000)


def _closing(facts: PublicationFacts) -> str:
    authors = "\n".join(
        f"* {author.name}"
        + (f", {author.affiliation}" if author.affiliation else "")
        + (f" (https://orcid.org/{author.orcid})" if author.orcid else "")
        for author in facts.authors
    )
    doi = f"DOI: https://doi.org/{facts.doi}\n\n" if facts.doi else ""
    return (
        f"## Licence, authors, citation\n\nVersion {facts.version}, published {facts.published} by {facts.publisher} "
        f"({facts.url}) under the licence `{facts.license}`.\n\n{authors}\n\n{doi}Cite as: {facts.citation}\n"
    )
