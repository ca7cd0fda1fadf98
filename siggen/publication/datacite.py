"""Fields of DataCite for a DOI. Source: DataCite Metadata Schema 4.5, mandatory and recommended properties."""

from __future__ import annotations

from typing import Any

from siggen.publication.publication_facts import Author, PublicationFacts


def datacite_fields(
    facts: PublicationFacts, description: str, tags: tuple[str, ...], size_bytes: int
) -> dict[str, Any]:
    """Return the fields as DataCite's JSON has them."""
    return {
        "schemaVersion": "http://datacite.org/schema/kernel-4",
        **({"doi": facts.doi} if facts.doi else {}),
        "url": facts.url,
        "titles": [{"title": facts.title}],
        "creators": [_creator(author) for author in facts.authors],
        "publisher": {"name": facts.publisher},
        "publicationYear": facts.year,
        "dates": [{"date": facts.published, "dateType": "Issued"}],
        "types": {"resourceTypeGeneral": "Dataset", "resourceType": "Simulated vibration records"},
        "subjects": [{"subject": tag} for tag in tags],
        "rightsList": [{"rightsIdentifier": facts.license, "rightsIdentifierScheme": "SPDX"}],
        "descriptions": [{"description": description, "descriptionType": "Abstract"}],
        "formats": ["application/x-parquet"],
        "sizes": [f"{size_bytes} bytes"],
        "version": facts.version,
        "language": "en",
    }


def _creator(author: Author) -> dict[str, Any]:
    family, _, given = (part.strip() for part in author.name.partition(","))
    orcid = f"https://orcid.org/{author.orcid}"
    identifier = {"nameIdentifier": orcid, "nameIdentifierScheme": "ORCID", "schemeUri": "https://orcid.org"}
    return {
        "name": author.name,
        "nameType": "Personal" if given else "Organizational",
        **({"familyName": family, "givenName": given} if given else {}),
        **({"affiliation": [{"name": author.affiliation}]} if author.affiliation else {}),
        **({"nameIdentifiers": [identifier]} if author.orcid else {}),
    }
