"""A model folder read for use: skops, safetensors and JSON only, none of which executes what a file holds.

What each file of a model folder says it was trained on, so that files of two models are not used as one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from diagnostics.base.extras import missing_packages
from diagnostics.base.reading_process import read_apart
from diagnostics.indicators.own_indicator import OwnIndicator, named_once
from diagnostics.indicators.registry import indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.judging.judgement import NETWORK
from diagnostics.prediction.model_facts import (
    FACTS_FILE,
    MODEL_FILES,
    REFERENCED,
    ModelFacts,
    check_files,
    read_content,
)
from diagnostics.prediction.training_distance import TrainingDistance
from diagnostics.scoring.prediction_file import MODELS_FOLDER
from diagnostics.statistics.evaluation import Interval
from diagnostics.training.feature_classifier import (
    CLASSIFIER_FILE,
    NAMES_FILE,
    FeatureClassifier,
    classifier_identity,
    load_classifier,
    load_settings,
)
from siggen.errors import UsageError, how_to_install

if TYPE_CHECKING:
    from diagnostics.training.cnn import TrainedNetwork

NETWORK_FILE = "cnn.safetensors"
LOADED_ONCE = ("diagnostics.training.skops_io",)
"""What the process that tries models loads before it has limits."""


@dataclass(frozen=True, slots=True)
class ReleasedModel:
    """Everything `report` wrote that a prediction needs.

    Attributes
    ----------
    folder : Path
    facts : ModelFacts
    settings : IndicatorSettings
        How the features were taken.
    classifier, distance
        On the features themselves.
    referenced_classifier, referenced_distance
        On features minus the machine's own healthy ones; None where the set did not allow the variant.
    network : TrainedNetwork or None
        None where it was not trained or torch is missing.
    accuracy : mapping of str to Interval
        Accuracy on the test specimens by classifier.
    note : str
        What was left out, or empty.
    own : tuple of OwnIndicator
        The user's indicators that the classifiers take.
    """

    folder: Path
    facts: ModelFacts
    settings: IndicatorSettings
    classifier: FeatureClassifier
    distance: TrainingDistance
    referenced_classifier: FeatureClassifier | None
    referenced_distance: TrainingDistance | None
    network: TrainedNetwork | None
    accuracy: Mapping[str, Interval]
    note: str
    own: tuple[OwnIndicator, ...] = ()


def load_model(folder: Path, own: Sequence[OwnIndicator] = ()) -> ReleasedModel:
    """Read the models in a folder that `siggen-diagnostics report` wrote.

    Parameters
    ----------
    folder : Path
        The folder, or the `models` in it; nothing in it is executed.
    own : sequence of OwnIndicator
        The user's indicators; those that the model was trained with have to be among them.

    Raises
    ------
    UsageError
        If it is missing or a file (a pickled one, say), or its files are missing, damaged, hold what is not trusted, or
        were not written together.
    """
    if not folder.exists():
        raise UsageError(
            f"{folder}: no such folder; MODEL is the folder that `siggen-diagnostics report SET --out MODEL` wrote"
        )
    if not folder.is_dir():
        raise UsageError(
            f"{folder}: a model is the folder that `siggen-diagnostics report` wrote; single files, pickled ones above "
            "all, are not read, since reading those would execute what they hold"
        )
    folder = folder / MODELS_FOLDER if (folder / MODELS_FOLDER).is_dir() else folder
    if not (folder / FACTS_FILE).is_file():
        raise UsageError(f"{folder}: holds no {FACTS_FILE}; give a folder that `siggen-diagnostics report` wrote")
    files = [folder / name for name in (FACTS_FILE, *MODEL_FILES) if (folder / name).exists()]
    if strange := [file.name for file in files if not file.is_file()]:
        raise UsageError(f"{folder}: {', '.join(strange)} cannot be read through; allowed: regular files")
    size = sum(file.stat().st_size for file in files)
    tried_by = "diagnostics.prediction.model_with_network" if (folder / NETWORK_FILE).exists() else __name__
    with read_apart(folder / FACTS_FILE, f"{tried_by}:try_model", size=size):
        return written_model(folder, own)  # as it was just read within limits


def try_model(path: Path, _folder: Path) -> None:
    """Read a model as `load_model` does, to leave nothing: for the process with limits."""
    written_model(path.parent, None)


def written_model(folder: Path, own: Sequence[OwnIndicator] | None) -> ReleasedModel:
    """Return the model of a folder that this very program wrote, or has tried in a process with limits.

    Without own indicators those that it needs are not looked for.
    """
    content = read_content(folder)
    check_files(folder, content.files)
    network, note = _network(folder, scored=NETWORK in content.accuracy)
    prefixes = ("", *([REFERENCED] if content.referenced else []))
    classifiers = {prefix: load_classifier(folder, prefix) for prefix in prefixes}
    _check_folder(folder, content.facts, classifiers, network)
    return ReleasedModel(
        folder=folder,
        facts=content.facts,
        settings=load_settings(folder),
        classifier=classifiers[""],
        distance=content.distance,
        referenced_classifier=classifiers.get(REFERENCED),
        referenced_distance=content.referenced,
        network=network,
        accuracy=content.accuracy,
        note=note,
        own=() if own is None else _own_of(folder, content.facts, classifiers, own),
    )


def check_judges(model: ReleasedModel, *, referenced: bool) -> None:
    """Check that a model can judge recordings, beside healthy ones where `referenced`, before one of them is read.

    Its classifiers take the features of one mesh alone, whose teeth are all that a recording tells.

    Raises
    ------
    UsageError
        Naming the further meshes, the members of planetary sets, or the variant that was not trained.
    """
    first, *behind = model.facts.names
    if first.planetary or behind:
        parts = first.gears if first.planetary else tuple(mesh.name for mesh in behind)
        what = "planetary sets with" if first.planetary else "gearboxes with the further meshes"
        raise UsageError(
            f"{model.folder}: was trained on {what} {', '.join(parts)}; a recording is judged by the teeth of one "
            "pair. Train on a set of pairs, or judge sets like that with `siggen-diagnostics report SET --test OTHER`."
        )
    if referenced and model.referenced_classifier is None:
        raise UsageError(
            f"{model.folder}: was trained without the healthy-referenced variant, since its set had no second healthy "
            "record per gearbox; leave --reference out, or train on a set with a second healthy state (as "
            "configs/bench.yaml), repeat or operating point"
        )


def _own_of(
    folder: Path, facts: ModelFacts, classifiers: Mapping[str, FeatureClassifier], own: Sequence[OwnIndicator]
) -> tuple[OwnIndicator, ...]:
    """Return the user's indicators that the classifiers take.

    Raises
    ------
    UsageError
        If one was not given: a model holds the names of functions, never their code.
    """
    taken = {name.split("__")[0] for classifier in classifiers.values() for name in classifier.features}
    wanted = sorted(taken - indicator_columns(load_settings(folder), facts.names).keys())
    given = {indicator.name: indicator for indicator in named_once(own)}
    if missing := [name for name in wanted if name not in given]:
        raise UsageError(
            f"{folder}: was trained with your own indicators {', '.join(missing)}, which are not part of a model; give "
            "`siggen-diagnostics predict --indicator MODULE:NAME` for each"
        )
    return tuple(given[name] for name in wanted)


def _check_folder(
    folder: Path,
    facts: ModelFacts,
    classifiers: Mapping[str, FeatureClassifier],
    network: TrainedNetwork | None,
) -> None:
    """Check that all files were trained on what `model.json` names, and that pipelines take the features beside them.

    Raises
    ------
    UsageError
        Naming the file that differs, in what, and the way out.
    """
    parts = [(NETWORK_FILE, network.identity, network.classes, network.channels)] if network else []
    for prefix, one in classifiers.items():
        takes, highest = int(one.pipeline.n_features_in_), int(max(one.pipeline.classes_))
        if takes != len(one.features) or highest >= len(one.classes):
            differences = f"takes {takes} features instead of {len(one.features)}, class {highest + 1} of "
            raise _foreign(folder, f"{prefix}{CLASSIFIER_FILE}", "the names", f"{differences}{len(one.classes)}")
        channels = tuple(dict.fromkeys(name.split("__", 1)[1] for name in one.features if "__" in name))
        parts.append((f"{prefix}{NAMES_FILE}", classifier_identity(folder, prefix), one.classes, channels))
    for file, identity, classes, channels in parts:
        for name, own, expected in (
            ("identity of the set", (identity,), (facts.identity,)),
            ("classes", classes, facts.classes),
            ("channels", tuple(sorted(channels)), tuple(sorted(facts.channels))),
        ):
            if own != expected:
                said = (", ".join(one[:12] if len(one) == 64 else one for one in names) for names in (own, expected))
                raise _foreign(folder, file, FACTS_FILE, f"{name} {' instead of '.join(said)}")


def _foreign(folder: Path, file: str, beside: str, differences: str) -> UsageError:
    return UsageError(
        f"{folder / file}: does not belong to {beside} beside it ({differences}). The files of a model are written "
        f"together; copy the folder as a whole or train again: siggen-diagnostics report SET --out {folder}"
    )


def _network(folder: Path, *, scored: bool) -> tuple[TrainedNetwork | None, str]:
    """Return the network of a model, and what is to be noted where one that the model gives scores of is left out."""
    if not (folder / NETWORK_FILE).is_file():
        lost = f"network left out: {FACTS_FILE} gives its scores, but {NETWORK_FILE} is missing; train again"
        return None, lost if scored else ""
    if missing := missing_packages("torch", "safetensors"):
        return None, f"network left out: {', '.join(missing)} not installed: {how_to_install('cnn')}"
    from diagnostics.training.cnn import load_network

    return load_network(folder / NETWORK_FILE), ""
