"""What a field of the configuration may hold, in words, from its type and its limits."""

from __future__ import annotations

import types
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo


@dataclass(frozen=True, slots=True)
class AllowedText:
    """What a field may hold where the type does not say it well, and its words; put beside the type in `Annotated`."""

    allowed_text: str
    words: tuple[str, ...] = ()


def allowed_text(field: FieldInfo) -> str:
    """Return what a field may hold; a marker that says so itself goes first."""
    for marker in field.metadata:
        if hasattr(marker, "allowed_text"):
            return str(marker.allowed_text)
    return _type_text(field.annotation, _limits_text(field.metadata))


def range_text(above: float | None, least: float | None, below: float | None, most: float | None) -> str:
    """Return a range in words, such as "above 0 and at most 1"; nothing without limits."""
    if least is not None and most is not None:
        return f"from {_digits(least)} to {_digits(most)}"
    limits = [("above", above), ("of at least", least), ("below", below), ("of at most", most)]
    return " and ".join(f"{word} {_digits(limit)}" for word, limit in limits if limit is not None)


def models_in(annotation: object) -> list[type[BaseModel]]:
    """Return the sections that occur in an annotation, in order."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for argument in get_args(annotation) for model in models_in(argument)]


def keys_of(model: type[BaseModel]) -> list[str]:
    """Return the keys of a section as a file has them."""
    return [name for name in model.model_fields if name != getattr(model, "key_field", "")]


def words_in(field: FieldInfo) -> list[str]:
    """Return the words that a field may hold, as far as its type and its markers list them."""
    marked = [word for marker in field.metadata for word in getattr(marker, "words", ()) if isinstance(word, str)]
    return [*_literals(field.annotation), *marked]


def _literals(annotation: object) -> list[str]:
    if get_origin(annotation) is Literal:
        return [str(word) for word in get_args(annotation)]
    return [word for argument in get_args(annotation) for word in _literals(argument)]


def _type_text(annotation: object, limits: str = "") -> str:
    origin, arguments = get_origin(annotation), get_args(annotation)
    models = models_in(annotation)
    if origin is Annotated:
        return allowed_text(FieldInfo.from_annotation(annotation))  # type: ignore[arg-type]
    if origin in {Union, types.UnionType}:
        return ", or ".join(_type_text(argument) for argument in arguments)
    if origin is Literal:
        return f"one of {', '.join(str(word) for word in arguments)}"
    if origin is tuple:
        return f"a list{limits}, each entry {_type_text(arguments[0])}"
    if models:
        return f"a mapping with the keys {', '.join(keys_of(models[0]))}"
    words: dict[object, str] = {
        bool: "true or false", int: "a whole number", float: "a number", str: "a text", type(None): "null"
    }  # fmt: skip
    return words[annotation] + limits


def _limits_text(metadata: Sequence[object]) -> str:
    limits: dict[str, Any] = {}
    for found in metadata:
        for name in ("gt", "ge", "lt", "le", "min_length"):
            limits |= {name: getattr(found, name)} if hasattr(found, name) else {}
    if "min_length" in limits:
        return f" of at least {limits['min_length']}"
    text = range_text(limits.get("gt"), limits.get("ge"), limits.get("lt"), limits.get("le"))
    return f" {text}" if text else ""


def _digits(limit: float) -> str:
    return str(limit) if isinstance(limit, int) else f"{limit:g}"
