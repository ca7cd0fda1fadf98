"""Making a benchmark: the part to learn from, test parts simulated in secret and written blind, labels sealed.

What nobody may know stands in a folder beside the benchmark: the secret, the simulated sets, the sealed labels. Seeds,
numbers, order and salt follow from the secret, so the same call goes on where it was stopped.

Rows of a test part stand without what tells a state, decided by the roles of columns. Signals, pulses and conditions
stay. Numbers of records and gearboxes are drawn anew. What follows from the damage, what was drawn for the record and
what can be computed from the signal do not go along. Which records are shown, told or asked about follows from what the
benchmark asks. The hash of the sealed labels is published first, the labels themselves later.
"""

from __future__ import annotations

import json
import math
import secrets
import shutil
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

import siggen
from diagnostics.base.beside import beside
from diagnostics.base.extras import require_packages
from diagnostics.bench.question import (
    ALONE,
    CONDITIONS,
    LIFE_QUESTION,
    TEMPLATES,
    PublishedRecords,
    Question,
    derived,
    is_alone,
    question_of,
    shuffled,
)
from diagnostics.page.sentences import filled
from diagnostics.records.state_classes import HEALTHY
from diagnostics.scoring.benchmark import (
    COMMITMENT,
    FACTS,
    LEARN,
    PER_PART,
    REVEALED,
    SEALED,
    SECRET,
    TESTS,
    Benchmark,
    benchmark_facts,
    labels_of,
    open_benchmark,
)
from siggen.dataset.reading import Dataset, as_record
from siggen.dataset.reading import open as open_set
from siggen.errors import DatasetError, UsageError, counted
from siggen.file_writing import write_file
from siggen.keys.column import Role
from siggen.plain_json import json_text


@dataclass(frozen=True, slots=True)
class Tier:
    """How many gearboxes to learn from, and in each test part."""

    learn: int
    test: int


TIERS: Mapping[str, Tier] = {"tiny": Tier(12, 6), "small": Tier(60, 24), "full": Tier(300, 180)}


FEWEST_BYTES = 32


def read_secret(file: Path) -> bytes:
    """Return the secret of a file; one that is not there is made, readable by its owner alone.

    Raises
    ------
    UsageError
        If it is shorter than 32 bytes, which could be guessed.
    """
    if not file.exists():
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_file(file, _draw)
    secret = file.read_bytes().strip()
    if len(secret) < FEWEST_BYTES:
        raise UsageError(
            f"{file}: received a secret of {len(secret)} bytes; allowed: {FEWEST_BYTES} or more, drawn at random; "
            "remove the file and one is drawn"
        )
    return secret


def _draw(draft: Path) -> None:
    draft.touch(mode=0o600)
    draft.write_text(secrets.token_hex(FEWEST_BYTES) + "\n", encoding="ascii")


def seed_of(secret: bytes, part: str) -> int:
    """Return the seed of a part, 128 bits: more than can be tried until a draw fits what is published."""
    return int.from_bytes(derived(secret, "seed", part)[:16], "big")


def changed(config: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration with what a condition changes; sections stay but for the keys named, states are others."""
    named = {name: value if name == "states" else _merged(config.get(name), value) for name, value in changes.items()}
    return {**config, **named}


def _merged(section: Any, value: Any) -> Any:
    """Return a section with the keys of a mapping, or the value itself; a section of another kind is a value."""
    if not isinstance(value, Mapping) or not isinstance(section, Mapping) or "kind" in value:
        return value
    return {**section, **{name: _merged(section.get(name), inner) for name, inner in value.items()}}


@dataclass(frozen=True, slots=True)
class Renumbered:
    """New numbers of the published records of a part.

    Attributes
    ----------
    record, gearbox : mapping of int to int
        Number in the simulated set -> number in the part.
    shown : PublishedRecords
    """

    record: Mapping[int, int]
    gearbox: Mapping[int, int]
    shown: PublishedRecords

    def split(self, record: int) -> str:
        """Return the split of a record, by its number in the simulated set."""
        return "test" if record in self.shown.asked else "train"


KEYS = ("record_id", "specimen_id", "split", "inspection")
SEEN = {"inspections": ("age_h", "age_rev"), "debris": ("debris_mg",), "pictures": ("gear", "tooth", "png")}
"""Tables of `life/` and their columns that a model may see; all else is truth."""
SEALED_TABLES = ("inspections", "outlook")


def life_tables(dataset: Dataset, numbers: Renumbered) -> tuple[dict[str, pa.Table], dict[str, pa.Table]]:
    """Return the tables of `life/` to publish, and those to seal; of inspections that are shown alone."""
    first = _first_records(dataset, numbers)
    whole = {name: _shown_rows(dataset.life(name), first, numbers) for name in dict.fromkeys((*SEEN, *SEALED_TABLES))}
    seen = {name: whole[name].select([*KEYS, *columns]) for name, columns in SEEN.items()}
    return seen, {name: whole[name] for name in SEALED_TABLES}


def _first_records(dataset: Dataset, numbers: Renumbered) -> dict[tuple[int, int], int]:
    """Return the first published record of every gearbox and inspection, by its number in the simulated set."""
    first: dict[tuple[int, int], int] = {}
    for row in dataset.labels(columns=["record_id", "specimen_id", "state_id"]).to_pylist():
        if row["record_id"] in numbers.record:
            key = row["specimen_id"], row["state_id"]
            first[key] = min(first.get(key, row["record_id"]), row["record_id"])
    return first


def _shown_rows(table: pa.Table, first: Mapping[tuple[int, int], int], numbers: Renumbered) -> pa.Table:
    rows = sorted(_renumbered_rows(table, first, numbers), key=lambda row: int(row["record_id"]))
    return pa.Table.from_pylist(rows, schema=table.schema)


def _renumbered_rows(
    table: pa.Table, first: Mapping[tuple[int, int], int], numbers: Renumbered
) -> Iterator[dict[str, Any]]:
    for row in table.to_pylist():
        record = first.get((row["specimen_id"], row["inspection"]))
        if record is not None:
            numbered = {"record_id": numbers.record[record], "specimen_id": numbers.gearbox[row["specimen_id"]]}
            yield {**row, **numbered, "split": numbers.split(record)}


UNKNOWN = "unknown"
TEXTS = ("state", "fault", "severity")
NUMBERS = ("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm", "mesh_stiffness_loss")
"""Columns that every reader of sets expects; of a test record they say nothing."""
GIVEN = ("operating_point_id", "speed_hz", "torque_nm")
"""Conditions that every set has."""
TEETH = "teeth_"
DIGITS = 4
"""To which conditions of test parts are rounded: a whole double would tell a guessed seed from all wrong ones."""


@dataclass(frozen=True, slots=True)
class SimulatedPart:
    """What was simulated for a test part: a whole set, or the records alone that are published.

    Attributes
    ----------
    labels, damage : pyarrow.Table
        As of `siggen.open`.
    batches : iterable of pyarrow.RecordBatch
        Rows with signals.
    signals : list of str
        Columns of the channels.
    """

    labels: pa.Table
    damage: pa.Table
    batches: Iterable[pa.RecordBatch]
    signals: list[str]


def renumbered(part: SimulatedPart, shown: PublishedRecords, secret: bytes, name: str, place: int) -> Renumbered:
    """Return new numbers in an order that only the secret tells, those that are asked about last.

    Parameters
    ----------
    part : SimulatedPart
    shown : PublishedRecords
        Which of its records are published.
    secret : bytes
    name : str
        Of the part.
    place : int
        Of the part, from 0.
    """
    first = (place + 1) * PER_PART
    specimens = set(part.labels.column("specimen_id").to_pylist())
    ordered = shuffled(secret, f"records/{name}", shown.state_id)
    ordered.sort(key=lambda record: record in shown.asked)  # stable: both kinds stay in their order
    gearboxes = shuffled(secret, f"gearboxes/{name}", specimens)
    return Renumbered(
        {old: first + new for new, old in enumerate(ordered)},
        {old: first + new for new, old in enumerate(gearboxes)},
        shown,
    )


def condition_fields(labels: pa.Table) -> pa.Schema:
    """Return the columns that are conditions, beside those of every set."""
    kept = _of_role(labels.schema, Role.CONDITION)
    return pa.schema([field for field in kept if field.name not in GIVEN and not field.name.startswith(TEETH)])


def _of_role(schema: pa.Schema, role: Role) -> list[pa.Field]:
    return [field for field in schema if (field.metadata or {}).get(b"role") == role.value.encode()]


def blind_rows(part: SimulatedPart, numbers: Renumbered) -> list[dict[str, Any]]:
    """Return the rows of a part by their new numbers, with signals."""
    rows = []
    kept = [*GIVEN, *condition_fields(part.labels).names]
    kept += [name for name in part.labels.column_names if name.startswith(TEETH)]
    for batch in part.batches:
        for place, record in enumerate(batch.column("record_id").to_pylist()):
            if record in numbers.record:
                row = as_record(batch.slice(place, 1))
                rows.append(_blind(row, numbers, kept, part.signals))
    return sorted(rows, key=lambda row: int(row["record_id"]))


def _blind(row: dict[str, Any], numbers: Renumbered, kept: list[str], signals: list[str]) -> dict[str, Any]:
    told = row["record_id"] in numbers.shown.told
    return {
        **{name: _rounded(row[name]) for name in kept},
        "record_id": numbers.record[row["record_id"]],
        "specimen_id": numbers.gearbox[row["specimen_id"]],
        "state_id": numbers.shown.state_id[row["record_id"]],
        "repeat": 0,
        "split": numbers.split(row["record_id"]),
        **dict.fromkeys(TEXTS, HEALTHY if told else UNKNOWN),
        "faulty_gear": "none" if told else UNKNOWN,
        **dict.fromkeys(NUMBERS, 0.0 if told else math.nan),
        "signals": tuple(row[name].copy() for name in signals),
        "tacho_s": row["tacho_s"],
    }


def _rounded(value: Any) -> Any:
    """Return a number with four digits; anything else as it is, of a list each."""
    if isinstance(value, list | tuple):
        return [_rounded(element) for element in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def sealed_part(part: SimulatedPart, numbers: Renumbered, life: Mapping[str, pa.Table]) -> dict[str, Any]:
    """Return labels, damaged teeth and tables of `life/` of a part, columns by name, ascending by new numbers."""
    targets = [field.name for field in _of_role(part.labels.schema, Role.TARGET)]
    labels = part.labels.select(["record_id", "state_id", *targets]).to_pylist()
    labels = _published([{**row, "simulated_record_id": row["record_id"]} for row in labels], numbers)
    damage = _published(part.damage.select(["record_id", "gear", "tooth"]).to_pylist(), numbers)
    return {
        "labels": _columns(labels),
        "damage": _columns(damage) or {"record_id": [], "gear": [], "tooth": []},
        **({"life": {name: table.to_pydict() for name, table in life.items()}} if life else {}),
    }


def _published(rows: list[dict[str, Any]], numbers: Renumbered) -> list[dict[str, Any]]:
    """Return the rows of published records by their new numbers."""
    known = numbers.record
    return [{**row, "record_id": known[row["record_id"]]} for row in rows if row["record_id"] in known]


def _columns(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    rows.sort(key=lambda row: int(row["record_id"]))
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else ())}


CLOSING, LICENCE = "## Licence, authors, citation\n", "license: "
"""What the part to learn from says where it is ready to be published."""


def benchmark_card(facts: Mapping[str, Any], design: Any, card: str, question: Question) -> str:
    """Return the card of the whole benchmark; licence, authors and citation are those of the card to learn from."""
    return filled(
        TEMPLATES / "benchmark_card.md",
        facts=facts,
        design=design,
        question=question,
        learn=LEARN,
        tests=TESTS,
        is_alone=is_alone,
        licence=next((line for line in card.splitlines() if line.startswith(LICENCE)), ""),
        closing="".join(card.partition(CLOSING)[1:]),
    )


def commit_benchmark(folder: str | Path, labels: str | Path | None = None) -> str:
    """Write the SHA-256 of labels, salt, seeds and configurations, and return it: publish it first.

    Raises
    ------
    UsageError
        If the labels are of another benchmark, or others were committed to.
    """
    benchmark = open_benchmark(folder)
    commitment = labels_of(benchmark, Path(labels) if labels else None).commitment
    content = {"sha256": commitment, "digest": benchmark.digest, "of": REVEALED}
    write_file(benchmark.path / COMMITMENT, json_text(content))
    return commitment


def reveal_benchmark(folder: str | Path, labels: str | Path | None = None) -> Path:
    """Write labels, salt, seeds and configurations of the test parts; return the file.

    Raises
    ------
    UsageError
        If nothing was committed to, or other labels.
    """
    benchmark = open_benchmark(folder)
    if benchmark.commitment() is None:
        raise UsageError(f"{benchmark.path}: nothing was committed to; call `diagnostics.commit_benchmark` first")
    sealed, target = labels_of(benchmark, Path(labels) if labels else None), benchmark.path / REVEALED
    if not target.exists() or not target.samefile(sealed.file):
        write_file(target, sealed.file.read_bytes())
    return target


LEARNT = str(Path(__file__).with_name("siggen_bench.yaml"))
"""The part of siggen-bench to learn from."""
RECORD_S, START_S = 0.21, 0.9
"""Seconds of CPU for a second of signal, and seconds of signal that cost as much as a start: `full` took 0.5 s a record
of 1.5 s on one core of a server (November 2026)."""
BY_ITSELF = 2.0
"""Records that one costs whose gearbox has no other: 1.0 s of CPU beside 0.5 s (three of `full`, November 2026)."""

SECRET_FILE, SIMULATED, CARD = "secret", "simulated", "README.md"


def make_benchmark(
    folder: str | Path,
    tier: str = "tiny",
    *,
    config: Any = None,
    overrides: Sequence[str] = (),
    secret: str | Path | None = None,
    facts: str | Path | None = None,
    workers: int | None = None,
) -> Benchmark:
    """Make a part to learn from and test parts without labels, whose seeds nobody knows; or go on with them.

    What the tiers of siggen-bench cost is printed first.

    Parameters
    ----------
    folder : path
        New; publish it.
    tier : str
        `tiny`, `small` or `full`: how many gearboxes.
    config : path or mapping, optional
        To learn from, that of siggen-bench unless told; one of lives asks how long they last.
    overrides : sequence of str
        `PATH=VALUE`, in all parts.
    secret : path, optional
        Folder for the secret, the simulated test sets and sealed.json, FOLDER_secret unless told. Never publish it.
    facts : path, optional
        Licence, authors and citation, as `siggen publish` takes them.
    workers : int, optional
        Processes, one per core unless told.

    Raises
    ------
    UsageError
        If the tier is unknown, or one folder lies in the other.
    ConfigError, DatasetError
        As of `siggen.generate`.
    """
    if tier not in TIERS:
        raise UsageError(f"tier: received {tier!r}; allowed are {', '.join(TIERS)}")
    out, publication = Path(folder), Path(facts) if facts else None
    hidden = Path(secret) if secret else beside(out, SECRET)
    size = TIERS[tier]
    learn = siggen.load_config(config or LEARNT, [*overrides, f"specimens={size.learn}"])
    if config is None:
        sys.stderr.write(f"{cost_sentence(learn)}\n")
    return write_benchmark(
        out, hidden, read_secret(hidden / SECRET_FILE), learn, tier, size.test, facts=publication, workers=workers
    )


def cost_sentence(learn: Any) -> str:
    """Return what each tier costs with a configuration to learn from, in minutes of CPU."""
    parts, repeats = question_of(learn.canonical()).parts(CONDITIONS), learn.records_per_specimen // learn.state_count
    a_record_s, said = RECORD_S * (START_S + learn.duration_s), []
    of_whole = [len(part.get("states", range(learn.state_count))) for name, part in parts.items() if not is_alone(name)]
    for tier, size in TIERS.items():
        by_itself = size.test * (len(parts) - len(of_whole))
        others = repeats * (size.learn * learn.state_count + size.test * sum(of_whole))
        minutes = a_record_s * (others + BY_ITSELF * by_itself) / 60
        said.append(f"{tier} {counted(others + by_itself, 'record')}, {minutes:.0f} min")
    return f"CPU time to simulate: {', '.join(said)}"


def write_benchmark(
    out: Path,
    hidden: Path,
    secret: bytes,
    learn: Any,
    tier: str,
    gearboxes: int,
    *,
    conditions: Mapping[str, Mapping[str, Any]] | None = None,
    facts: Path | None = None,
    workers: int | None = None,
) -> Benchmark:
    """Make a benchmark, or go on with one.

    Parameters
    ----------
    out : Path
        What may be published.
    hidden : Path
        What may not.
    secret : bytes
    learn : SetDesign
        Of the part to learn from.
    tier : str
        What it is called.
    gearboxes : int
        Of each test part.
    conditions : mapping, optional
        What differs in each test part; those of the question unless told.
    facts : Path, optional
        Licence, authors, citation, as `siggen publish` takes them: the part to learn from is then a published set.
    workers : int, optional
        As of `siggen.generate`.

    Raises
    ------
    UsageError
        If one folder lies in the other, or Jinja2 is missing.
    ConfigError, DatasetError
        As of `siggen.generate`.
    """
    if out.resolve().is_relative_to(hidden.resolve()) or hidden.resolve().is_relative_to(out.resolve()):
        raise UsageError(f"{hidden}: what is secret may not lie in {out}, nor that in it; name another folder")
    require_packages("the card of a benchmark", "jinja2")
    secret = derived(secret, tier, learn.identity)  # what one benchmark reveals tells nothing of another
    question = question_of(learn.canonical())
    conditions = question.parts(conditions or question.conditions)
    tests = {name: _test_config(learn, name, conditions[name], gearboxes, secret) for name in conditions}
    _write_learn(learn, out / LEARN, hidden, facts, workers)
    parts, states = {}, dict[str, dict[int, tuple[str, str]]]()
    for place, (name, config) in enumerate(tests.items()):
        if is_alone(name):
            part, shown = _chosen(config, states[name.removesuffix(ALONE)], question, secret, name, workers)
        else:
            dataset = _simulated(config, hidden / SIMULATED / name, workers)
            signals = [channel.column for channel in dataset.channels]
            part = SimulatedPart(dataset.labels(), dataset.damage(), dataset.records(batch_rows=16), signals)
            rows = part.labels.to_pylist()
            states[name] = {row["state_id"]: (row["state"], row["fault"]) for row in rows}
            shown = question.shown(rows, secret, name)
        numbers = renumbered(part, shown, secret, name, place)
        seen, kept = life_tables(dataset, numbers) if question is LIFE_QUESTION else ({}, {})
        parts[name] = sealed_part(part, numbers, kept)
        _write_blind(part, numbers, (learn, config), out / TESTS / name, question, seen)
    told = benchmark_facts(out, question.title, tier, tuple(tests))
    sealed = {
        "salt": derived(secret, "salt").hex(),
        **{name: told[name] for name in ("title", "tier", "digest", "simulation_version")},
        "configurations": {name: config.canonical() for name, config in tests.items()},
        "parts": parts,
    }
    write_file(hidden / SEALED, json.dumps(sealed, sort_keys=True, allow_nan=False) + "\n")
    card = (out / LEARN / CARD).read_text(encoding="utf-8")
    write_file(out / CARD, benchmark_card(told, learn, card, question))
    write_file(out / FACTS, json_text(told))
    return open_benchmark(out)


def _test_config(learn: Any, name: str, changes: Mapping[str, Any], gearboxes: int, secret: bytes) -> Any:
    """Return the configuration of a test part; its seed follows from the secret."""
    config = changed(learn.canonical(), changes)
    config |= {"name": f"{learn.name}_{name}", "seed": seed_of(secret, name), "specimens": gearboxes}
    return siggen.load_config(config)


def _write_learn(config: Any, folder: Path, hidden: Path, facts: Path | None, workers: int | None) -> None:
    """Write the part to learn from, with authors' facts as a set that is ready to be published."""
    if facts is None:
        _simulated(config, folder, workers)
        return
    _simulated(config, hidden / SIMULATED / LEARN, workers)
    if not (folder / "manifest.json").is_file():
        shutil.rmtree(folder, ignore_errors=True)
        siggen.publish(hidden / SIMULATED / LEARN, folder, facts)


def _simulated(config: Any, folder: Path, workers: int | None) -> Dataset:
    """Return a set that is simulated, or was."""
    siggen.generate(config, folder, workers)
    return open_set(folder)


def _chosen(
    config: Any,
    states: Mapping[int, tuple[str, str]],
    question: Question,
    secret: bytes,
    name: str,
    workers: int | None,
) -> tuple[SimulatedPart, PublishedRecords]:
    """Return the records of a part that are published, and which they are; in place of one that fails the next one.

    `states` are name and fault of each, which are those of the part beside it.
    """
    rows = [
        {
            "record_id": record.record_id,
            "specimen_id": record.specimen_id,
            "state_id": record.state_id,
            **dict(zip(("state", "fault"), states[record.state_id], strict=True)),
        }
        for record in siggen.plan(config)
        if record.state_id in states
    ]
    while True:
        published = question.shown(rows, secret, name)
        simulated = siggen.simulate_records(config, sorted(published.state_id), workers)
        if not simulated.failures:
            break
        lost = {failure.record_id for failure in simulated.failures}
        rows = [row for row in rows if row["record_id"] not in lost]
    signals = [channel.column for channel in simulated.channels]
    return SimulatedPart(simulated.labels, simulated.damage, simulated.rows.to_batches(), signals), published


def _write_blind(
    part: SimulatedPart,
    numbers: Renumbered,
    configs: tuple[Any, Any],
    folder: Path,
    question: Question,
    life: Mapping[str, pa.Table],
) -> None:
    """Write a test part, unless it is there; `configs` are that to learn from and that of the part.

    Raises
    ------
    DatasetError
        If another one is there: labels would be those of other records.
    """
    rows = blind_rows(part, numbers)
    if (folder / "manifest.json").is_file():
        if not _holds(open_set(folder), rows[0], part.signals[0]):
            raise DatasetError(f"{folder}: was made with another secret or configuration; name a new folder")
        return
    shutil.rmtree(folder, ignore_errors=True)  # what a call that was stopped had half written
    learn, test = configs
    facts = {"benchmark": question.title, "part": folder.name}
    template = TEMPLATES / f"{question.words}_part.md"
    card = filled(template, title=question.title, part=folder.name, rows=rows, is_alone=is_alone)
    siggen.write_recorded_set(learn, folder, rows, condition_fields(part.labels), facts, card, measured=test, life=life)


def _holds(published: Dataset, row: Mapping[str, Any], column: str) -> bool:
    """Return whether a part holds the first signal of a row."""
    try:
        return np.array_equal(published.record(row["record_id"])[column], row["signals"][0])
    except (UsageError, KeyError):  # it has no such record, or channel
        return False
