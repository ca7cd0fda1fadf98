"""The background of one record block after block: its forces, and white noise before the floor's shape."""

from __future__ import annotations

from math import sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, Floor
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen
from siggen.record.background import floor_labels, line_forces, with_levels
from siggen.record.background_course import Course, course_at
from siggen.record.force_floor import bearing_strength, floor_levels, random_levels
from siggen.record.rubbing_blocks import RubbingForce
from siggen.specimen.background import FLOOR_INPUTS, SpecimenBackground
from siggen.specimen.block_responses import BACKGROUND, FLOOR, Input


class BackgroundBlocks:
    """All parts of a record's background from sample `first` on, over `length` samples.

    `labels` are there from the first block on. Nothing is drawn from the state.
    """

    def __init__(
        self,
        config: Config,
        specimen: Specimen,
        record: PlannedRecord,
        background: SpecimenBackground,
        first: int,
        length: int,
    ) -> None:
        self._of_record = (config, specimen, record)
        self._background, self._next, self._length = background, first, length
        assert config.background is not None
        course = self._course(1)
        self._asked = config.background.floor
        self._section = with_levels(config.background, background.section, course)
        self._levels = {} if self._section.floor is None else random_levels(self._section.floor, course)
        self._generators = {name: course.of_record(f"background.floor.{name}") for name in FLOOR_INPUTS}
        self._rubbing: RubbingForce | None = None
        self.labels: dict[str, object] = {}

    @property
    def floor(self) -> Floor | None:
        """The floor as drawn for the record."""
        return self._section.floor

    def take(self, count: int) -> dict[Input, FloatArray]:
        """Return the next values (count,) of every input."""
        course = self._course(count)
        forces, labels = line_forces(self._section, course, self._background)
        if self._section.rubbing is not None:
            if self._rubbing is None:
                self._rubbing = RubbingForce(self._section, self._section.rubbing, course, self._length)
            forces["mesh"] = self._rubbing.take(course)
            labels |= self._rubbing.labels
        found = {Input(BACKGROUND, name): force for name, force in forces.items()}
        if self._section.floor is not None:
            labels |= floor_labels(self._asked, self._section.floor)
            found |= self._white(self._section.floor, course)
        self.labels = self.labels or labels
        self._next += count
        return found

    def _course(self, count: int) -> Course:
        return course_at(*self._of_record, self._next, count)

    def _white(self, floor: Floor, course: Course) -> dict[Input, FloatArray]:
        """Return noise of the floor's density above its low corner, modulated where shafts do that."""
        found = {}
        random = {shaft: level.take(course.length) for shaft, level in self._levels.items()}
        for name, level in floor_levels(floor).items():
            values = self._generators[name].standard_normal(course.length)
            values *= level * sqrt(0.5 * course.fs_hz)
            strength = bearing_strength(floor, course, name, random)
            if strength is not None:
                values *= np.sqrt(strength)
            found[Input(FLOOR, name)] = values
        return found
