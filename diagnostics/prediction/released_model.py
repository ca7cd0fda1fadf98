"""A model folder read for use: skops, safetensors and JSON only, none of which executes what a file holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from diagnostics.baselines import FeatureClassifier
from diagnostics.classifier_file import load_classifier, load_settings
from diagnostics.evaluation import Interval
from diagnostics.extras import missing_packages
from diagnostics.features import FeatureSettings
from diagnostics.prediction.model_facts import FACTS_FILE, ModelFacts, read_accuracy, read_facts
from diagnostics.prediction.release import REFERENCED
from diagnostics.prediction.training_distance import TrainingDistance
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.cnn import WideKernelNetwork
    from diagnostics.cnn_files import NetworkFile

NETWORK_FILE = "cnn.safetensors"


@dataclass(frozen=True, slots=True)
class ReleasedModel:
    """Everything `train` wrote that a prediction needs.

    Attributes
    ----------
    folder : Path
    facts : ModelFacts
    settings : FeatureSettings
        How the features were taken.
    classifier, distance
        On the features themselves.
    referenced_classifier, referenced_distance
        On features minus the machine's own healthy ones; None where the set did not allow the variant.
    network : tuple or None
        Network and what its file says; None where it was not trained or torch is missing.
    accuracy : mapping of str to Interval
        Accuracy on the test specimens by classifier.
    note : str
        What was left out, or empty.
    """

    folder: Path
    facts: ModelFacts
    settings: FeatureSettings
    classifier: FeatureClassifier
    distance: TrainingDistance
    referenced_classifier: FeatureClassifier | None
    referenced_distance: TrainingDistance | None
    network: tuple[WideKernelNetwork, NetworkFile] | None
    accuracy: Mapping[str, Interval]
    note: str


def load_model(folder: Path) -> ReleasedModel:
    """Read the folder that `siggen-diagnostics train` wrote.

    Raises
    ------
    UsageError
        If it is missing or a file (a pickled one, say), or its files are missing, damaged, or hold what is not trusted.
    """
    if not folder.exists():
        raise UsageError(
            f"{folder}: no such folder; MODEL is the folder that `siggen-diagnostics train SET --out MODEL` wrote"
        )
    if not folder.is_dir():
        raise UsageError(
            f"{folder}: a model is the folder that `siggen-diagnostics train` wrote; single files, pickled ones above "
            "all, are not read, since reading those would execute what they hold"
        )
    if not (folder / FACTS_FILE).is_file():
        raise UsageError(f"{folder}: holds no {FACTS_FILE}; give a folder that `siggen-diagnostics train` wrote")
    facts, distance, referenced = read_facts(folder)
    network, note = _network(folder)
    return ReleasedModel(
        folder=folder,
        facts=facts,
        settings=load_settings(folder),
        classifier=load_classifier(folder),
        distance=distance,
        referenced_classifier=load_classifier(folder, REFERENCED) if referenced else None,
        referenced_distance=referenced,
        network=network,
        accuracy=read_accuracy(folder),
        note=note,
    )


def _network(folder: Path) -> tuple[tuple[WideKernelNetwork, NetworkFile] | None, str]:
    path = folder / NETWORK_FILE
    if not path.is_file():
        return None, ""
    if missing := missing_packages("torch", "safetensors"):
        return None, f"network left out: {', '.join(missing)} not installed (pip install 'siggen[cnn]')"
    from diagnostics.cnn_files import load_network

    return load_network(path), ""
