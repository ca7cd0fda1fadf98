"""Sets that a stranger changed and sealed again: each reader has to read them or refuse in words, and touch no more.

The stranger knows where a file beside the set is, and everything in it: names, links and hashes lead there.
"""

from __future__ import annotations

import contextlib
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from random import Random

import yaml

import siggen
from benchmarks.row import Row, duration_text
from benchmarks.shipped import QUICKSTART, shipped
from siggen.errors import VerificationError
from siggen.gearbox.design import stored_design
from tests.faults.changed_sets import SECRET, change
from tests.faults.mutations import Case, judged

COUNT, QUICK_COUNT = 2_000, 40
SAID_EVERY = 50
OVERRIDES = ("specimens=6", "repeats=1", "duration_s=0.4", "internals={quantities: [mesh_force_n]}")
FACTS = {
    "license": "cc-by-4.0",
    "title": "A set",
    "version": "1.0.0",
    "published": "2026-11-30",
    "publisher": "Zenodo",
    "url": "https://example.org/set",
    "citation": "A set (2026).",
    "authors": [{"name": "Author, An"}],
}

Reader = Callable[[Path, Path], None]


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row per reader."""
    count = QUICK_COUNT if quick else COUNT
    with tempfile.TemporaryDirectory(prefix="foreign") as name:
        place = Path(name)
        siggen.generate(shipped(QUICKSTART, *OVERRIDES), place / "whole")
        yield from outcome_rows(place, place / "whole", readers(place / "whole"), count)


def outcome_rows(place: Path, whole: Path, asked: Mapping[str, Reader], count: int, seed: int = 0) -> Iterator[Row]:
    """Yield what each reader did with `count` changed copies of a set; raises if it does not take the whole one."""
    workshop = Workshop(place / "workshop", whole)
    found: dict[str, Counter[str]] = {name: Counter() for name in asked}
    longest = dict.fromkeys(asked, 0.0)
    for name, reader in asked.items():
        if (outcome := workshop.tried(lambda _folder: None, reader)).outcome != "accepted":
            raise RuntimeError(f"{name} does not take the unchanged set: {outcome.message}")
    for number in range(count):
        for name, reader in asked.items():
            outcome = workshop.tried(lambda folder, number=number: change(folder, Random(f"{seed} {number}")), reader)
            found[name][outcome.outcome] += 1
            longest[name] = max(longest[name], outcome.seconds)
            if outcome.outcome not in {"accepted", "refused"}:
                sys.stderr.write(f"{outcome.outcome}: change {number}, {name}: {outcome.message}\n")
        if (number + 1) % SAID_EVERY == 0:
            sys.stderr.write(f"{number + 1} of {count} changed sets\n")
    for name, outcomes in found.items():
        measured = f"{outcomes['refused']} refused in words, {outcomes['accepted']} taken"
        others = ", ".join(f"{what}: {outcomes[what]}" for what in ("traceback", "hang", "outside", "leaked"))
        met = outcomes["accepted"] + outcomes["refused"] == count
        longest_text = f"longest {duration_text(longest[name])} of CPU"
        yield Row(f"{count} changed sets, {name}", f"{measured}, {longest_text}", others, None, "no other", met)


def readers(whole: Path) -> dict[str, Reader]:
    """Return what reads a set of a stranger, by name; each receives the set and a path for what it writes.

    `generate` goes on in the stranger's folder with one's own configuration, that of the unchanged set; `extend` asks
    for one gearbox more.
    """
    content = (whole / "config.yaml").read_bytes()
    own = stored_design(content, "config.yaml")
    more = stored_design(content, "config.yaml", {"specimens": own.specimens + 1})
    return {
        "open": _open,
        "verify": _verify,
        "publish": _publish,
        "extend": lambda folder, _out: _done(siggen.generate(more, folder, executor="serial")),
        "generate": lambda folder, _out: _done(siggen.generate(own, folder, executor="serial")),
        "explore": _explore,
        "report": _report,
    }


def _done(_result: object) -> None:
    """Take a result that is not looked at."""


def _open(folder: Path, _out: Path) -> None:
    dataset = siggen.open(folder)
    _done((repr(dataset), dataset.labels().num_rows, dataset.damage().num_rows, dataset.shards()))
    for batch in dataset.records():
        dataset.record(batch["record_id"][0].as_py())
    if dataset.internal_columns:
        _done(list(dataset.internals()))


def _verify(folder: Path, _out: Path) -> None:
    from siggen.sets.verification import problem_lines, verify

    found = verify(folder, 0)
    if found.mismatches:
        raise VerificationError("; ".join(problem_lines(found)))


def _publish(folder: Path, out: Path) -> None:
    from siggen.publication.publish import publish

    facts = out.with_name("facts.yaml")
    publish(folder, out, facts)


def _explore(folder: Path, out: Path) -> None:
    from diagnostics.explore.set_page import LookOptions, write_set_page

    write_set_page(siggen.open(folder), out.with_suffix(".html"), LookOptions(limit=3))


def _report(folder: Path, _out: Path) -> None:
    """Read all that a report reads of a set; what follows are minutes of training on the table made here."""
    from diagnostics.base.progress import silent_stage
    from diagnostics.judging.sets import open_sets, set_table
    from diagnostics.report.report import clipping_notes

    dataset, _ = open_sets(folder, None, ())
    _done((set_table(dataset, silent_stage), clipping_notes(dataset)))


class Workshop:
    """A folder with a canary, in which copies of a set are changed and read."""

    def __init__(self, place: Path, whole: Path) -> None:
        self._place, self._whole = place, whole
        (place / "canary").mkdir(parents=True)
        (place / "canary" / "secret.txt").write_bytes(SECRET)
        (place / "facts.yaml").write_text(yaml.safe_dump(FACTS))
        self._around = self._files()

    def tried(self, changed: Callable[[Path], None], reader: Reader) -> Case:
        """Return what a reader does with a changed copy of the set; 'outside' and 'leaked' are outcomes, too."""
        folder, out = self._place / "set", self._place / "out"
        shutil.copytree(self._whole, folder)
        changed(folder)
        own = {path for path in folder.rglob("*") if path.is_symlink()}
        with contextlib.redirect_stdout(None):
            case = judged(str(folder), lambda: reader(folder, out))
        what, message = case.outcome, case.message
        written = [path for top in self._place.glob("*") for path in (top, *top.rglob("*")) if path not in own]
        if self._files() != self._around:
            what, message = "outside", "a file beside the set was changed"
        elif SECRET[:28] in message.encode(errors="replace") or any(self._holds_secret(path) for path in written):
            what, message = "leaked", "what lies beside the set was copied"
        shutil.rmtree(folder)
        for left in self._place.glob("out*"):
            shutil.rmtree(left) if left.is_dir() else left.unlink()
        shutil.rmtree(self._place / "set_table", ignore_errors=True)
        return replace(case, outcome=what, message=message)

    def _files(self) -> dict[str, bytes]:
        """Return what lies beside the set and what readers may write."""
        own = ("set", "set_table", "out", "out.html")
        found = (path for path in self._place.rglob("*") if path.relative_to(self._place).parts[0] not in own)
        return {str(path): path.read_bytes() if path.is_file() else b"" for path in found}

    def _holds_secret(self, path: Path) -> bool:
        return path.parent.name != "canary" and path.is_file() and SECRET in path.read_bytes()
