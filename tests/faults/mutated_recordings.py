"""Recordings with bytes that are wrong: each has to give indicators or be refused in words, by `indicators`."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random

import numpy as np

from benchmarks.row import Row
from diagnostics.machine.recording_indicators import recording_indicators
from diagnostics.recordings.taken import RecordingFacts
from tests.faults.mutations import Case, judged, mutated_bytes, outcomes_row
from tests.faults.recorder_files import recorder_files

FS_HZ, SAMPLES = 4096, 8192
KINDS = ("csv", "mat", "mat", "wav", "wav", "npy", "npz", "parquet", "parquet")
COUNT, QUICK_COUNT = 1_000, 45


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row of the files that everybody has, and one of those of recorders."""
    count = QUICK_COUNT if quick else COUNT
    with tempfile.TemporaryDirectory() as name:
        for whole in (recordings(Path(name)), recorder_files(Path(name), channels(), FS_HZ)):
            kinds = ", ".join(dict.fromkeys(path.suffix for path in whole))
            what = f"{count} mutated recordings ({kinds})"
            cases = mutated_recordings(count, whole)
            yield outcomes_row(what, cases, count, "with indicators", "CPU beside the parser's process")


def channels() -> dict[str, np.ndarray]:
    """Return two channels: mesh lines with sidebands, lines of both shafts, and noise."""
    rng, time_s = np.random.default_rng(5), np.arange(SAMPLES) / FS_HZ
    turns = 2 * np.pi * 20.0 * time_s
    mesh = sum(np.sin(20 * k * turns) * (1 + 0.3 * np.cos(turns)) / k for k in (1, 2, 3)) + 0.5 * np.cos(turns)
    shafts = (np.cos(k * turns * ratio + rng.uniform(0.0, 6.0)) for ratio in (1.0, 2.0 / 3.0) for k in range(1, 91))
    first, second = 0.1 * rng.standard_normal((2, SAMPLES)) + mesh + 0.05 * sum(shafts)
    return {"a": first, "b": second}


def recordings(folder: Path) -> list[Path]:
    """Write one whole recording of each kind that needs no library of a recorder's format."""
    import pyarrow as pa
    import pyarrow.parquet as pq
    from scipy.io import savemat, wavfile

    first, second = channels().values()
    both = np.stack([first, second], axis=1)
    np.savetxt(folder / "0.csv", both, delimiter=",", header="a,b", comments="", fmt="%.6g")
    savemat(folder / "1.mat", {"a": first, "b": second, "s": {"x": 1.0, "y": "text"}}, do_compression=True)
    savemat(folder / "2.mat", {"a": first, "b": second, "c": np.array(["x", "y"], dtype=object)})
    wavfile.write(folder / "3.wav", FS_HZ, both.astype(np.float32))
    wavfile.write(folder / "4.wav", FS_HZ, (5000 * both).astype(np.int16))
    np.save(folder / "5.npy", both)
    np.savez_compressed(folder / "6.npz", a=first, b=second)
    pq.write_table(pa.table({"a": first, "b": second}), folder / "7.parquet")
    pq.write_table(pa.table({"a": [first.tolist()], "b": [second.tolist()], "t": ["x"]}), folder / "8.parquet")
    return [folder / f"{number}.{kind}" for number, kind in enumerate(KINDS)]


def mutated_recordings(count: int, whole: Sequence[Path], seed: int = 0) -> Iterator[Case]:
    """Yield what comes of each of `count` mutations of whole recordings, one after the other; they are overwritten."""
    chance = Random(seed)
    contents = [path.read_bytes() for path in whole]
    for number in range(count):
        path = whole[number % len(whole)]
        path.write_bytes(mutated_bytes(contents[number % len(whole)], chance))
        yield _judged(path)


def _judged(path: Path) -> Case:
    facts = RecordingFacts(None if path.suffix == ".wav" else FS_HZ, unit="m/s2", full_scale=10.0)
    return judged(path.name, lambda: recording_indicators(path, (20, 30), facts, (10.0, 30.0)))
