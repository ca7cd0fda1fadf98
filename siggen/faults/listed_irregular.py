"""One listed irregular spall: its very outline, station by station, as a user or a life writes it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import isfinite
from typing import Annotated

import numpy as np
from pydantic import Field

from siggen.errors import Problem
from siggen.faults.flank_place import MM, PROBE_M, AnyGear, axial_heights_m
from siggen.gears.damage.flank_damage import damage_problems
from siggen.gears.damage.irregular import IrregularSpall
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.section import Real, Section, Whole
from siggen.keys.wording import AllowedText
from siggen.names import PINION, Side

EdgePoint = Annotated[
    tuple[Real, Real, Real],
    AllowedText("three numbers in mm: [place across the face, height of the lower edge, height of the upper edge]"),
]


class ListedIrregular(Section):
    """One irregular spall with a flat floor at a given place."""

    gear: AnyGear = Field(default=PINION, description="damaged gear")
    tooth: Annotated[Whole, Field(ge=0)] = Field(default=0, description="index of the tooth, from 0")
    edges_mm: Annotated[tuple[EdgePoint, ...], Field(min_length=2)] = Field(
        description="place across the face, heights of the lower and the upper edge above the base circle; ascending "
        "across the face"
    )
    depth_mm: Annotated[Real, Field(gt=0)] = Field(description="depth normal to the tooth's middle plane")
    edge_radius_mm: Annotated[Real, Field(ge=0, le=1)] = Field(description="radius of the edges")

    def spall(self, pair: GearPair, reading: str) -> IrregularSpall:
        """Return the spall on the flank of a drawn gear, its heights as a reading measures them."""
        face, low, high = MM * np.array(self.edges_mm).T
        gear = pair.member(Side(self.gear))
        edges = (axial_heights_m(gear, edge, reading) for edge in (low, high))
        stations = tuple(zip(face.tolist(), *(edge.tolist() for edge in edges), strict=True))
        depths = (MM * self.depth_mm,) * (len(stations) - 1)
        return IrregularSpall(Side(self.gear), self.tooth, stations, depths, MM * self.edge_radius_mm)

    @property
    def probe_depths_m(self) -> tuple[float, ...]:
        """Depths of its strips for a check of its place alone [m]."""
        return (PROBE_M,) * (len(self.edges_mm) - 1)

    def problems(self, pair: GearPair, reading: str, prefix: str) -> Iterator[Problem]:
        """Yield edges that do not ascend or that cross, else what is wrong with its place."""
        for number, (one, two) in enumerate(pairwise(self.edges_mm), start=1):
            if not (isfinite(two[0]) and two[0] > one[0]):
                yield Problem(
                    f"{prefix}edges_mm.{number}", f"{two[0]:g} mm", f"allowed: beyond {one[0]:g} mm, ascending"
                )
                return
        for number, (_, low, high) in enumerate(self.edges_mm):
            if low > high:
                received = f"a lower edge at {low:g} mm above the upper one at {high:g} mm"
                yield Problem(f"{prefix}edges_mm.{number}", received, "allowed: edges that do not cross")
                return
        spall = self.model_copy(update={"tooth": 0}).spall(pair, reading)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = "depth_mm" if problem.name == "depth_m" else "edges_mm"
                yield Problem(prefix + key, problem.received, f"allowed: {problem.allowed}")
