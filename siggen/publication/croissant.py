"""croissant.json of a published set. Source: MLCommons Croissant Format Specification 1.1."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pyarrow as pa

from siggen.columns.record import BEFORE_QUANTITIES
from siggen.dataset.object_name import DAMAGE, LABELS
from siggen.publication.publication_facts import PublicationFacts

CONTEXT: dict[str, Any] = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "arrayShape": "cr:arrayShape",
    "citeAs": "cr:citeAs",
    "column": "cr:column",
    "conformsTo": "dct:conformsTo",
    "containedIn": "cr:containedIn",
    "cr": "http://mlcommons.org/croissant/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataBiases": "cr:dataBiases",
    "dataCollection": "cr:dataCollection",
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "equivalentProperty": "cr:equivalentProperty",
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "extract": "cr:extract",
    "field": "cr:field",
    "fileObject": "cr:fileObject",
    "fileProperty": "cr:fileProperty",
    "fileSet": "cr:fileSet",
    "format": "cr:format",
    "includes": "cr:includes",
    "isArray": "cr:isArray",
    "isLiveDataset": "cr:isLiveDataset",
    "jsonPath": "cr:jsonPath",
    "key": "cr:key",
    "md5": "cr:md5",
    "parentField": "cr:parentField",
    "path": "cr:path",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "recordSet": "cr:recordSet",
    "references": "cr:references",
    "regex": "cr:regex",
    "repeated": "cr:repeated",
    "replace": "cr:replace",
    "samplingRate": "cr:samplingRate",
    "sc": "https://schema.org/",
    "separator": "cr:separator",
    "source": "cr:source",
    "subField": "cr:subField",
    "transform": "cr:transform",
}
REPOSITORY = "repository"
FOLDERS = {"signals": "data", "internals": "internals"}
TABLES = {"labels": LABELS, "damage": DAMAGE}
NO_HASH = "https://github.com/mlcommons/croissant/issues/80"
"""What the specification's own examples give as the hash of a repository, which has none."""


def croissant(
    facts: PublicationFacts, description: str, tags: Sequence[str], schemas: Mapping[str, pa.Schema], limits: str
) -> dict[str, Any]:
    """Return the metadata; `schemas` by view (signals, labels, damage, internals).

    Whoever has the folder reads it with `mapping={"repository": folder}`.
    """
    return {
        "@context": CONTEXT,
        "@type": "sc:Dataset",
        "conformsTo": "http://mlcommons.org/croissant/1.1",
        "name": "".join(character if character.isalnum() or character in "-_ " else "-" for character in facts.title),
        "description": description,
        "license": facts.license,
        "url": facts.url,
        "version": facts.version,
        "datePublished": facts.published,
        "citeAs": facts.citation,
        "keywords": list(tags),
        "creator": [{"@type": "sc:Person", "name": author.name} for author in facts.authors],
        "publisher": {"@type": "sc:Organization", "name": facts.publisher},
        "rai:dataCollection": "Simulated by siggen from config.yaml; nothing was measured.",
        "rai:dataLimitations": limits,
        "distribution": [_repository(facts), *(_files(view) for view in schemas)],
        "recordSet": [_records(view, schema) for view, schema in schemas.items()],
    }


def _repository(facts: PublicationFacts) -> dict[str, Any]:
    return {
        "@type": "cr:FileObject",
        "@id": REPOSITORY,
        "name": REPOSITORY,
        "description": "The folder of the set; manifest.json holds the SHA-256 of every file.",
        "contentUrl": facts.url,
        "encodingFormat": "git+https",
        "sha256": NO_HASH,
    }


def _files(view: str) -> dict[str, Any]:
    return {
        "@type": "cr:FileSet",
        "@id": f"{view}-files",
        "name": f"{view}-files",
        "containedIn": {"@id": REPOSITORY},
        "encodingFormat": "application/x-parquet",
        "includes": TABLES.get(view) or f"{FOLDERS[view]}/*.parquet",
    }


def _records(view: str, schema: pa.Schema) -> dict[str, Any]:
    keyed = {"key": {"@id": f"{view}/record_id"}} if view != "damage" else {}
    return {
        "@type": "cr:RecordSet",
        "@id": view,
        "name": view,
        **keyed,
        "field": [_field(view, field) for field in schema],
    }


def _field(view: str, field: pa.Field) -> dict[str, Any]:
    facts = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
    quantity = facts.get("quantity", BEFORE_QUANTITIES)
    meaning = facts.get("meaning") or f"{quantity} at {facts.get('place', '')}, {facts.get('axis', '')}"
    unit = f" [{facts['unit']}]" if facts.get("unit") else ""
    return {
        "@type": "cr:Field",
        "@id": f"{view}/{field.name}",
        "name": field.name,
        "description": f"{meaning}{unit}",
        "source": {"fileSet": {"@id": f"{view}-files"}, "extract": {"column": field.name}},
        **dict(_shape(field.type)),
    }


def _shape(kind: pa.DataType) -> Iterator[tuple[str, Any]]:
    inner = kind
    if isinstance(kind, pa.FixedSizeListType | pa.ListType):
        inner = kind.value_type
        yield "isArray", True
        yield "arrayShape", str(kind.list_size) if isinstance(kind, pa.FixedSizeListType) else "-1"
    yield "dataType", _data_type(inner)


def _data_type(kind: pa.DataType) -> str:
    if pa.types.is_boolean(kind):
        return "sc:Boolean"
    if pa.types.is_integer(kind):
        return "sc:Integer"
    return "sc:Float" if pa.types.is_floating(kind) else "sc:Text"
