"""`siggen inspect planetary`: whether a planetary set can be put together, its speeds, orders and phases."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.json_output import AsJson, echo_json

if TYPE_CHECKING:
    from collections.abc import Mapping

    from siggen.gears.geometry.planetary import PlanetarySet


def planetary(
    sun: Annotated[int, typer.Argument(metavar="SUN", min=1, help="Teeth of the sun.")],
    planet: Annotated[int, typer.Argument(metavar="PLANET", min=1, help="Teeth of each planet.")],
    ring: Annotated[int, typer.Argument(metavar="RING", min=1, help="Teeth of the ring, which stands still.")],
    *,
    planets: Annotated[int, typer.Option("--planets", min=1, help="Number of planets, 3 to 5.")] = 3,
    at: Annotated[
        str | None, typer.Option("--at", metavar="DEG,DEG,...", help="Positions of planets at unequal distances.")
    ] = None,
    carrier_hz: Annotated[float, typer.Option("--carrier-hz", help="Rotation of the carrier.")] = 1.0,
    as_json: AsJson = False,
) -> None:
    """Print speeds, orders and mesh phases of a planetary set with a fixed ring, or why it does not fit together.

    Example: siggen inspect planetary 24 27 78 --planets 3 --carrier-hz 2.5
    """
    teeth = _checked(sun, planet, ring, at or planets)
    found = {**_content(teeth, carrier_hz), "meshes": _meshes(teeth)}
    if as_json:
        echo_json(found)
    else:
        _print(found, teeth)


def _checked(sun: int, planet: int, ring: int, positions: str | int) -> PlanetarySet:
    from siggen.errors import UsageError
    from siggen.gears.geometry.planetary import PlanetarySet, even_places, planetary_problems, typed_places

    places = typed_places(_degrees(positions), sun + ring) if isinstance(positions, str) else even_places(positions)
    teeth = PlanetarySet(sun, planet, ring, places)
    if problems := planetary_problems(teeth):
        raise UsageError("; ".join(map(str, problems)))
    return teeth


def _degrees(text: str) -> list[float]:
    from siggen.errors import UsageError

    try:
        found = [float(part) for part in text.split(",")]
    except ValueError:
        found = []
    if not found or not all(map(isfinite, found)):
        raise UsageError(f"--at {text}: allowed: numbers [deg] between commas, such as 0,120,240")
    return found


def _content(teeth: PlanetarySet, carrier_hz: float) -> dict[str, Any]:
    from siggen.gears.geometry.planetary_orders import passing_orders, shaft_orders, sideband_steps

    def both(orders: Mapping[str, Any]) -> dict[str, dict[str, float]]:
        return {name: {"order": float(order), "hz": float(order) * carrier_hz} for name, order in orders.items()}

    return {
        "common_turns": teeth.common_turns,
        "shafts": both(shaft_orders(teeth)),
        "passing": both(passing_orders(teeth)),
        "sideband_steps": {name: list(map(float, steps)) for name, steps in sideband_steps(teeth).items()},
        "planets": [
            {"position_deg": 360.0 * float(place), "phase": float(phase)}
            for place, phase in zip(teeth.places, teeth.phases, strict=True)
        ],
        "excited": {str(i): teeth.excited(i) for i in (1, 2, 3)} if teeth.evenly_spaced else {},
    }


def _meshes(teeth: PlanetarySet) -> dict[str, float | str]:
    """Return what does not depend on the size, or why unshifted teeth do not mesh; shifted ones may."""
    from siggen.views.planetary_meshes import planetary_meshes

    try:
        return {**planetary_meshes(teeth.sun, teeth.planet, teeth.ring)}
    except ValueError as error:
        return {"do not mesh": str(error)}


def _print(found: dict[str, Any], teeth: PlanetarySet) -> None:
    from rich.console import Console
    from rich.table import Table

    orders = Table(title=f"sun {teeth.sun}, planets {teeth.planet}, ring {teeth.ring} (fixed)")
    orders.add_column("per turn of the carrier")
    orders.add_column("order", justify="right")
    orders.add_column("[Hz]", justify="right")
    for name, one in (*found["shafts"].items(), *found["passing"].items()):
        orders.add_row(name, f"{one['order']:.6g}", f"{one['hz']:.6g}")
    phases = Table(title="phases against the first planet, in pitches")
    for name in ("planet", "position [deg]", "both meshes"):
        phases.add_column(name, justify="right")
    for number, one in enumerate(found["planets"], start=1):
        phases.add_row(str(number), f"{one['position_deg']:.4f}", f"{one['phase']:.4f}")
    meshes = Table(title="meshes of unshifted teeth of 20 deg (the ring is shifted to fit; bores of half the root)")
    for name in ("", "value"):
        meshes.add_column(name)
    for name, value in found["meshes"].items():
        meshes.add_row(name.replace("_", " "), value if isinstance(value, str) else f"{value:.4g}")
    console = Console()
    console.print(meshes)
    console.print(orders)
    console.print(phases)
    for harmonic, moved in found["excited"].items():
        console.print(f"harmonic {harmonic} of the mesh moves: {moved}")
    console.print(f"all teeth meet again after {found['common_turns']} turns of the carrier")
