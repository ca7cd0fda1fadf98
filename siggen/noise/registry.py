"""What follows from the list of sources: the keys that the section of a sensor has for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pydantic import Field, create_model

from siggen.keys.section import Section
from siggen.noise.kinds import SOURCES
from siggen.noise.source import Source


class SourcesOfChannels(Section):
    """Base of sections whose channels get noise and lines."""

    @property
    def sources(self) -> tuple[Source, ...]:
        """Those that the section has, in the order in which they are added."""
        found = (getattr(self, one.key) for one in SOURCES)
        return tuple(one for one in found if one is not None)


def _keys() -> dict[str, Any]:
    return {one.key: (one | None, Field(default=None, description=f"{one.about}null: none")) for one in SOURCES}


if TYPE_CHECKING:
    SourceKeys = SourcesOfChannels
else:
    SourceKeys = create_model("SourceKeys", __base__=SourcesOfChannels, __doc__="A key for each source.", **_keys())
