"""`siggen-diagnostics predict`: what saved models say about a recording, and whether they can say anything."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.errors import UsageError


def predict(
    model: Annotated[Path, typer.Argument(metavar="MODEL", help="Folder that `train` wrote.", show_default=False)],
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="Recording: .csv, .mat, .wav, .parquet, .npy or .npz.", show_default=False),
    ],
    fs: Annotated[float | None, typer.Option(help="Sampling rate [Hz]; WAV files state it themselves.")] = None,
    teeth: Annotated[str | None, typer.Option(metavar="Z1,Z2", help="Teeth of pinion and gear.")] = None,
    speed_range: Annotated[
        str | None, typer.Option(metavar="LOW,HIGH", help="Pinion speeds [Hz] to look in, without a tacho.")
    ] = None,
    channel: Annotated[
        list[str] | None, typer.Option(metavar="NAME=COLUMN", help="Column of a channel of the model; repeat.")
    ] = None,
    unit: Annotated[str, typer.Option(help="m/s2, mm/s2, g, mg, mV or V.")] = "m/s2",
    sensitivity: Annotated[float | None, typer.Option(help="Of the accelerometer in mV per g, for mV and V.")] = None,
    full_scale: Annotated[float | None, typer.Option(help="Full scale of an integer WAV file, in the unit.")] = None,
    tacho: Annotated[str | None, typer.Option(metavar="COLUMN", help="Tacho's waveform, or `tacho_s`.")] = None,
    tacho_pulses: Annotated[int, typer.Option(min=1, help="Pulses per pinion revolution.")] = 1,
    reference: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="Recording of the same machine in healthy state; repeat."),
    ] = None,
    row: Annotated[int | None, typer.Option(help="Row of a Parquet file with one record per row.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="DIR", help="Folder for JSON, plots and page.")
    ] = None,
) -> None:
    """Say which state a recording is most like, with probability, or that it is unlike the training records.

    Example: siggen-diagnostics predict models run.csv --fs 51200 --teeth 18,47 --speed-range 20,35
    """
    from diagnostics.extras import require_packages
    from diagnostics.recordings.measured_recording import RecordingFacts, read_recording

    require_packages("prediction", "sklearn", "skops")
    from diagnostics.prediction.prediction import predict_recording
    from diagnostics.prediction.prediction_facts import MEANING, prediction_rows
    from diagnostics.prediction.released_model import load_model

    loaded = load_model(model)
    pair = _teeth(file, teeth, loaded.facts.teeth)
    columns = dict(_named(entry) for entry in channel or ())
    facts = RecordingFacts(fs, columns, unit, sensitivity, full_scale, tacho, tacho_pulses, row)
    names = loaded.facts.channels
    recording = read_recording(file, names, facts)
    references = tuple(read_recording(path, names, facts) for path in reference or ())
    low_high = _pair(speed_range, "--speed-range", "20,50") if speed_range else None
    found = predict_recording(loaded, recording, pair, low_high, references)
    for label, text in prediction_rows(found):
        typer.echo(f"{label + ':':22}{text}")
    typer.echo(MEANING)
    if out:
        from diagnostics.prediction.prediction_page import write_prediction

        typer.echo(str(write_prediction(found, loaded.facts, out)))


def _teeth(file: Path, said: str | None, known: tuple[tuple[int, int], ...]) -> tuple[int, int]:
    if said is None:
        pairs = " or ".join(f"{a},{b}" for a, b in known)
        raise UsageError(
            f"{file}: teeth unknown; orders, averages and sidebands need them. Give --teeth PINION,GEAR (this model "
            f"was trained on {pairs})"
        )
    first, second = _pair(said, "--teeth", "18,47")
    if min(first, second) < 3 or first % 1 or second % 1:
        raise UsageError(f"{file}: --teeth: received {said}; allowed are two whole numbers from 3 on")
    return int(first), int(second)


def _pair(said: str, option: str, example: str) -> tuple[float, float]:
    try:
        first, second = (float(part) for part in said.split(","))
    except ValueError as error:
        raise UsageError(f"{option}: received {said!r}; allowed are two numbers with a comma: {example}") from error
    return first, second


def _named(said: str) -> tuple[str, str]:
    name, equals, column = said.partition("=")
    if not equals or not name or not column:
        raise UsageError(f"--channel: received {said!r}; allowed is NAME=COLUMN, e.g. bearing_vertical=ch1")
    return name, column
