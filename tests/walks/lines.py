"""A line for every command that exists, and what the lines need: sets of tiny records, recordings, models, a benchmark.

In a line OUT is the folder for what is written, IN/NAME what is read and written into. What a line needs is made when
the first test asks for it.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Container, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pytest
import yaml
from _pytest.mark import ParameterSet
from scipy.io import wavfile

from diagnostics.scoring.benchmark import open_benchmark
from tests.diagnostics.bench.conftest import CONFIG, committed_benchmark
from tests.publication.conftest import FACTS
from tests.shared import shared_folder
from tests.walks.walking import FS_HZ, recorded, run

DESCRIBED = "--rig reading.yaml"


class Line(NamedTuple):
    """What follows a command's name.

    Attributes
    ----------
    words
        Options and arguments.
    code
        Exit code.
    writes
        False where all that it says is printed.
    """

    words: str
    code: int = 0
    writes: bool = True


LINES = {
    "siggen init": Line("--teeth 18,47 --module 3 --speed 33,36 --torque 30,45 --sensors 1 --out OUT/rig.yaml"),
    "siggen plan": Line("short.yaml --trial 1", writes=False),
    "siggen generate": Line("short.yaml --workers 1 --out OUT/new"),
    "siggen verify": Line("IN/short --sample 1 --physics 1"),
    "siggen publish": Line("short --to OUT/upload --facts publication.yaml"),
    "siggen show": Line("short --record 2 --png OUT/record.png --internals --out OUT/record.parquet"),
    "siggen inspect spectrum": Line("short.yaml --png OUT/spectrum.png"),
    "siggen inspect tvms": Line("short.yaml --out OUT/tvms.csv --png OUT/tvms.png"),
    "siggen inspect parts": Line("short.yaml --out OUT/parts.csv"),
    "siggen inspect housing": Line("quickstart --out OUT/housing.csv"),
    "siggen inspect flank": Line("short.yaml --out OUT/flank.csv --png OUT/flank.png"),
    "siggen inspect pressure": Line("quickstart --set duration_s=0.1 --out OUT/p.parquet --png OUT/p.png"),
    "siggen inspect errors": Line("quickstart --out OUT/errors.parquet --png OUT/errors.png"),
    "siggen inspect modes": Line("quickstart --out OUT/modes.csv --png OUT/modes.png"),
    "siggen inspect path": Line("quickstart --out OUT/path.csv --png OUT/path.png"),
    "siggen inspect life": Line("fleet --out OUT/gearbox.yaml"),
    "siggen-diagnostics audit": Line("set --out OUT/audit"),
    "siggen-diagnostics indicators": Line(f"may.wav {DESCRIBED} --out OUT/indicators"),
    "siggen-diagnostics report": Line("set --no-cnn --out OUT/report"),
    "siggen-diagnostics score": Line("committed entries/mine.csv --out OUT/scores.csv"),
    "siggen-diagnostics predict": Line(
        "models set/data/test-00000.parquet:1 --fs 12800 --teeth 18,47 --rig tacho.yaml --out OUT/prediction"
    ),
    "siggen-diagnostics baseline": Line(f"april.wav may.wav june.wav july.wav {DESCRIBED} --out OUT/machine"),
    "siggen-diagnostics check": Line("IN/machine august.wav", code=4),
    "siggen-diagnostics calibrate": Line(
        "rig.yaml april.wav may.wav june.wav july.wav --rig reading.yaml --gearboxes 2 --out OUT/mine.yaml",
    ),
    "siggen-diagnostics explore": Line(f"may.wav june.wav {DESCRIBED} --out OUT/look.html"),
}


def lines(names: Iterable[str], quick: Container[str]) -> list[ParameterSet]:
    """Return names of commands as parameters of a test; those that are not quick are marked slow."""
    return [pytest.param(name, marks=[] if name in quick else [pytest.mark.slow]) for name in names]


def lay(folder: Path, words: str, factory: pytest.TempPathFactory) -> None:
    """Copy into a folder what the words of a line name."""
    for name in {word.removeprefix("IN/").partition("/")[0] for word in words.split()} & {*MADE}:
        shutil.copytree(_made(name, factory), folder, dirs_exist_ok=True)


def _made(name: str, factory: pytest.TempPathFactory) -> Path:
    """Return the folder with a thing and what is secret of it."""

    def make(target: Path) -> None:
        place, how = factory.mktemp("made"), MADE[name]
        if isinstance(how, str):
            lay(place, how.partition(" --out ")[0], factory)
            done = run(place, how)
            assert done.returncode == 0, f"{how}\n{done.stderr}"
        else:
            how(place / name, factory)
        target.mkdir()
        for path in place.glob(f"{name}*"):
            if path.name in (name, f"{name}_secret"):
                path.rename(target / path.name)

    return shared_folder(factory, f"{name} of a line", make)


def _yaml(raw: dict[str, Any]) -> Callable[[Path, object], object]:
    return lambda file, _: file.write_text(yaml.safe_dump(raw, sort_keys=False))


def _recording(seed: int, depth: float = 0.0) -> Callable[[Path, object], object]:
    return lambda file, _: wavfile.write(file, round(FS_HZ), recorded(seed, depth).astype(np.float32))


def _committed(folder: Path, factory: pytest.TempPathFactory) -> None:
    source = committed_benchmark(factory)
    shutil.copytree(source / "bench", folder)
    shutil.copytree(source / "hidden", f"{folder}_secret")


def _entries(folder: Path, factory: pytest.TempPathFactory) -> None:
    """Write a number for each test record of the benchmark, as a classifier would."""
    bench = open_benchmark(committed_benchmark(factory) / "bench")
    asked = pa.concat_tables([bench.part(part).labels("test", ["record_id"]) for part in bench.parts])
    rows = (f"{record},{record % 7}" for record in asked["record_id"].to_pylist())
    folder.mkdir()
    (folder / "mine.csv").write_text("\n".join(["record_id,damage", *rows, ""]))


SHORT = {**CONFIG, "name": "short", "specimens": 2}
MANY = {**CONFIG, "name": "many", "specimens": 14, "splits": {"train": 10, "validation": 5, "test": 5}}
MADE: dict[str, str | Callable[[Path, pytest.TempPathFactory], object]] = {
    "short.yaml": _yaml(SHORT),
    "many.yaml": _yaml(MANY),
    "publication.yaml": _yaml(FACTS),
    "reading.yaml": _yaml({"unit": "g", "teeth": [18, 47], "speed": [28, 32]}),
    "tacho.yaml": _yaml({"tacho": "tacho_s"}),
    "april.wav": _recording(8),
    "may.wav": _recording(0),
    "june.wav": _recording(1),
    "july.wav": _recording(2),
    "august.wav": _recording(3, 0.7),
    "rig.yaml": "siggen init --teeth 18,47 --module 3 --speed 28,32 --torque 30,45 --sensors 1 --out rig.yaml",
    "short": "siggen generate short.yaml --workers 0 --out short",
    "set": "siggen generate many.yaml --workers 0 --out set",
    "models": "siggen-diagnostics report set --no-cnn --out models",
    "machine": f"siggen-diagnostics baseline april.wav may.wav june.wav july.wav {DESCRIBED} --out machine",
    "committed": _committed,
    "entries": _entries,
}
"""How what lines need is made: by a line, or by a function of its path."""
