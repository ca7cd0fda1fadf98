"""`siggen inspect path` and `housing`: what lies between the bearings and each channel of one gearbox."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from siggen.cli.echo import echo
from siggen.cli.inspection import Inspection
from siggen.cli.json_output import echo_json
from siggen.cli.working import working

if TYPE_CHECKING:
    from rich.table import Table

    from siggen.drivetrain.box import Box
    from siggen.views.path import PathCurves


SHOWN = 12
"""Modes that are printed; --json has all."""


def path(asked: Inspection) -> None:
    """Print the transfer paths from bearing forces to channels: modes, damping and level.

    The table has one row per frequency and two columns per channel and bearing force, in the form that a sensor's
    measured path reads.
    """
    png = asked.png(prints=True)
    found = _found(asked)
    if not asked.as_json:
        from rich.console import Console

        Console().print(_printed(found))

    def draw(file: Path) -> None:
        from siggen.views.path import save_path_figure

        save_path_figure(found, file)

    asked.hand_over(found.table, draw, png, lambda: _facts(found))


def housing(asked: Inspection) -> None:
    """Write the modes of a housing of plates, in the form that housing.kind: modal reads."""
    from siggen.errors import UsageError
    from siggen.file_writing import write_file
    from siggen.views.exported_model import exported_modes

    asked.png(endings=(".csv",))
    found = _found(asked)
    if found.housing is None:
        raise UsageError("no sensor stands on a housing that gives way: allowed is housing.kind: plates")
    if asked.as_json:
        echo_json({"housing_modes": _facts(found)["housing_modes"]})
    if asked.out is not None:
        write_file(asked.out, exported_modes(found.housing).text)
        echo(str(asked.out), err=asked.as_json)


def _found(asked: Inspection) -> PathCurves:
    from siggen.views.path import path_curves

    with working("computing transfer paths"):
        loaded = asked.design()
        return path_curves(loaded.gearbox(asked.gearbox), loaded.config.mesh_harmonics)


def _facts(found: PathCurves) -> dict[str, object]:
    """Return what is printed, in numbers."""
    channels = []
    for channel in found.channels:
        largest, at_hz = found.peak(channel)
        facts = {"channel": channel.name, "modes": channel.path_modes, "rms_m_s2_per_n": channel.path_rms_m_s2_per_n}
        channels.append({**facts, "largest_m_s2_per_n": largest, "largest_at_hz": at_hz})
    modes = () if found.housing is None else found.housing.pairs
    housing = [{"frequency_hz": frequency, "damping_ratio": damping} for frequency, damping in modes]
    return {"gearbox": found.specimen_id, "channels": channels, "housing_modes": housing}


def _printed(found: PathCurves) -> Table:
    """Return number of modes, range of their frequencies and damping, and the level of every channel with a path."""
    from rich.table import Table

    table = Table(title=f"transfer paths of gearbox {found.specimen_id}", title_justify="left")
    for name in ("channel", "modes", "rms accelerance [m/s2/N]", "largest [m/s2/N]", "at [Hz]"):
        table.add_column(name, justify="left" if name == "channel" else "right")
    for channel in found.channels:
        largest, at_hz = found.peak(channel)
        rms = f"{channel.path_rms_m_s2_per_n:.3g}"
        table.add_row(channel.name, str(channel.path_modes or "-"), rms, f"{largest:.3g}", f"{at_hz:.0f}")
    if found.housing is not None:
        first = ", ".join(f"{f:.0f} Hz ({100 * d:.1f} %)" for f, d in found.housing.pairs[:SHOWN])
        table.caption = f"{_body_text(found.housing.box)}; its lowest modes: {first}"
        table.caption_justify = "left"
    return table


def _body_text(box: Box | None) -> str:
    if box is None:
        return "housing by its modes"
    size = " x ".join(f"{1e3 * length:.0f}" for length in box.size_m)
    return f"housing of {box.mass_kg:.1f} kg, {size} mm"
