"""Section `states`: the conditions of health in which every specimen is measured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, model_validator

from siggen.errors import Problem
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

    @model_validator(mode="before")
    @classmethod
    def _fill_labels(cls, value: Any) -> Any:
        if not isinstance(value, Mapping):
            return value
        damaged = value.get("damage") is not None
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

    def _label_problems(self) -> list[Problem]:
        problems = []
        healthy_fault, healthy_severity = self.fault == "healthy", self.severity == "healthy"
        if self.damage is None and not (healthy_fault and healthy_severity):
            received = f"{MISSING}, with fault {self.fault} and severity {self.severity}"
            problems.append(Problem("damage", received, "allowed: damage, or fault and severity both healthy"))
        if self.damage is not None and healthy_fault:
            allowed = f"allowed: {' or '.join(FAULT_WORDS[1:])}, or no damage"
            problems.append(Problem("fault", "healthy, with damage", allowed))
        if self.damage is not None and healthy_severity:
            problems.append(
                Problem("severity", "healthy, with damage", "allowed: slight, moderate or severe, or no damage")
            )
        if self.damage is None and self.grows_from not in RESERVED_NAMES:
            received = f"'{self.grows_from}', without damage"
            problems.append(Problem("grows_from", received, "only a state with damage grows from another one"))
        return problems


def grown_from(states: tuple[State, ...], state_id: int) -> int | None:
    """Return the index of the state whose damage a state contains, or None if it begins with an intact gear."""
    state = states[state_id]
    if state.damage is None or state.grows_from == "none":
        return None
    earlier = [i for i in range(state_id) if states[i].damage is not None]
    if state.grows_from == "previous":
        return earlier[-1] if earlier else None
    return next(i for i in earlier if states[i].name == state.grows_from)
