"""`siggen-diagnostics predict`: what saved models say about a recording, and whether they can say anything."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.recording_options import GearOptions, RecordingOptions, file_rows, recordings_of, two_gears
from diagnostics.cli.set_options import OwnIndicators
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import EXIT_USAGE, UsageError

if TYPE_CHECKING:
    from diagnostics.prediction.prediction import Prediction
    from diagnostics.recordings.taken import RecordingFacts, Source


@dataclass(frozen=True, slots=True)
class ReferenceOptions:
    """Healthy recordings of the same machine."""

    reference: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE[:ROW,ROW]",
            help="Recording of the same machine in healthy state, with the same columns and unit. May be given several "
            "times.",
        ),
    ] = None


@grouped
def predict(
    model: Annotated[Path, typer.Argument(metavar="MODEL", help="Folder that `report` wrote.", show_default=False)],
    file: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE...",
            help="Recordings: .csv, .txt, .lvm, .mat, .wav, .npz, .tdms, .uff, .h5, .mf4, .parquet (FILE:ROW,ROW) and "
            "others.",
            show_default=False,
        ),
    ],
    *,
    gears: GearOptions,
    recording: RecordingOptions,
    healthy: ReferenceOptions,
    indicator: OwnIndicators = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="DIR", help="Folder for JSON, plots and page; of several, one each in it."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find the state that each recording is most like, or say why the models give no answer.

    Of several recordings, those that cannot be used are named behind the others; the exit code is then 2.

    Example: siggen-diagnostics predict runs/quickstart_report run.csv --fs 25600 --teeth 18,47 --speed 30,40
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.recordings.measured_recording import read_recording

    require_packages("prediction", "sklearn", "skops")
    with terminal_stage("reading the models", 1):
        from diagnostics.prediction.prediction import predict_recording
        from diagnostics.prediction.prediction_page import prediction_facts, write_prediction
        from diagnostics.prediction.released_model import check_judges, load_model

        loaded = load_model(model, load_indicators(indicator))
        check_judges(loaded, referenced=bool(healthy.reference))
    sources = recordings_of(file)
    reading = recording.read(sources[0])
    pair = _teeth(sources[0][0], gears.said(reading), loaded.facts.teeth)
    facts, names, units = reading.facts(), loaded.facts.channels, loaded.facts.units
    references = tuple(
        read_recording(path, names, _reference_facts(facts, path, number), units)
        for said in healthy.reference or ()
        for path, number in file_rows(said)
    )
    predictions, refused = {}, {}
    with terminal_stage("prediction", len(sources)) as advance:
        for name, (path, row) in zip(_names(sources), sources, strict=True):
            try:
                read = read_recording(path, names, replace(facts, row=row), units)
                predictions[name] = predict_recording(loaded, read, pair, reading.speed_range_hz(), references)
            except UsageError as error:
                refused[name] = str(error)
            advance()
    if refused and not predictions:
        raise UsageError("\n".join(refused.values()))
    if as_json:
        told = [prediction_facts(prediction, loaded.facts) for prediction in predictions.values()]
        echo_json({"predictions": told, "refused": refused})
    else:
        _tell(predictions, refused)
    if out is not None:
        folders = dict(zip(_names(sources), _folders(sources), strict=True))
        for name, prediction in predictions.items():
            place = out / folders[name] if len(sources) > 1 else out
            echo(str(write_prediction(prediction, loaded.facts, place)), err=as_json)
    if refused:
        raise typer.Exit(EXIT_USAGE)


def _tell(predictions: Mapping[str, Prediction], refused: Mapping[str, str]) -> None:
    """Print what was found of every recording, first in one line."""
    from diagnostics.prediction.prediction_page import MEANING, prediction_headline, prediction_rows

    for name, prediction in predictions.items():
        echo(f"{name}: {prediction_headline(prediction)}")
        for label, text in prediction_rows(prediction):
            echo(f"  {label + ':':21} {text}")
    for name, reason in refused.items():
        echo(f"{name}: cannot tell: {reason}")
    echo(MEANING)


def _names(sources: Sequence[Source]) -> list[str]:
    """Return what recordings are called: by their files, by whole paths where two of these have one name."""
    files = [path.as_posix() if _alike(sources) else path.name for path, _ in sources]
    return [file if row is None else f"{file}:{row}" for file, (_, row) in zip(files, sources, strict=True)]


def _folders(sources: Sequence[Source]) -> list[str]:
    """Return what the folder of each is called: like the recording, in one part."""
    files = [path.relative_to(path.anchor).parts if _alike(sources) else (path.name,) for path, _ in sources]
    rows = [() if row is None else (str(row),) for _, row in sources]
    return ["_".join((*file, *row)) for file, row in zip(files, rows, strict=True)]


def _alike(sources: Sequence[Source]) -> bool:
    return len({(path.name, row) for path, row in sources}) < len(sources)


def _teeth(file: Path, said: str | None, known: tuple[tuple[int, int], ...]) -> tuple[int, int]:
    if said is None:
        pairs = " or ".join(f"{a},{b}" for a, b in known)
        raise UsageError(
            f"{file}: teeth unknown. Orders, averages and sidebands need them. Give --teeth PINION,GEAR (this model "
            f"was trained on {pairs})"
        )
    return two_gears(said)


def _reference_facts(facts: RecordingFacts, path: Path, row: int | None) -> RecordingFacts:
    """Return what is said about a reference: as about the recording, but for its row, and a rate that it states."""
    from diagnostics.recordings.taken import take

    unsaid = replace(facts, row=row, fs_hz=None)
    try:
        return unsaid if take(path, unsaid, say=False).fs_hz else replace(facts, row=row)
    except UsageError:  # a time that the rate explains, or nothing that can be read
        return replace(facts, row=row)
