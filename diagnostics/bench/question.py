"""What a benchmark asks: conditions of its parts, which records they show, what cards say, by what entries are ranked.

Asked is whether a record shows damage; a part shows one healthy record of each gearbox as a reference, or of a part
that is judged alone a single record of each.

Of lives is asked how long a gearbox still runs, at the last of its inspections that a part shows. A whole history tells
its length. So each gearbox is shown up to an inspection that the secret draws, each of its inspections alike; what
comes later is not written. Only the last one shown is asked about: of those before everybody can see that the gearbox
ran on. Signals, debris, pictures, age and the number of the inspection go along. Gearboxes that were taken out are
asked about like all others, and are in no error.

Order and choice follow from the maker's secret by HMAC-SHA-256 over words: who knows one result learns nothing of
another one, or of the secret.
"""

from __future__ import annotations

import hashlib
import hmac
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring import detect, remaining_life
from diagnostics.scoring.detect import DETECT
from diagnostics.scoring.remaining_life import REMAINING_LIFE
from diagnostics.scoring.task import Measure, Task

TEMPLATES = Path(__file__).with_name("templates")

Conditions = Mapping[str, Mapping[str, Any]]
"""Name -> top-level keys of the configuration to learn from that differ."""

SPEED, TORQUE = [32.5, 37.0], [30.0, 60.0]
BOTH_HEALTHY: Mapping[str, Any] = {"healthy": {}, "healthy_again": {}}
MODERATE = {"severity": "moderate"}
SPALL = {
    "kind": "irregular",
    "gear": "pinion",
    "teeth": 1,
    "centre_height_mm": "below_pitch",
    "profile_length_mm": 0.3,
    "face_share": 1.0,
    "skew_mm_per_10mm": [-0.054, 0.054],
}
OTHER_FAULTS = {
    **BOTH_HEALTHY,
    "crack": {
        **MODERATE,
        "damage": {"kind": "crack", "gear": "pinion", "depth_share": [0.15, 0.35], "angle_deg": [45.0, 65.0]},
    },
    "chip": {**MODERATE, "damage": {"kind": "chip", "gear": "pinion", "height_mm": [0.3, 1.0]}},
    "wear": {**MODERATE, "damage": {"kind": "wear", "depth_um": [10.0, 30.0]}},
    "bearing": {**MODERATE, "damage": {"kind": "bearing_spall", "element": "outer", "length_mm": [1.0, 3.0]}},
    "sham": {"acts": False, "damage": SPALL},
}
"""Faults of `confusers` with the sizes that it has: none of them is learned from."""

TEETH = ((20, 51), (22, 45), (23, 37), (24, 61))
PAIRS = [{"teeth": list(teeth), "module_mm": 3.0, "face_width_mm": 20.0} for teeth in TEETH]
SHAFTS = {"shafts": {"driver": {"diameter_mm": [30.0, 38.0]}}}
"""Diameters for 18 teeth, which grow with the pair: 45 mm would not fit the root circles of all."""
CONDITIONS: Conditions = {
    "same": {},
    "other_speed": {"operating_points": [{"speed_hz": [25.0, 29.0], "torque_nm": TORQUE}]},
    "other_torque": {"operating_points": [{"speed_hz": SPEED, "torque_nm": [12.0, 20.0]}]},
    "new_pair": {"gears": {"pairs": PAIRS}, "dynamics": SHAFTS},
    "other_place": {"sensors": {"first": {"place": "wall"}, "second": {"place": "pinion_end"}}},
    "other_fault": {"states": OTHER_FAULTS},
}
"""Name -> top-level keys that differ."""
LIFE_CONDITIONS: Conditions = {"same": {}, "other_load": {"life": {"history": [[1.0, 1.05]]}}}
"""The same of lives; 5 % more torque wears 1.05^10 = 1.6 times as fast."""


ALONE = "_alone"
"""Ending of a part of which each gearbox has one record and no reference."""


def is_alone(part: str) -> bool:
    """Return whether records of a part are judged by themselves; asked records of one gearbox would tell each other."""
    return part.endswith(ALONE)


def parts_of(parts: Sequence[str], *, referenced: bool) -> tuple[str, ...]:
    """Return the test parts that a track asks, by whether it uses references; all where none is judged alone."""
    split = any(map(is_alone, parts))
    return tuple(name for name in parts if not split or is_alone(name) != referenced)


def with_alone(conditions: Conditions) -> dict[str, Mapping[str, Any]]:
    """Return conditions, and each again for gearboxes of which one record is shown."""
    return {**conditions, **{f"{name}{ALONE}": changes for name, changes in conditions.items()}}


def derived(secret: bytes, *words: object) -> bytes:
    """Return 32 bytes that follow from the secret and some words."""
    return hmac.new(secret, "/".join(map(str, words)).encode(), hashlib.sha256).digest()


def shuffled(secret: bytes, what: str, ids: Iterable[int]) -> list[int]:
    """Return ids in an order that only the secret tells."""
    return sorted(ids, key=lambda number: derived(secret, what, number))


@dataclass(frozen=True, slots=True)
class PublishedRecords:
    """Which records of a simulated part are published, by their number there.

    Attributes
    ----------
    state_id : mapping of int to int
        What is published as the state's number of each; other records are not published.
    told : frozenset of int
        Records that are told to be healthy.
    asked : frozenset of int
        Those of the split test.
    """

    state_id: Mapping[int, int]
    told: frozenset[int]
    asked: frozenset[int]


@dataclass(frozen=True, slots=True)
class Question:
    """What a benchmark asks.

    Attributes
    ----------
    title : str
    conditions : mapping
        Name of a condition -> what differs from the configuration to learn from.
    parts : callable
        Conditions; returns the same by test part.
    subject, train : str
        What cards say, and what the split train of a test part is called there.
    words : str
        How the names of the templates of rules and of a test part's card begin.
    shown : callable
        Rows of the records of a part, secret, name of the part; returns what is published.
    task : Task
        Entries are ranked by its first measure.
    records : str
        Which of the task's parts ranks.
    leak : str or None
        Which of them nobody should tell, so that its AUC holds 0.5; None where there is none.
    score_name, score_key : str
        What the score is called on the page, and in JSON.
    scores_are : str
        What the page says that scores are.
    tracks : mapping of bool to str
        Headings of the tables of entries, by whether they used a reference.
    """

    title: str
    conditions: Conditions
    parts: Callable[[Conditions], Conditions]
    subject: str
    train: str
    words: str
    shown: Callable[[list[dict[str, Any]], bytes, str], PublishedRecords]
    task: Task
    records: str
    leak: str | None
    score_name: str
    score_key: str
    scores_are: str
    tracks: Mapping[bool, str]

    @property
    def measure(self) -> Measure:
        """The measure that ranks."""
        return self.task.measures[0]


def damage_records(rows: list[dict[str, Any]], secret: bytes, name: str) -> PublishedRecords:
    """Return all records; one healthy one of every gearbox and operating point is told, drawn by lot.

    Of a part that is judged alone one record of every gearbox, and none is told.
    """
    if is_alone(name):
        chosen = frozenset(_one_of_each(rows, secret, name))
        return PublishedRecords(dict.fromkeys(chosen, 1), frozenset(), chosen)
    every = frozenset(row["record_id"] for row in rows)
    told = frozenset(_references(rows, secret, name))
    return PublishedRecords({record: int(record not in told) for record in every}, told, every - told)


def _one_of_each(rows: list[dict[str, Any]], secret: bytes, name: str) -> Iterator[int]:
    """Yield a record of every gearbox by lot: without and with damage in turn, and of each the states in turn."""
    sides: list[dict[int, list[str]]] = [{}, {}]
    known: dict[tuple[int, str], list[int]] = {}
    for row in rows:
        sides[row["fault"] != HEALTHY].setdefault(row["state_id"], []).append(row["state"])
        known.setdefault((row["specimen_id"], row["state"]), []).append(row["record_id"])
    states = [[side[state][0] for state in shuffled(secret, f"states/{name}", side)] for side in sides]
    for place, gearbox in enumerate(shuffled(secret, f"shown/{name}", {row["specimen_id"] for row in rows})):
        wanted = states[place % 2] or states[1 - place % 2]
        first = place // 2 % len(wanted)
        tried = (*wanted[first:], *wanted[:first], *states[1 - place % 2])  # of those that a gearbox lost the next
        held = next(known[gearbox, state] for state in tried if (gearbox, state) in known)
        yield shuffled(secret, f"records of {gearbox}/{name}", held)[0]


def _references(rows: list[dict[str, Any]], secret: bytes, name: str) -> Iterator[int]:
    """Yield a healthy record of every gearbox and operating point that has two of them, drawn by lot."""
    healthy: dict[tuple[int, int], list[int]] = {}
    for row in rows:
        if row["fault"] == HEALTHY and not row.get(SHAM, False):
            healthy.setdefault((row["specimen_id"], row["operating_point_id"]), []).append(row["record_id"])
    yield from (shuffled(secret, f"references/{name}", records)[0] for records in healthy.values() if len(records) > 1)


DAMAGE_QUESTION = Question(
    title="siggen-bench 1.0",
    conditions=CONDITIONS,
    parts=with_alone,
    subject="Damage of gears",
    words="damage",
    train="reference",
    shown=damage_records,
    task=DETECT,
    records=detect.EVERY,
    leak=detect.LEAK,
    score_name="AUC",
    score_key="auc",
    scores_are="AUC of damaged against healthy records of other gearboxes",
    tracks={False: "Alone", True: "Beside a healthy record of the same gearbox"},
)


def life_records(rows: list[dict[str, Any]], secret: bytes, name: str) -> PublishedRecords:
    """Return the records of every gearbox up to an inspection drawn from all that it has."""
    numbers: dict[int, set[int]] = {}
    for row in rows:
        numbers.setdefault(row["specimen_id"], set()).add(row["state_id"])
    last = {gearbox: _drawn(sorted(inspections), secret, name, gearbox) for gearbox, inspections in numbers.items()}
    state_id = {row["record_id"]: row["state_id"] for row in rows if row["state_id"] <= last[row["specimen_id"]]}
    asked = (row["record_id"] for row in rows if row["state_id"] == last[row["specimen_id"]])
    return PublishedRecords(state_id, frozenset(), frozenset(asked))


def _drawn(inspections: list[int], secret: bytes, name: str, gearbox: int) -> int:
    draw = int.from_bytes(derived(secret, "cut", name, gearbox)[:16], "big")  # 128 bits: as good as uniform
    return inspections[draw % len(inspections)]


LIFE_QUESTION = Question(
    title="siggen-bench 1.0, lives",
    conditions=LIFE_CONDITIONS,
    parts=dict,
    subject="Remaining life of gears",
    words="life",
    train="history",
    shown=life_records,
    task=REMAINING_LIFE,
    records=remaining_life.EVERY,
    leak=None,
    score_name="error [h]",
    score_key="error_h",
    scores_are="mean absolute errors of the remaining life at the last inspection shown, so less is better (gearboxes "
    "that were taken out are in none)",
    tracks={False: "Remaining life"},
)


def question_of(config: Mapping[str, Any]) -> Question:
    """Return what a benchmark with this configuration to learn from asks: of lives how long they last."""
    return DAMAGE_QUESTION if config.get("life") is None else LIFE_QUESTION
