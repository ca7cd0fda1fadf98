"""The damage of one mesh by state, drawn when a state asks for it.

A state holds the damage of the milder state that it grew from and adds its own up to the count that it names. A spall
that grows from a spall has the draws of the first one: its centre stays and its sizes keep their rank. What a grown
spall hides is no damage of its own any more. Nor is what lies wholly on metal that a chip took, before it or after it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from pydantic import TypeAdapter, ValidationError

from siggen.config import Config, StateSection
from siggen.damage.fault import Fault
from siggen.damage.flank_wear import LoadAtRest
from siggen.damage.growth import Growth
from siggen.damage.on_flank import takes_from_flanks, with_outlines
from siggen.damage.part import Part, Parts, goes_through
from siggen.damage.registry import DamageSections
from siggen.errors import ConfigError
from siggen.gears.gear_pair import GearPair
from siggen.keys.problems import section_problems
from siggen.names import EITHER, Names

LoadsAtRest: TypeAlias = Callable[[float], LoadAtRest]
"""Force of all pairs [N] -> how the teeth, without errors, share it."""


@dataclass(frozen=True, slots=True)
class MeshState:
    """What a state adds to one mesh, whose gears are called pinion and gear.

    Attributes
    ----------
    sections : kinds of damage with their laws
    older : number of the state that it grew from, which may add nothing here; None: of none
    sham : whether its damage is drawn with nothing removed
    """

    sections: tuple[Fault, ...]
    older: int | None
    sham: bool


def mesh_state(config: Config, mesh: str, state_id: int) -> MeshState:
    """Return a state of a gearbox as one of its meshes sees it; that of a pair and of a sun is called ''."""
    state = config.states[state_id]
    return MeshState(sections_on(state, mesh, config.names), config.grown_from(state_id), state.sham)


def sections_on(state: StateSection, mesh: str, names: Names) -> tuple[Fault, ...]:
    """Return the damage of a state on one mesh, whose gears are called pinion and gear."""
    return tuple(own for one in state.damages if (own := on_mesh(one, mesh, names)) is not None)


def on_mesh(damage: Fault, mesh: str, names: Names) -> Fault | None:
    """Return damage with gears called pinion and gear; None of another mesh. What is on no gear is on the first.

    None too where it names what is no gear, which is refused with its path elsewhere.
    """
    flanks = {"": ("", ""), **names.flanks}
    if damage.needs_bearings:
        seats = {word: seat for seat, word in names.bearings.items()}
        damage = damage.model_copy(update={"bearing": seats.get(damage.position, damage.position)})
    hit = [flanks.get(gear, (None, "")) for gear in damage.hit_gears]
    here = all(name == mesh and not (damage.one_flank and role == EITHER) for name, role in hit)
    return damage.with_gears(lambda gear: flanks[gear][1]) if here else None


def damage_sections(listed: Sequence[Mapping[str, object]]) -> tuple[Fault, ...]:
    """Return damage by the entries of a file.

    Raises
    ------
    ConfigError
        If they are wrong, with paths from `damages` on.
    """
    if not listed:
        return ()
    try:
        return tuple(TypeAdapter(DamageSections).validate_python(listed))  # type: ignore[arg-type]
    except ValidationError as error:
        problems = section_problems(StateSection, error.errors(include_url=False), ("damage",))
        raise ConfigError(
            [replace(one, path=f"damages{one.path.removeprefix('damage')}") for one in problems]
        ) from None


@dataclass(frozen=True, slots=True)
class MeshDamage:
    """The damage of a mesh whose draws have this seed and gearbox; each state is drawn once.

    `state_of`: number of a state -> what it adds.
    """

    seed: int
    specimen_id: int
    pair: GearPair
    state_of: Callable[[int], MeshState] = field(compare=False)
    _drawn: dict[int, Parts] = field(default_factory=dict, compare=False, repr=False)

    def __call__(self, state_id: int, loads: LoadsAtRest) -> Parts:
        """Return all parts in a state, those of the milder state first.

        Raises
        ------
        ValueError
            If a height in the configuration lies below the base circle of the drawn gear.
        """
        if state_id not in self._drawn:
            self._drawn[state_id] = self._grown(state_id, loads)
        return self._drawn[state_id]

    def _grown(self, state_id: int, loads: LoadsAtRest) -> Parts:
        state, milder = self.state_of(state_id), tuple(self._milder(state_id))
        parts: Parts = () if state.older is None else self(state.older, loads)
        growth = Growth(self.seed, self.specimen_id, state_id, self.pair, milder, parts, loads)
        for section in sorted(state.sections, key=_rank):  # whatever order they were written in
            parts = _united(parts, section.drawn(growth), self.pair)
        return tuple(one.sham() for one in parts) if state.sham else parts

    def _milder(self, state_id: int) -> Iterator[tuple[int, Fault]]:
        """Yield the states that a state has grown from with their sections of damage, the nearest first."""
        older = self.state_of(state_id).older
        while older is not None:
            state = self.state_of(older)
            yield from ((older, section) for section in state.sections)
            older = state.older


def _rank(section: Fault) -> str:
    return section.model_dump_json()


def _united(before: Parts, new: Parts, pair: GearPair) -> Parts:
    """Return old parts that nothing hides, and new ones on metal that is there still; orders of sections agree."""
    left = tuple(old for old in before if old in new or not any(_hides(one, old, pair) for one in new))
    gone = [old for old in left if any(goes_through(shown) for shown in with_outlines((old,), pair))]
    return (
        *left,
        *(one for one in new if one not in before and not any(_hides(lost, one, pair) for lost in gone)),
    )


def _hides(one: Part, other: Part, pair: GearPair) -> bool:
    """Return whether a part hides another one, by itself or by what shows of both on the flanks of a pair."""
    if one.hides(other):
        return True
    if not (takes_from_flanks(one) or takes_from_flanks(other)):
        return False
    below = with_outlines((other,), pair)
    return bool(below) and all(any(shown.hides(it) for shown in with_outlines((one,), pair)) for it in below)
