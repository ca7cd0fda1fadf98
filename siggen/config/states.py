"""Section `states`: the conditions of health in which every specimen is measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, model_validator

from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.registry import DAMAGE, FAULT_WORDS, HEALTHY, DamageSection, FaultWord, default_word
from siggen.keys.problems import MISSING, refusal
from siggen.keys.section import Section
from siggen.keys.wording import AllowedText

SEVERITIES = ("healthy", "slight", "moderate", "severe")
RESERVED_NAMES = ("previous", "none")
STATE_NAME = AllowedText("lower-case letters, digits, - and _, beginning with a letter, at most 200")


def _labels_are_optional(schema: dict[str, Any]) -> None:
    """Keep the labels out of the required keys for editors: they are filled in before validation."""
    schema["required"] = [key for key in schema["required"] if key not in ("fault", "severity")]


class State(Section):
    """One condition: its label, its damage, and the milder state it has grown from."""

    model_config = ConfigDict(json_schema_extra=_labels_are_optional)

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_-]{0,199}$"), STATE_NAME] = Field(
        description="label of the state"
    )
    fault: FaultWord = Field(description="default: what its kind of damage is called; healthy without damage")
    severity: Literal["healthy", "slight", "moderate", "severe"] = Field(
        description="default: the state's name if that is a severity; healthy without damage"
    )
    grows_from: str = Field(
        default="previous",
        description="whose damage it contains: previous (the nearest earlier state with damage), none, or a name",
    )
    damage: Annotated[DamageSection | None, DAMAGE] = Field(default=None, description="null for a healthy state")
    sham: bool = Field(
        default=False,
        strict=True,
        description="its damage is drawn, tabulated and passed on, with nothing removed: a healthy state that no "
        "record may give away",
    )

    @property
    def damages(self) -> tuple[Fault, ...]:
        """Sections of its damage, none of a healthy state; those of a sham too."""
        return () if self.damage is None else (self.damage,)

    def placed(self, path: str) -> Iterator[tuple[str, Fault]]:
        """Yield path and section of all of its damage, for the state's own path."""
        if self.damage is not None:
            yield f"{path}.damage", self.damage

    @property
    def damaged(self) -> bool:
        """Whether anything is removed."""
        return bool(self.damages) and not self.sham

    @property
    def remarks(self) -> tuple[str, ...]:
        """What fault and severity do not say about it, in words."""
        return ("sham: its damage passes everywhere, with nothing removed",) if self.sham else ()

    @model_validator(mode="before")
    @classmethod
    def _fill_labels(cls, value: Any) -> Any:
        if not isinstance(value, Mapping):
            return value
        damaged = value.get("damage") is not None and value.get("sham") is not True
        labels = {"fault": default_word(value["damage"]) if damaged else HEALTHY}
        name = value.get("name")
        if not damaged:
            labels["severity"] = "healthy"
        elif name in SEVERITIES:
            labels["severity"] = str(name)
        return {**labels, **value}

    @model_validator(mode="after")
    def _labels_agree(self) -> State:
        problems = [*self._name_problems(), *self._label_problems()]
        if problems:
            raise refusal(problems)
        return self

    def _name_problems(self) -> list[Problem]:
        if self.name not in RESERVED_NAMES:
            return []
        return [
            Problem("name", f"the text '{self.name}'", f"allowed: a name other than {' and '.join(RESERVED_NAMES)}")
        ]

    def _label_problems(self) -> Iterator[Problem]:
        healthy = self.fault == HEALTHY, self.severity == HEALTHY
        if self.sham:
            yield from self._sham_problems()
        elif not self.damaged and not all(healthy):
            received = f"{MISSING}, with fault {self.fault} and severity {self.severity}"
            yield Problem("damage", received, "allowed: damage, or fault and severity both healthy")
        elif self.damaged and healthy[0]:
            allowed = f"allowed: {' or '.join(FAULT_WORDS[1:])}, or no damage"
            yield Problem("fault", "healthy, with damage", allowed)
        if self.damaged and healthy[1]:
            yield Problem("severity", "healthy, with damage", "allowed: slight, moderate or severe, or no damage")
        if not self.damaged and self.grows_from not in RESERVED_NAMES:
            received = f"'{self.grows_from}', {'with sham: true' if self.sham else 'without damage'}"
            yield Problem("grows_from", received, "only a state with damage grows from another one")

    def _sham_problems(self) -> Iterator[Problem]:
        """Yield what a state in whose damage nothing is removed cannot be."""
        if not self.damages:
            yield Problem("sham", "true, without damage", "allowed: damage, of which nothing is then removed; or false")
        for key in ("fault", "severity"):
            if getattr(self, key) != HEALTHY:
                received = f"'{getattr(self, key)}', with sham: true"
                yield Problem(key, received, "allowed: healthy, since nothing is removed; or sham: false")


def grown_from(states: tuple[State, ...], state_id: int) -> int | None:
    """Return the index of the state whose damage a state contains, or None if it begins with an intact gear."""
    state = states[state_id]
    if not state.damaged or state.grows_from == "none":
        return None
    earlier = [i for i in range(state_id) if states[i].damaged]
    if state.grows_from == "previous":
        return earlier[-1] if earlier else None
    return next(i for i in earlier if states[i].name == state.grows_from)
