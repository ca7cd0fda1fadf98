"""Commit and reveal: the hash of sealed labels is published first, the labels themselves later."""

from __future__ import annotations

import json
from pathlib import Path

from diagnostics.scoring.benchmark import COMMITMENT, REVEALED, Benchmark
from diagnostics.scoring.sealed_labels import labels_of
from siggen.errors import UsageError
from siggen.file_writing import write_file


def commit(benchmark: Benchmark, sealed: Path | None = None) -> str:
    """Return the SHA-256 of the sealed labels, and write it into the benchmark; labels as of `labels_of`.

    Raises
    ------
    UsageError
        If the labels are of another benchmark, or others were committed to.
    """
    found = labels_of(benchmark, sealed).commitment
    content = {"sha256": found, "digest": benchmark.digest, "of": REVEALED}
    write_file(benchmark.path / COMMITMENT, json.dumps(content, indent=1) + "\n")
    return found


def reveal(benchmark: Benchmark, sealed: Path | None = None) -> Path:
    """Write the sealed labels into the benchmark; return the file. Labels as of `labels_of`.

    Raises
    ------
    UsageError
        If nothing was committed to, or other labels.
    """
    if benchmark.commitment() is None:
        raise UsageError(f"{benchmark.path}: nothing was committed to; run `siggen-diagnostics bench commit` first")
    found, target = labels_of(benchmark, sealed), benchmark.path / REVEALED
    if not target.exists() or not target.samefile(found.file):
        write_file(target, found.file.read_bytes())
    return target
