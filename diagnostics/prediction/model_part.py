"""What each file of a model folder says it was trained on, so that files of two models are not used as one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.model_seal import FACTS_FILE
from diagnostics.training.baselines import FeatureClassifier
from siggen.errors import UsageError


@dataclass(frozen=True, slots=True)
class ModelPart:
    """A file of a model folder: its name, the identity of the set it was trained on, its states and channels."""

    file: str
    identity: str
    classes: tuple[str, ...]
    channels: tuple[str, ...]


def classifier_part(file: str, identity: str, classifier: FeatureClassifier) -> ModelPart:
    """Return what the names beside a classifier on indicators say; channels are those of its features."""
    channels = dict.fromkeys(name.split("__", 1)[1] for name in classifier.features if "__" in name)
    return ModelPart(file, identity, classifier.classes, tuple(channels))


def check_parts(folder: Path, facts: ModelFacts, parts: list[ModelPart]) -> None:
    """Check that all files were trained on what `model.json` names.

    Raises
    ------
    UsageError
        Naming the file that differs, in what, and the way out.
    """
    for part in parts:
        differences = [
            f"{name} {_listed(own)} instead of {_listed(expected)}"
            for name, own, expected in (
                ("identity of the set", (part.identity,), (facts.identity,)),
                ("states", part.classes, facts.classes),
                ("channels", tuple(sorted(part.channels)), tuple(sorted(facts.channels))),
            )
            if own != expected
        ]
        if differences:
            raise _foreign(folder, part.file, f"does not belong to {FACTS_FILE} beside it", differences)


def check_size(folder: Path, file: str, classifier: FeatureClassifier) -> None:
    """Check that a pipeline takes as many features as the names beside it, and knows no further states.

    Raises
    ------
    UsageError
        If the pipeline is that of another model.
    """
    takes, named = int(classifier.pipeline.n_features_in_), len(classifier.features)
    highest, states = int(max(classifier.pipeline.classes_)), len(classifier.classes)
    differences = [f"takes {takes} features instead of {named}"] if takes != named else []
    if highest >= states:
        differences.append(f"knows state {highest + 1} of {states}")
    if differences:
        raise _foreign(folder, file, "does not belong to the names beside it", differences)


def _foreign(folder: Path, file: str, what: str, differences: list[str]) -> UsageError:
    return UsageError(
        f"{folder / file}: {what} ({'; '.join(differences)}). The files of a model are written together; copy the "
        f"folder as a whole or train again: siggen-diagnostics report SET --models-only --out {folder}"
    )


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(name[:12] if len(name) == 64 else name for name in names) or "none"
