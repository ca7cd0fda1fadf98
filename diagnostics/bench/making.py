"""Making a benchmark: the part to learn from, test parts simulated in secret and written blind, labels sealed.

What nobody may know stands in a folder beside the benchmark: the secret, the simulated sets, the sealed labels. Seeds,
numbers, order and salt follow from the secret (`derived_secret`), so the same call goes on where it was stopped.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

import siggen
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.bench.blind_rows import blind_rows, condition_fields, renumbered, sealed_part
from diagnostics.bench.cards import benchmark_card
from diagnostics.bench.conditions import TIERS, Tier, changed
from diagnostics.bench.derived_secret import derived, seed_of
from diagnostics.bench.question import Question, Renumbered
from diagnostics.bench.questions import question_of
from diagnostics.scoring.benchmark import FACTS, LEARN, SEALED, TESTS, Benchmark, benchmark_facts, open_benchmark
from siggen.dataset.reading import Dataset
from siggen.dataset.reading import open as open_set
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import write_file

LEARNT = str(Path(__file__).with_name("siggen_bench.yaml"))
"""The part of siggen-bench to learn from."""
SECRET_FILE, SIMULATED, CARD = "secret", "simulated", "README.md"


@dataclass(frozen=True, slots=True)
class WantedBench:
    """What is to be made.

    Attributes
    ----------
    tier : str
    size : Tier
    config : str or mapping
        Configuration to learn from: a file, a preset or a mapping.
    overrides : tuple of str
        Such as `duration_s=0.5`, for all parts.
    conditions : mapping, optional
        What differs in each test part; those of the question unless told.
    facts : Path or None
        Licence, authors, citation, as `siggen publish` takes them: the part to learn from is then a published set.
    """

    tier: str = "tiny"
    size: Tier = TIERS["tiny"]
    config: str | Mapping[str, Any] = LEARNT
    overrides: tuple[str, ...] = ()
    conditions: Mapping[str, Mapping[str, Any]] | None = None
    facts: Path | None = None


def make_benchmark(
    out: Path, hidden: Path, secret: bytes, wanted: WantedBench, workers: int | None = None, stage: Stage = silent_stage
) -> Benchmark:
    """Make a benchmark, or go on with one.

    Parameters
    ----------
    out : Path
        What may be published.
    hidden : Path
        What may not.
    secret : bytes
    wanted : Wanted
    workers : int, optional
        As of `siggen.generate`.
    stage : Stage
        Told of every part.

    Raises
    ------
    UsageError
        If one folder lies in the other.
    ConfigError, DatasetError
        As of `siggen.generate`.
    """
    if out.resolve().is_relative_to(hidden.resolve()) or hidden.resolve().is_relative_to(out.resolve()):
        raise UsageError(f"{hidden}: what is secret may not lie in {out}, nor that in it; name another folder")
    learn = siggen.load_config(wanted.config, [*wanted.overrides, f"specimens={wanted.size.learn}"])
    secret = derived(secret, wanted.tier, learn.identity)  # what one benchmark reveals tells nothing of another
    question = question_of(learn.canonical())
    conditions = wanted.conditions or question.conditions
    tests = {name: _test_config(learn, name, conditions[name], wanted.size.test, secret) for name in conditions}
    _write_learn(learn, out / LEARN, hidden, wanted.facts, (workers, stage))
    parts = {}
    for place, (name, config) in enumerate(tests.items()):
        dataset = _simulated(config, hidden / SIMULATED / name, name, workers, stage)
        numbers = renumbered(dataset, question.shown(dataset, secret, name), secret, name, place)
        seen, kept = question.tables(dataset, numbers)
        parts[name] = sealed_part(dataset, numbers, kept)
        _write_blind(dataset, numbers, (learn, config), out / TESTS / name, question, seen)
    facts = benchmark_facts(out, question.title, wanted.tier, tuple(tests))
    sealed = {
        "salt": derived(secret, "salt").hex(),
        **{name: facts[name] for name in ("title", "tier", "digest", "simulation_version")},
        "configurations": {name: config.canonical() for name, config in tests.items()},
        "parts": parts,
    }
    write_file(hidden / SEALED, json.dumps(sealed, sort_keys=True, allow_nan=False) + "\n")
    own = (out / LEARN / CARD).read_text(encoding="utf-8")
    write_file(out / CARD, benchmark_card(facts, learn, own, question.words))
    write_file(out / FACTS, json.dumps(facts, indent=1) + "\n")
    return open_benchmark(out)


def _test_config(learn: Any, name: str, changes: Mapping[str, Any], gearboxes: int, secret: bytes) -> Any:
    """Return the configuration of a test part; its seed follows from the secret."""
    own = changed(learn.canonical(), changes)
    own |= {"name": f"{learn.name}_{name}", "seed": seed_of(secret, name), "specimens": gearboxes}
    return siggen.load_config(own)


def _write_learn(config: Any, folder: Path, hidden: Path, facts: Path | None, how: tuple[int | None, Stage]) -> None:
    """Write the part to learn from, with authors' facts as a set that is ready to be published."""
    if facts is None:
        _simulated(config, folder, LEARN, *how)
        return
    _simulated(config, hidden / SIMULATED / LEARN, LEARN, *how)
    if not (folder / "manifest.json").is_file():
        shutil.rmtree(folder, ignore_errors=True)
        siggen.publish(hidden / SIMULATED / LEARN, folder, facts)


def _simulated(config: Any, folder: Path, title: str, workers: int | None, stage: Stage) -> Dataset:
    """Return a set that is simulated, or was."""
    with stage(title, config.specimens * config.records_per_specimen) as advance:
        told = 0

        def progress(done: int, _total: int) -> None:
            nonlocal told
            for _ in range(done - told):
                advance()
            told = max(done, told)

        siggen.generate(config, folder, workers, progress)
    return open_set(folder)


def _signal(folder: Path, record: int, column: str) -> np.ndarray:
    """Return a signal of a record, empty where the set has none."""
    try:
        return np.asarray(open_set(folder).record(record)[column])
    except (UsageError, KeyError):  # it has no such record, or channel
        return np.empty(0)


def _write_blind(
    dataset: Dataset,
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
    if (folder / "manifest.json").is_file():
        old, new = next(iter(numbers.record.items()))
        column = dataset.channels[0].column
        if not np.array_equal(dataset.record(old)[column], _signal(folder, new, column)):
            raise DatasetError(f"{folder}: was made with another secret or configuration; name a new folder")
        return
    shutil.rmtree(folder, ignore_errors=True)  # what a call that was stopped had half written
    learn, own = configs
    rows, facts = blind_rows(dataset, numbers), {"benchmark": question.title, "part": folder.name}
    card = question.words.part(question.title, folder.name, rows)
    siggen.write_recorded_set(learn, folder, rows, condition_fields(dataset), facts, card, measured=own, life=life)
