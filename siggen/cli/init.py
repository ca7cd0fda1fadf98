"""`siggen init`: a configuration of the user's own machine from a few numbers."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from siggen.rig.rig import Pair

QUESTIONS = {
    "teeth": "teeth of pinion and gear, such as 25,56",
    "module": "module [mm]",
    "face-width": "face width [mm]",
    "speed": "speed of the pinion [Hz], one or lowest,highest",
    "torque": "torque on the pinion [N m], one or lowest,highest",
}


def init(
    out: Annotated[Path, typer.Option("--out", help="YAML file to write; never one that exists.")],
    teeth: Annotated[str, typer.Option("--teeth", metavar="Z1,Z2", help="Teeth of pinion and gear.")] = "",
    module: Annotated[str, typer.Option("--module", metavar="MM", help="Module.")] = "",
    face_width: Annotated[str, typer.Option("--face-width", metavar="MM", help="Face width.")] = "",
    speed: Annotated[str, typer.Option("--speed", metavar="HZ", help="Of the pinion: one, or lowest,highest.")] = "",
    torque: Annotated[str, typer.Option("--torque", metavar="NM", help="On the pinion: one, or lowest,highest.")] = "",
    sensors: Annotated[int, typer.Option("--sensors", help="Number of accelerometers on the casing.")] = 2,
    bores: Annotated[
        str, typer.Option("--bores", metavar="MM,MM", help="Shaft diameters of pinion and gear; else from the torque.")
    ] = "",
    pressure_angle: Annotated[float, typer.Option("--pressure-angle", help="Of the rack, in degrees.")] = 20.0,
    base: Annotated[str, typer.Option("--extends", help="Preset that gives everything else.")] = "bench",
    name: Annotated[str, typer.Option("--name", help="Of the set; by default the file's name.")] = "",
) -> None:
    """Write a short configuration of your own gearbox; at a terminal it asks for what is missing.

    Masses and inertias follow from the gears, bearings from the shafts, sampling rate and duration from mesh and
    hunting period, damage from the module; the rest comes from a preset.

    Example: siggen init --teeth 25,56 --module 2 --face-width 20 --speed 15,25 --torque 20 --out rig.yaml
    """
    from siggen.checks.loading import load_config
    from siggen.checks.plausibility import implausible
    from siggen.checks.shaft_notes import outside_notes
    from siggen.config import inherited, parse_yaml
    from siggen.errors import UsageError
    from siggen.rig.rig import Rig, checked_rig
    from siggen.rig.rig_text import rig_text

    if out.exists():
        raise UsageError(f"{out}: is there already; give --out a new file")
    given = {"teeth": teeth, "module": module, "face-width": face_width, "speed": speed, "torque": torque}
    answers = {option: text or _asked(option) for option, text in given.items()}
    z_1, z_2 = _two("teeth", answers["teeth"], whole=True)
    rig = checked_rig(
        Rig(
            (int(z_1), int(z_2)),
            _one("module", answers["module"]),
            _one("face-width", answers["face-width"]),
            _range("speed", answers["speed"]),
            _range("torque", answers["torque"]),
            sensors,
            pressure_angle,
            _two("bores", bores) if bores else None,
        )
    )
    text = rig_text(rig, name or _name(out), base)
    config = load_config(inherited(parse_yaml(text, str(out))))  # what is refused is never written
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8")
    for sentence in implausible(config):
        typer.echo(f"implausible: {sentence}", err=True)
    for note in outside_notes(config):
        typer.echo(f"note: {note}", err=True)
    typer.echo(f"next: siggen plan {out}; siggen generate {out} --set specimens=1 --out FOLDER", err=True)
    typer.echo(str(out))


def _asked(option: str) -> str:
    from siggen.errors import UsageError

    if not sys.stdin.isatty():
        raise UsageError(f"--{option}: received nothing; give the {QUESTIONS[option]}")
    return str(typer.prompt(QUESTIONS[option]))


def _numbers(option: str, text: str, allowed: str, *, whole: bool = False) -> list[float]:
    from siggen.errors import UsageError

    try:
        return [float(int(part)) if whole else float(part) for part in text.split(",")]
    except ValueError:
        raise UsageError(f"--{option}: received '{text}'; allowed: {allowed}") from None


def _one(option: str, text: str) -> float:
    from siggen.errors import UsageError

    values = _numbers(option, text, "one number")
    if len(values) != 1:
        raise UsageError(f"--{option}: received '{text}'; allowed: one number")
    return values[0]


def _two(option: str, text: str, *, whole: bool = False) -> Pair:
    from siggen.errors import UsageError

    allowed = f"two {'whole ' if whole else ''}numbers with a comma between, pinion first"
    values = _numbers(option, text, allowed, whole=whole)
    if len(values) != 2:
        raise UsageError(f"--{option}: received '{text}'; allowed: {allowed}")
    return values[0], values[1]


def _range(option: str, text: str) -> Pair:
    from siggen.errors import UsageError

    allowed = "one number, or the lowest and the highest with a comma between"
    values = _numbers(option, text, allowed)
    if len(values) > 2:
        raise UsageError(f"--{option}: received '{text}'; allowed: {allowed}")
    return values[0], values[-1]


def _name(out: Path) -> str:
    """Return the file's name as the name of a set: lower-case letters, digits, - and _."""
    import re

    return re.sub(r"[^a-z0-9_-]", "_", out.stem.lower()).lstrip("_-") or "rig"
