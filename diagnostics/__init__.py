"""Fault classifiers and sideband indicators, trained and judged on sets that siggen wrote.

The names below are loaded when they are first used, so that importing diagnostics costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diagnostics.bench.leaderboard import benchmark_baselines, leaderboard
    from diagnostics.bench.making import commit_benchmark, make_benchmark, reveal_benchmark
    from diagnostics.indicators.classifier_table import table
    from diagnostics.judging.alarms import evaluate
    from diagnostics.loader.window_arrays import windows
    from diagnostics.scoring.benchmark import open_benchmark
    from diagnostics.scoring.benchmark_scores import score_benchmark
    from diagnostics.scoring.score import score
    from diagnostics.training.average_rows import averages
    from diagnostics.training.classifiers import BoostingBaseline, LogisticBaseline
    from diagnostics.training.pretraining import PretrainingSettings, pretrain
    from diagnostics.training.shipped_network import pretrained_features

__all__ = [
    "BoostingBaseline",
    "LogisticBaseline",
    "PretrainingSettings",
    "averages",
    "benchmark_baselines",
    "commit_benchmark",
    "evaluate",
    "leaderboard",
    "make_benchmark",
    "open_benchmark",
    "pretrain",
    "pretrained_features",
    "reveal_benchmark",
    "score",
    "score_benchmark",
    "table",
    "windows",
]

_HOMES = {
    "make_benchmark": "diagnostics.bench.making",
    "commit_benchmark": "diagnostics.bench.making",
    "reveal_benchmark": "diagnostics.bench.making",
    "benchmark_baselines": "diagnostics.bench.leaderboard",
    "leaderboard": "diagnostics.bench.leaderboard",
    "open_benchmark": "diagnostics.scoring.benchmark",
    "score_benchmark": "diagnostics.scoring.benchmark_scores",
    "score": "diagnostics.scoring.score",
    "table": "diagnostics.indicators.classifier_table",
    "averages": "diagnostics.training.average_rows",
    "evaluate": "diagnostics.judging.alarms",
    "windows": "diagnostics.loader.window_arrays",
    "LogisticBaseline": "diagnostics.training.classifiers",
    "BoostingBaseline": "diagnostics.training.classifiers",
    "pretrain": "diagnostics.training.pretraining",
    "PretrainingSettings": "diagnostics.training.pretraining",
    "pretrained_features": "diagnostics.training.shipped_network",
}


def __getattr__(name: str) -> Any:
    """Return a public name from the module that defines it."""
    if name not in _HOMES:
        raise AttributeError(f"diagnostics has no {name!r}; it has {', '.join(__all__)}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names, loaded or not, so that completion and `help` show them."""
    return sorted(__all__)
