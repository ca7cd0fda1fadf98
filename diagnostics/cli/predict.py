"""`siggen-diagnostics predict`: what saved models say about a recording, and whether they can say anything."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.recording_options import file_rows, named_column, two_gears, two_numbers
from diagnostics.cli.training_options import OwnIndicators
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.recordings.measured_recording import RecordingFacts


def predict(
    model: Annotated[Path, typer.Argument(metavar="MODEL", help="Folder that `train` wrote.", show_default=False)],
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="Recording: .csv, .mat, .wav, .parquet, .npy, .npz, .tdms, .uff, .unv, .h5 or .hdf5.",
            show_default=False,
        ),
    ],
    fs: Annotated[float | None, typer.Option(help="Sampling rate [Hz]. Not needed where the file states it.")] = None,
    teeth: Annotated[str | None, typer.Option(metavar="Z1,Z2", help="Teeth of pinion and gear.")] = None,
    speed_range: Annotated[
        str | None, typer.Option(metavar="LOW,HIGH", help="Range of pinion speed [Hz] to search without a tacho.")
    ] = None,
    channel: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=COLUMN", help="Column of the file for a channel of the model. May be given several times."
        ),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(help="Unit of the file: m/s2, mm/s2, g, mg, mV or V. Default: as the file states, else m/s2."),
    ] = None,
    sensitivity: Annotated[
        float | None, typer.Option(help="Sensitivity of the accelerometer [mV/g]. Needed for mV and V.")
    ] = None,
    full_scale: Annotated[float | None, typer.Option(help="Full scale of an integer WAV file, in its unit.")] = None,
    tacho: Annotated[
        str | None, typer.Option(metavar="COLUMN", help="Column with the tacho waveform, or `tacho_s`.")
    ] = None,
    tacho_pulses: Annotated[int, typer.Option(min=1, help="Tacho pulses per pinion revolution.")] = 1,
    reference: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE[:ROW,ROW]",
            help="Recording of the same machine in healthy state, with the same columns and unit. May be given several "
            "times.",
        ),
    ] = None,
    reference_fs: Annotated[
        float | None, typer.Option(help="Sampling rate [Hz] of the references, if it differs.")
    ] = None,
    row: Annotated[
        int | None, typer.Option(help="Row of FILE, from 0, if FILE is Parquet with one record per row.")
    ] = None,
    indicator: OwnIndicators = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="DIR", help="Folder for JSON, plots and page.")
    ] = None,
) -> None:
    """Find the state that a recording is most like, or say why the models give no answer.

    Example: siggen-diagnostics predict models run.csv --fs 25600 --teeth 18,47 --speed-range 30,40
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.recordings.measured_recording import RecordingFacts, read_recording

    require_packages("prediction", "sklearn", "skops")
    with terminal_stage("reading the models", 1):
        from diagnostics.prediction.prediction import predict_recording
        from diagnostics.prediction.prediction_facts import MEANING, prediction_rows
        from diagnostics.prediction.released_model import load_model

        loaded = load_model(model, load_indicators(indicator))
    pair = _teeth(file, teeth, loaded.facts.teeth)
    columns = dict(named_column(entry) for entry in channel or ())
    facts = RecordingFacts(fs, columns, unit, sensitivity, full_scale, tacho, tacho_pulses, row)
    names = loaded.facts.channels
    recording = read_recording(file, names, facts)
    references = tuple(
        read_recording(path, names, _reference_facts(facts, path, number, reference_fs))
        for said in reference or ()
        for path, number in file_rows(said)
    )
    low_high = two_numbers(speed_range, "--speed-range", "20,50") if speed_range else None
    with terminal_stage("prediction", 1):
        found = predict_recording(loaded, recording, pair, low_high, references)
    for label, text in prediction_rows(found):
        typer.echo(f"{label + ':':21} {text}")
    typer.echo(MEANING)
    if out:
        from diagnostics.prediction.prediction_page import write_prediction

        with terminal_stage("page", 1):
            page = write_prediction(found, loaded.facts, out)
        typer.echo(str(page))


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
