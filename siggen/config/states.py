"""Section `states`: the conditions of health in which every specimen is measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field, model_validator

from siggen.config.changes import Change, Changes
from siggen.damage.fault import Fault
from siggen.damage.registry import COMBINED, DAMAGE, FAULT_WORDS, HEALTHY, KNOWN_CHANGES, DamageSections, default_word
from siggen.errors import Problem
from siggen.keys.by_name import without_key_field
from siggen.keys.merging import merged
from siggen.keys.problems import MISSING, nearest_word, received_text, refusal
from siggen.keys.section import Section
from siggen.keys.user_name import WORD, WORD_TEXT, StateName
from siggen.keys.wording import AllowedText

SEVERITIES = ("healthy", "slight", "moderate", "severe")
FAULT = AllowedText(
    f"with damage {', '.join(FAULT_WORDS[1:])}; with changes a word such as {', '.join(KNOWN_CHANGES)}; {WORD_TEXT}"
)
WORDS = {"damage": " or ".join(FAULT_WORDS[1:]), "changes": f"a word such as {', '.join(KNOWN_CHANGES)}"}


def _labels_are_optional(schema: dict[str, Any]) -> None:
    """Keep the labels out of the required keys for editors: they are filled in before validation."""
    without_key_field(schema, "name")
    schema["required"] = [key for key in schema["required"] if key not in ("fault", "severity")]


class StateSection(Section):
    """One condition: its label, its damage, and the milder state that it grows from."""

    key_field: ClassVar[str] = "name"
    model_config = ConfigDict(json_schema_extra=_labels_are_optional)

    name: StateName = Field(description="label of the state")
    fault: Annotated[str, Field(pattern=f"^{WORD}$"), FAULT] = Field(
        description="default: the word of its damage; healthy without damage and changes"
    )
    severity: StateName = Field(description="default: the state's name; healthy without damage")
    grows: str | None = Field(
        default=None,
        description="milder state whose damage it contains, and whose keys it takes over; null: it begins anew",
    )
    like: str | None = Field(
        default=None,
        description="state whose keys it takes over without growing from it",
        exclude=True,
    )
    damage: Annotated[DamageSections | None, DAMAGE] = Field(
        default=None, description="null for a healthy state; a list for several at once"
    )
    acts: bool = Field(
        default=True,
        strict=True,
        description="false: a sham: damage is drawn and tabulated, but nothing is removed",
    )

    changes: Changes = Field(
        default=(),
        description="keys of machine or sensors that differ from the healthy gearbox: a number, times or plus",
        json_schema_extra={"default": {}},
    )

    @property
    def damages(self) -> tuple[Fault, ...]:
        """Sections of its damage, none of a healthy state; those of a sham too."""
        if self.damage is None:
            return ()
        return self.damage if isinstance(self.damage, tuple) else (self.damage,)

    def with_damages(self, sections: tuple[Fault, ...]) -> StateSection:
        """Return the state with other sections in place of its own, as many."""
        if not sections:
            return self
        return self.model_copy(update={"damage": sections if isinstance(self.damage, tuple) else sections[0]})

    def placed(self, path: str) -> Iterator[tuple[str, Fault]]:
        """Yield path and section of all of its damage, for the state's own path."""
        listed = isinstance(self.damage, tuple)
        yield from ((f"{path}.damage{f'.{i}' if listed else ''}", one) for i, one in enumerate(self.damages))

    @property
    def sham(self) -> bool:
        """Whether it has damage of which nothing is removed."""
        return not self.acts

    @property
    def damaged(self) -> bool:
        """Whether anything is removed."""
        return bool(self.damages) and not self.sham

    @property
    def primary_fault(self) -> str:
        """One word for classifiers: its fault, and of a combined one that of the first section of its list."""
        return self.damages[0].word if self.fault == COMBINED else self.fault

    @property
    def faulty(self) -> bool:
        """Whether it differs from a healthy machine by itself: by damage, or by what it changes."""
        return self.damaged or bool(self.changes)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What fault and severity do not say about it, in words."""
        sham = ("a sham: its damage passes everywhere, with nothing removed",) if self.sham else ()
        return (*sham, *(f"changes {one.text}" for one in self.changes))

    @model_validator(mode="before")
    @classmethod
    def _fill_labels(cls, value: Any) -> Any:
        if not isinstance(value, Mapping):
            return value
        sound = value.get("damage") is None or value.get("acts") is False
        labels = {}
        if not sound:
            labels["fault"] = default_word(value["damage"])
        elif not value.get("changes"):
            labels |= {"fault": HEALTHY, "severity": HEALTHY}
        if "severity" not in labels and isinstance(value.get("name"), str):
            labels["severity"] = value["name"]
        return {**labels, **value}

    @model_validator(mode="after")
    def _labels_agree(self) -> StateSection:
        problems = [*self._label_problems()]
        if problems:
            raise refusal(problems)
        return self

    def _label_problems(self) -> Iterator[Problem]:
        healthy = self.fault == HEALTHY, self.severity == HEALTHY
        faulty, shown = self.faulty, "damage" if self.damages else "changes"
        if self.sham:
            yield from self._sham_problems()
        elif not faulty and not all(healthy):
            received = f"{MISSING}, with fault {self.fault} and severity {self.severity}"
            yield Problem("damage", received, "allowed: damage or changes, or fault and severity both healthy")
        elif faulty and healthy[0]:
            allowed = f"allowed: {WORDS[shown]}, or no {shown}"
            yield Problem("fault", f"healthy, with {shown}", allowed)
        if faulty and not self.sham and healthy[1]:
            yield Problem("severity", f"healthy, with {shown}", f"allowed: any other name, or no {shown}")
        if not faulty and self.grows is not None:
            received = f"'{self.grows}', {'with acts: false' if self.sham else 'without damage'}"
            yield Problem(
                "grows", received, "only a state with damage or changes grows from another one; allowed: like"
            )

    def _sham_problems(self) -> Iterator[Problem]:
        """Yield what a state in whose damage nothing is removed cannot be."""
        if self.changes:
            yield Problem("changes", "a mapping, with acts: false", "allowed: none, or acts: true")
        if not self.damages:
            yield Problem("acts", "false, without damage", "allowed: damage, of which nothing is then removed; or true")
        for key in ("fault", "severity"):
            if getattr(self, key) != HEALTHY:
                received = f"'{getattr(self, key)}', with acts: false"
                yield Problem(key, received, "allowed: healthy, since nothing is removed; or acts: true")


def grown_from(states: tuple[StateSection, ...], state_id: int) -> int | None:
    """Return the index of the state whose damage and changes a state contains, or None if it begins anew."""
    milder = states[state_id].grows
    return None if milder is None else next(i for i, state in enumerate(states) if state.name == milder)


def changes_of(states: tuple[StateSection, ...], state_id: int) -> tuple[tuple[int, Change], ...]:
    """Return what a state changes, each with the state that says so first: itself, or a milder one."""
    first = dict.fromkeys(states[state_id].changes, state_id)
    older = grown_from(states, state_id)
    while older is not None:
        first |= {change: older for change in states[older].changes if change in first}
        older = grown_from(states, older)
    return tuple((index, change) for change, index in first.items())


# States with the keys that they take over from those that they grow from or are like.

OF_ACTING_DAMAGE = ("fault", "severity")
"""Labels that a sham does not take over."""


def complete_states(states: Mapping[str, object]) -> tuple[dict[str, object], list[Problem]]:
    """Return states with all of their keys, and the problems of those that take over what is not there.

    What a state says itself goes before what it takes over; mappings are merged key by key, as in a file that extends
    another one. States with a problem are left out, and those that take over from them.

    Parameters
    ----------
    states : mapping
        Name -> state as a file has it, none of them null.
    """
    complete: dict[str, object] = {}  # None: left out
    problems: list[Problem] = []
    for name in states:
        chain: dict[str, None] = {}
        following: str | None = name
        while following is not None and following not in complete and following not in chain:
            chain[following] = None
            if problem := _problem(states, following):
                problems.append(problem)
                complete[following], following = None, None
            else:
                following = source_of(states[following])
        if following in chain:
            circle = [*chain][[*chain].index(following) :]
            problems.append(_circle([*circle, following], states[following]))
            complete |= dict.fromkeys(circle)
        for one in reversed(chain):
            source = source_of(states[one])
            if one not in complete:
                complete[one] = states[one] if source is None else _with_keys_of(complete.get(source), states[one])
    return {name: complete[name] for name in states if complete[name] is not None}, problems


def source_of(entry: object) -> str | None:
    """Return the name of the state whose keys a state of a file takes over, None if it says all itself."""
    given = (entry.get("grows"), entry.get("like")) if isinstance(entry, Mapping) else ()
    return next((name for name in given if isinstance(name, str)), None)


def _with_keys_of(source: object, entry: object) -> object:
    if not (isinstance(source, Mapping) and isinstance(entry, Mapping)):
        return None
    left_out = ("grows", "like", *(OF_ACTING_DAMAGE if entry.get("acts") is False else ()))
    taken = {key: value for key, value in source.items() if key not in left_out}
    return merged(taken, {key: value for key, value in entry.items() if key != "like"})


def _problem(states: Mapping[str, object], name: str) -> Problem | None:
    entry: Any = states[name] if isinstance(states[name], Mapping) else {}
    given = {key: entry[key] for key in ("grows", "like") if entry.get(key) is not None}
    if not given:
        return None
    (key, other), *more = given.items()
    path = f"states.{name[:200]}.{key}"
    if more:
        return Problem(path, f"'{other}' beside like: {more[0][1]}", "allowed: grows or like, one of them")
    if isinstance(other, str) and other in states and other != name:
        return None
    others = [one for one in states if one != name]
    known = f"{', '.join(one[:60] for one in others[:20])}{', ...' if len(others) > 20 else ''}"
    allowed = f"allowed: the name of another state: {known}{nearest_word(other, others)}"
    return Problem(path, "the state itself" if other == name else received_text(other), allowed)


def _circle(names: list[str], entry: object) -> Problem:
    key = "grows" if isinstance(entry, Mapping) and entry.get("grows") is not None else "like"
    shown = " from ".join(name[:60] for name in names[:8]) + (" from ..." if len(names) > 8 else "")
    return Problem(f"states.{names[0][:200]}.{key}", f"a circle: {shown}", "allowed: a chain that ends")
