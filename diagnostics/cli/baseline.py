"""`siggen-diagnostics baseline`: a machine's healthy state from recordings of it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.recording_options import (
    Channel,
    FullScale,
    Rate,
    Sensitivity,
    SpeedRange,
    Tacho,
    TachoPulses,
    Teeth,
    Unit,
    file_rows,
    named_column,
    two_gears,
    two_numbers,
)
from siggen.errors import UsageError


def baseline(
    healthy: Annotated[
        list[str],
        typer.Argument(
            metavar="HEALTHY...",
            help="Healthy recordings: .csv, .mat, .wav, .parquet (FILE:ROW,ROW), .npy, .npz, .tdms, .uff, .h5; 3 at "
            "least.",
            show_default=False,
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="MACHINE", help="New folder of the machine.")],
    teeth: Teeth = None,
    fs: Rate = None,
    speed_range: SpeedRange = None,
    channel: Channel = None,
    unit: Unit = None,
    sensitivity: Sensitivity = None,
    full_scale: FullScale = None,
    tacho: Tacho = None,
    tacho_pulses: TachoPulses = 1,
    load: Annotated[
        str, typer.Option("--load", metavar="L[,L...]", help="Load in any unit: of all recordings, or one for each.")
    ] = "",
    false_alarms: Annotated[
        float, typer.Option(min=0.001, max=0.3, help="Wanted rate of false alarms of `check`.")
    ] = 0.05,
) -> None:
    """Learn what a healthy machine looks like; `check` compares later recordings with it. No simulation is needed.

    Example: siggen-diagnostics baseline may.csv june.csv july.csv --fs 25600 --teeth 25,56 --speed-range 14,26 -o rig
    """
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.machine.check import rate_sentence
    from diagnostics.machine.healthy_state import healthy_state
    from diagnostics.machine.machine import save_machine
    from diagnostics.recordings.file_channels import file_channels
    from diagnostics.recordings.measured_recording import RecordingFacts

    if teeth is None:
        raise UsageError("--teeth: received nothing; give the teeth of pinion and gear, such as --teeth 25,56")
    sources = [source for said in healthy for source in file_rows(said)]
    columns = dict(named_column(said) for said in channel or ())
    names = tuple(columns) or file_channels(sources[0][0], tacho, sources[0][1])
    facts = RecordingFacts(fs, columns, unit, sensitivity, full_scale, tacho, tacho_pulses)
    span = two_numbers(speed_range, "--speed-range", "20,50") if speed_range else None
    with terminal_stage("healthy recordings", len(sources)) as advance:
        machine = healthy_state(sources, names, facts, two_gears(teeth), span, _loads(load), false_alarms, advance)
    save_machine(machine, out)
    speeds = f"{machine.speed_hz.min():.4g} to {machine.speed_hz.max():.4g} Hz"
    typer.echo(f"{len(sources)} recordings, {len(machine.channels)} channels, pinion at {speeds}", err=True)
    typer.echo(rate_sentence(len(sources), false_alarms), err=True)
    typer.echo(str(out))


def _loads(said: str) -> list[float]:
    try:
        return [float(part) for part in said.split(",")] if said else []
    except ValueError:
        raise UsageError(f"--load: received '{said}'; allowed: numbers with commas between") from None
