"""A full disk, too little memory, a store that is gone, torn files: the run gives up in words, the next one goes on.

Each time the set is finished by the same command once the lack is mended, and all its bytes are compared with those of
an undisturbed one.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from random import Random

from benchmarks.row import Row
from siggen.dataset.storage import LocalFolder
from siggen.dataset.storage_at import storage_at
from tests.faults.kills import start, undisturbed
from tests.faults.moto_store import moto_store
from tests.faults.set_files import set_files, whole_set_problems

REPETITIONS = 10
MEMORY_MB = (600, 1_100)
"""Of address space: from what the libraries are hardly loaded with, to more than a worker needs."""
GAVE_UP, WENT_ON, RAW, CHANGED = "gave up in words", "went on", "no words", "other bytes"


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row per lack: repetitions, what came of them."""
    count = 2 if quick else REPETITIONS
    with tempfile.TemporaryDirectory(prefix="lack", dir="/tmp") as name:
        folder = Path(name)
        reference, horizon_s = undisturbed(folder / "reference")
        lacks: dict[str, Callable[[Random, Path], list[str]]] = {
            "full disk (tmpfs)": lambda chance, place: full_disk(chance, place, reference),
            "low memory (address space)": lambda chance, place: low_memory(chance, place, reference),
            "torn file of a stopped run": lambda chance, place: torn_file(
                chance, place, folder / "reference", reference
            ),
            "lost connection to the store (S3)": lambda chance, place: lost_store(chance, place, reference, horizon_s),
        }
        for what, lack in lacks.items():
            chance, outcomes = Random(what), Counter[str]()
            for number in range(count):
                outcomes.update(lack(chance, folder / f"{number}"))
                shutil.rmtree(folder / f"{number}", ignore_errors=True)
            yield _row(what, count, outcomes)


def _row(what: str, count: int, outcomes: Counter[str]) -> Row:
    bad = outcomes.total() - outcomes[GAVE_UP] - outcomes[WENT_ON]
    same = "all finished with the bytes of an undisturbed set"
    measured = f"{outcomes[GAVE_UP]} {GAVE_UP}, {outcomes[WENT_ON]} {WENT_ON}; {same}"
    if bad:
        measured = ", ".join(f"{number} {outcome}" for outcome, number in outcomes.items())
    return Row(f"{count} times, {what}", measured, "", None, "no other", not bad)


def full_disk(chance: Random, place: Path, reference: Mapping[str, bytes]) -> list[str]:
    """Make the set on a file system that holds less than all of it, then enlarge that."""
    whole = sum(len(content) for content in reference.values())
    place.mkdir()
    kib = chance.randrange(whole // 5 >> 10, whole >> 10)
    if not _mounted(f"size={kib}k", place):
        return ["not tried"]
    try:
        outcome = _outcome(["generate", str(place / "set"), "--executor", "serial"])
        return [outcome, *_finished(place / "set", reference, lambda: _mounted("remount,size=100m", place))]
    finally:
        subprocess.run(["umount", str(place)], check=False)


def low_memory(chance: Random, place: Path, reference: Mapping[str, bytes]) -> list[str]:
    """Make the set with little address space for driver and workers, then with enough."""
    memory = str(chance.randrange(*MEMORY_MB))
    return [_outcome(["generate", str(place), "--memory-mb", memory]), *_finished(place, reference)]


def torn_file(chance: Random, place: Path, whole: Path, reference: Mapping[str, bytes]) -> list[str]:
    """Cut one file of a set without manifest short, or fill its end with zeros, as a crash of the machine may."""
    shutil.copytree(whole, place)
    (place / "manifest.json").unlink()
    torn = place / chance.choice([name for name in reference if name.startswith(("data/", "internals/"))])
    content = torn.read_bytes()
    kept = chance.randrange(len(content))
    torn.write_bytes(content[:kept] + (bytes(len(content) - kept) if chance.random() < 0.5 else b""))
    return [_outcome(["generate", str(place), "--executor", "serial"]), *_finished(place, reference)]


def lost_store(chance: Random, place: Path, reference: Mapping[str, bytes], horizon_s: float) -> list[str]:
    """Stop the server at a random moment, for good or for seconds, and start it again with what it held."""
    address = f"s3://sets/{place.name}-{chance.randrange(10**9)}"
    with moto_store() as server, tempfile.TemporaryFile() as said:
        run = start(["generate", address, "--executor", "serial"], said)
        time.sleep(chance.uniform(0.2, 0.6) * horizon_s)
        server.stop()
        if chance.random() < 0.5:
            time.sleep(2.0)
            server.start()
        code = run.wait()
        server.start()
        said.seek(0)
        outcome = _judged(code, said.read().decode(errors="replace"))
        again = _outcome(["generate", address, "--executor", "serial"])
        same = set_files(storage_at(address)) == reference
    return [outcome, *([] if again == WENT_ON and same else [CHANGED])]


def _finished(place: Path, reference: Mapping[str, bytes], mend: Callable[[], object] = lambda: None) -> list[str]:
    """Finish the set once the lack is mended; return what is wrong with it."""
    mend()
    again = _outcome(["generate", str(place), "--executor", "serial"])
    wrong = whole_set_problems(place, set_files(LocalFolder(place)), reference)
    return [CHANGED] if wrong or again != WENT_ON else []


def _outcome(step: list[str]) -> str:
    with tempfile.TemporaryFile() as said:
        code = start(step, said).wait()
        said.seek(0)
        return _judged(code, said.read().decode(errors="replace"))


def _judged(code: int, text: str) -> str:
    if code == 0:
        return WENT_ON
    return GAVE_UP if code > 0 and text.strip() and "Traceback" not in text else f"{RAW}: {text.strip()[-200:]}"


def _mounted(options: str, place: Path) -> bool:
    """Mount or change a file system in memory; only the superuser may."""
    command = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(place)]
    return os.geteuid() == 0 and subprocess.run(command, check=False, capture_output=True).returncode == 0
