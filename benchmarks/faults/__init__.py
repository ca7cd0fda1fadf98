"""Faults made on purpose, and what came of them: flipped bits, hostile files, shortages, kills; one digest of all ways.

Here `measured` is how many were found or refused, `alternative` what else happened, and the goal is all of them.
"""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from benchmarks.faults import digests, kills, shortages
from benchmarks.faults.bit_flips import SET_FILES, flipped_in_model, flipped_in_set
from benchmarks.faults.hostile_files import hostile_files, refusal
from benchmarks.faults.mutated_configurations import judged, mutated
from benchmarks.faults.mutated_recordings import FS_HZ, channels, mutated_recordings, recordings
from benchmarks.faults.recorder_files import recorder_files
from benchmarks.faults.victims import small_model, small_set
from benchmarks.row import Row, duration_text

FLIPS_PER_KIND = 40
CONFIGURATIONS = 2_000
RECORDINGS = 1_000
COMMAND_S = 2.0
COMMAND_BYTES = 500e6


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield one row per kind of fault: repetitions, outcome, whether every one was met with words."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        yield _mutated_row(200 if quick else CONFIGURATIONS, folder)
        for whole in (recordings(folder), recorder_files(folder, channels(), FS_HZ)):
            yield _recordings_row(45 if quick else RECORDINGS, whole)
        yield from (_hostile_row(what, file) for what, file in hostile_files(folder).items())
        victim = small_set(folder / "set")
        flips = 10 if quick else FLIPS_PER_KIND
        for kind in SET_FILES:
            yield _flips_row(kind, Counter(flipped_in_set(victim, kind, flips)))
        yield _flips_row("model folder", Counter(flipped_in_model(small_model(victim, folder / "model"), flips)))
    for part in (digests, shortages, kills):
        yield from part.rows(quick=quick)


def _flips_row(kind: str, outcomes: Counter[str]) -> Row:
    count, found = outcomes.total(), outcomes["refused in words"]
    others = ", ".join(f"{outcome}: {number}" for outcome, number in outcomes.items() if outcome != "refused in words")
    return Row(
        f"{count} flipped bits, {kind}",
        f"{found} found by the reader",
        others or "no other",
        None,
        "all",
        found == count,
    )


def _mutated_row(count: int, folder: Path) -> Row:
    cases = [judged(text, folder) for text in mutated(count)]
    outcomes = Counter(case.outcome for case in cases)
    longest = duration_text(max(case.seconds for case in cases))
    ended = outcomes["accepted"] + outcomes["refused"]
    measured = f"{outcomes['refused']} refused in words, {outcomes['accepted']} accepted, longest {longest}"
    others = f"tracebacks: {outcomes['traceback']}, hangs: {outcomes['hang']}"
    return Row(f"{count} mutated configurations", measured, others, None, "no other", ended == count)


def _recordings_row(count: int, whole: Sequence[Path]) -> Row:
    kinds = ", ".join(dict.fromkeys(path.suffix for path in whole))
    outcomes = Counter(case.outcome for case in mutated_recordings(count, whole))
    measured = f"{outcomes['refused']} refused in words, {outcomes['accepted']} with indicators"
    others = f"tracebacks: {outcomes['traceback']}, hangs: {outcomes['hang']}"
    met = outcomes["accepted"] + outcomes["refused"] == count
    return Row(f"{count} mutated recordings ({kinds})", measured, others, None, "no other", met)


def _hostile_row(what: str, file: Path) -> Row:
    found = refusal(file)
    measured = f"exit code {found.exit_code}, {duration_text(found.seconds)} of CPU, {found.peak_bytes / 1e6:.0f} MB"
    met = found.exit_code == 2 and found.seconds <= COMMAND_S and found.peak_bytes <= COMMAND_BYTES and found.in_words
    return Row(f"siggen plan, {what}", measured, found.message[:60], None, "2, <= 2 s, <= 500 MB", met)
