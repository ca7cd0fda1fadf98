"""Section `variation`: how speed and torque vary within a record, relative to those of the operating point."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from siggen.keys.catalogue import CatalogueWord, with_entries
from siggen.keys.number import Number, Within, bounds
from siggen.keys.section import Section
from siggen.keys.usual import Usual

RARE = 4.0
"""Standard deviations that a slow random part hardly ever leaves; the band must carry the speed up to there."""

RAMP = "speed at the first and last sample over the operating point's, linear between"
RANDOM = "slow random part, relative; usual: 0.001 to 0.005 of speed, 0.01 to 0.05 of torque"
RIPPLE = "amplitude once and twice per revolution, relative; usual: 0.0002 to 0.001"


class SpeedVariation(Section):
    """Rotation of the pinion; numbers are drawn per specimen and operating point, random courses per record."""

    start_ratio: Annotated[Number, Within(least=0.01, most=10), Usual(0.05, 5)] = Field(default=1.0, description=RAMP)
    end_ratio: Annotated[Number, Within(least=0.01, most=10), Usual(0.05, 5)] = Field(default=1.0, description=RAMP)
    random_rms: Annotated[Number, Within(least=0, most=0.05), Usual(1e-05, 0.02)] = Field(
        default=0.0, description=RANDOM
    )
    ripple_once: Annotated[Number, Within(least=0, most=0.05), Usual(1e-05, 0.02)] = Field(
        default=0.0, description=RIPPLE
    )
    ripple_twice: Annotated[Number, Within(least=0, most=0.05), Usual(1e-05, 0.01)] = Field(
        default=0.0, description=RIPPLE
    )
    slip: Annotated[Number, Within(least=0, most=0.2), Usual(0.001, 0.2)] = Field(
        default=0.0,
        description="of the motor at dynamics.rated_torque_nm, or else at the largest torque; in proportion "
        "to the torque",
    )


class TorqueVariationSection(Section):
    """Torque about that of the operating point; motor and load balance on the mean."""

    random_rms: Annotated[Number, Within(least=0, most=0.1), Usual(0.0002, 0.1)] = Field(
        default=0.0, description=RANDOM
    )
    load_once: Annotated[Number, Within(least=0, most=2), Usual(0.0002, 0.4)] = Field(
        default=0.0, description="of the load torque once per revolution of its shaft, relative"
    )
    line_ripple: Annotated[Number, Within(least=0, most=2), Usual(0.0002, 0.5)] = Field(
        default=0.0, description="of the motor torque at twice the line frequency of 50 Hz, relative"
    )


class Variation(Section):
    """What varies within a record; nothing by default."""

    like: Annotated[str | None, CatalogueWord("variation")] = Field(
        default=None, description="word of the catalogue whose numbers it takes over", exclude=True
    )
    speed: SpeedVariation = Field(default=SpeedVariation(), description="rotation of the input shaft")
    torque: TorqueVariationSection = Field(default=TorqueVariationSection(), description="torque of motor and load")

    @model_validator(mode="before")
    @classmethod
    def _with_entry(cls, value: Any) -> Any:
        return with_entries(value, like="variation")

    @property
    def active(self) -> bool:
        """Whether the section says anything; then records have the labels of the variation."""
        return self != Variation()

    @property
    def speed_ratios(self) -> tuple[float, float]:
        """Lowest and highest speed within a record over that of the operating point."""
        s = self.speed
        spread = RARE * bounds(s.random_rms)[1] + bounds(s.ripple_once)[1] + bounds(s.ripple_twice)[1]
        lowest = min(bounds(s.start_ratio)[0], bounds(s.end_ratio)[0]) * (1.0 - spread) * (1.0 - bounds(s.slip)[1])
        return lowest, max(bounds(s.start_ratio)[1], bounds(s.end_ratio)[1]) * (1.0 + spread)

    @property
    def least_torques(self) -> dict[str, float]:
        """Least torque of load and motor within a record over its mean, at the largest draws."""
        slow = RARE * bounds(self.torque.random_rms)[1]
        pulsating = {"load": self.torque.load_once, "motor": self.torque.line_ripple}
        return {body: 1.0 - slow - bounds(number)[1] for body, number in pulsating.items()}
