"""`siggen-diagnostics predict`: what saved models say about a recording, and whether they can say anything."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.recording_options import RecordingOptions, Teeth, file_rows, two_gears
from diagnostics.cli.set_options import OwnIndicators
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.recordings.measured_recording import RecordingFacts


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
    reference_fs: Annotated[float | None, typer.Option(help="Sampling rate [Hz] of the references, if it differs.")] = (
        None
    )


@grouped
def predict(
    model: Annotated[Path, typer.Argument(metavar="MODEL", help="Folder that `report` wrote.", show_default=False)],
    file: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE...",
            help="Recordings: .csv, .mat, .wav, .parquet (FILE:ROW,ROW), .npy, .npz, .tdms, .uff, .unv, .h5 or .hdf5.",
            show_default=False,
        ),
    ],
    *,
    teeth: Teeth = None,
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

    Example: siggen-diagnostics predict data/quickstart_report run.csv --fs 25600 --teeth 18,47 --speed-range 30,40
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.recordings.measured_recording import read_recording

    require_packages("prediction", "sklearn", "skops")
    with terminal_stage("reading the models", 1):
        from diagnostics.prediction.prediction import predict_recording
        from diagnostics.prediction.prediction_page import (
            MEANING,
            prediction_facts,
            prediction_headline,
            prediction_rows,
            write_prediction,
        )
        from diagnostics.prediction.released_model import load_model

        loaded = load_model(model, load_indicators(indicator))
    sources = [source for said in file for source in file_rows(said)]
    pair = _teeth(sources[0][0], teeth, loaded.facts.teeth)
    facts, names, units = recording.facts(), loaded.facts.channels, loaded.facts.units
    references = tuple(
        read_recording(path, names, _reference_facts(facts, path, number, healthy.reference_fs), units)
        for said in healthy.reference or ()
        for path, number in file_rows(said)
    )
    found = {}
    with terminal_stage("prediction", len(sources)) as advance:
        for path, row in sources:
            read = read_recording(path, names, replace(facts, row=row), units)
            name = path.name if row is None else f"{path.name}:{row}"
            found[name] = predict_recording(loaded, read, pair, recording.speed_range_hz(), references)
            advance()
    if as_json:
        echo_json({"predictions": [prediction_facts(one, loaded.facts) for one in found.values()]})
    else:
        for name, one in found.items():
            typer.echo(f"{name}: {prediction_headline(one)}")
            for label, text in prediction_rows(one):
                typer.echo(f"  {label + ':':21} {text}")
        typer.echo(MEANING)
    if out is None:
        return
    for name, one in found.items():
        place = out / name.replace(":", "_") if len(found) > 1 else out
        typer.echo(str(write_prediction(one, loaded.facts, place)), err=as_json)


def _teeth(file: Path, said: str | None, known: tuple[tuple[int, int], ...]) -> tuple[int, int]:
    if said is None:
        pairs = " or ".join(f"{a},{b}" for a, b in known)
        raise UsageError(
            f"{file}: teeth unknown. Orders, averages and sidebands need them. Give --teeth PINION,GEAR (this model "
            f"was trained on {pairs})"
        )
    return two_gears(said)


def _reference_facts(facts: RecordingFacts, path: Path, row: int | None, fs_hz: float | None) -> RecordingFacts:
    """Return what is said about a reference: as about the recording, but for its own row and rate."""
    states_rate = path.suffix.lower() == ".wav"
    return replace(facts, row=row, fs_hz=fs_hz or (None if states_rate else facts.fs_hz))
