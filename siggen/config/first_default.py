"""Defaults as they were when sets were first written: identities count from them, whatever the defaults are now."""

from __future__ import annotations

from pydantic.fields import FieldInfo


class IdentityDefault:
    """Values of a key that leave an identity as it is; put beside the type in `Annotated` when a default changes.

    The first one is the default that sets were first written with; others may follow that mean the same.
    """

    def __init__(self, *values: object) -> None:
        self.values = values


def uncounted(field: FieldInfo) -> tuple[object, ...]:
    """Return the values of a key that do not count in an identity."""
    for marker in field.metadata:
        if isinstance(marker, IdentityDefault):
            return marker.values
    return (field.get_default(call_default_factory=True),)
