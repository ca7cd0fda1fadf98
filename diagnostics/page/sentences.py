"""Sentences of pages as templates: how something is said stands there, what it is said of comes from Python."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from diagnostics.base.extras import require_packages
from diagnostics.page import wording
from siggen.printable import markdown

if TYPE_CHECKING:
    from jinja2 import Template

FILTERS = (
    *(wording.capitalised, wording.counted, wording.decimal, wording.joined, wording.limits, wording.percent),
    *(markdown, wording.percent_limits, wording.rounded, wording.signed, wording.signed_limits),
)


class Sentences:
    """Macros of a template as functions that return plain text on one line.

    Between a number and its unit (%, mm², Hz, N m) the space does not break.

    Parameters
    ----------
    template : Path
        Its macros may use the functions of `diagnostics.page.wording` as filters, `finite` as a test, and two more:
        `which|those(holds)` keeps what a function holds of, `states|each(said, best)` says each with the same facts.
    known : functions and values
        What macros may call besides, by name.

    Examples
    --------
    >>> answer = Sentences(Path("answer.txt"))
    >>> answer.first_answer(found)
    """

    def __init__(self, template: Path, **known: Any) -> None:
        self._template, self._known = template, known

    @cached_property
    def _macros(self) -> Any:
        return _template(self._template, self._known).module

    def __getattr__(self, sentence: str) -> Callable[..., str]:
        if sentence.startswith("_"):
            raise AttributeError(sentence)
        return lambda *facts, **named: one_line(getattr(self._macros, sentence)(*facts, **named))


def filled(template: Path, **facts: Any) -> str:
    """Return a template of Markdown or YAML with its facts filled in; `value|form(".2f")` is Python's format."""
    return f"{_template(template, {}).render(**facts).rstrip()}\n"


def listed(template: Path, **facts: Any) -> list[str]:
    """Return the lines of a template with its facts filled in, a sentence each."""
    return [line for line in filled(template, **facts).splitlines() if line]


def _template(path: Path, known: Mapping[str, Any]) -> Template:
    require_packages("a page", "jinja2")
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(path.parent),
        autoescape=False,  # no HTML: pages escape all of it, `markdown` what stands in Markdown
        finalize=lambda value: value.strip(" \n") if isinstance(value, str) else value,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {one.__name__: one for one in FILTERS} | {"each": _each, "form": format, "those": _those}
    environment.tests["finite"] = math.isfinite
    return environment.get_template(path.name, globals=known)


def one_line(text: str) -> str:
    """Return text with single spaces, which do not break between a number and its unit."""
    whole = re.sub(r"[ \n]+", " ", text).strip(" ")
    return re.sub(r"(?<=\d) (?:%|mm²|Hz|N m)", lambda unit: unit[0].replace(" ", "\N{NO-BREAK SPACE}"), whole)


def _each(items: Iterable[Any], said: Callable[..., str], *facts: Any) -> list[str]:
    return [said(item, *facts).strip(" \n") for item in items]


def _those(items: Iterable[Any], holds: Callable[[Any], bool]) -> list[Any]:
    return [item for item in items if holds(item)]
