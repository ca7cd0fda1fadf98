"""Numbers of the background that no file sets, with their sources; drawn per gearbox, by name, like its keys.

"measured" is the range found on real machines, "source" a published number, "assumed" an engineering judgement.
"""

from __future__ import annotations

from typing import Annotated

from siggen.config import BaseSection, Bearings, Bursts, ForeignMesh, Machines, Rubbing, ShaftLines
from siggen.keys.distributions import LogUniform, Uniform
from siggen.keys.number import Number, Within

Drawn = Annotated[Number, Within()]


class BaseNumbers(BaseSection):
    """Of the base: natural frequencies on its mounts, and rubber's damping (assumed)."""

    horizontal_hz: Drawn = LogUniform(low=10.0, high=60.0)
    vertical_hz: Drawn = LogUniform(low=10.0, high=60.0)
    rocking_hz: Drawn = LogUniform(low=10.0, high=60.0)
    damping_ratio: Drawn = Uniform(low=0.05, high=0.15)


class BurstNumbers(Bursts):
    """Mean number per second (Poisson), time constant, and rise over the rms of the rubbing (assumed)."""

    rate_hz: Drawn = LogUniform(low=0.2, high=5.0)
    decay_ms: Drawn = Uniform(low=2.0, high=10.0)
    peak: Drawn = LogUniform(low=1.0, high=4.0)


class RubbingNumbers(Rubbing):
    """Of the force k r La^p √M along the line of action, r the roughness of both flanks that passes the contact.

    A flank's profile has the power spectrum (1 + (f/f_r)²)^-(H + 1/2), f_r the rolling speed over the roll-off length
    (assumed: below 0.8 mm, where roughness ends and waviness begins, ISO 4288), H = 3 - D with D = 2.15 ± 0.15 of most
    engineering surfaces (Persson 2014, abstract). The contact passes (1 + (f/f_c)²)^-1, f_c the rolling speed over 2π
    half-widths of Hertz. Across the face roughness averages over face/correlation (assumed: no source was found). La is
    the asperities' share of the load; the number of asperities that touch grows with it (Greenwood and Williamson 1966,
    from memory), so p is 1/2 where each pushes by itself, 1 where all push as one (derived). M with a power of the
    sliding speed of a pair (assumed: no source was found). The shafts modulate it: runout moves the load
    and the film between teeth and across the face (assumed; machines had 0.1 to 0.5 and 0.06 to 0.42 of all noise), and
    a share of its power returns with every turn of pinion and gear, half each (measured). The level is exp(s U -
    s²/2), s `level_std`: kurtosis 3 exp(s²) (measured: 0.1 to 0.6; assumed beyond). It changes within 10 ms (measured).
    """

    correlation_mm: Drawn = LogUniform(low=0.05, high=1.0)
    roll_off_mm: Drawn = LogUniform(low=0.1, high=0.5)
    hurst_exponent: Drawn = Uniform(low=0.7, high=1.0)
    asperity_exponent: Drawn = Uniform(low=0.5, high=1.0)
    sliding_exponent: Drawn = Uniform(low=0.5, high=1.0)
    pinion_depth: Drawn = LogUniform(low=0.2, high=0.9)
    gear_depth: Drawn = LogUniform(low=0.1, high=0.45)
    level_std: Drawn = LogUniform(low=0.1, high=1.25)
    level_time_ms: Drawn = LogUniform(low=1.0, high=8.0)
    replayed_share: Drawn = LogUniform(low=0.01, high=0.08)


class BearingNumbers(Bearings):
    """Of both bearings of a shaft: velocities of the bands (memory), and how the shaft modulates the noise (assumed).

    Velocities are rms values of the outer ring at 1800 turns a minute, in the bands of ISO 15242: 50, 300, 1800, 10000
    Hz.

    Balls that pass the outer ring `ball_pass_order` times a turn (derived) move the shaft by `compliance_um` (assumed);
    bearings with a `geometry` have their own. The cage lags by a share that a record draws (assumed: 0.5 to 2 %).
    The level is as of the rubbing, one course per shaft (measured).
    """

    low_um_s: Drawn = LogUniform(low=20.0, high=200.0)
    middle_um_s: Drawn = LogUniform(low=20.0, high=200.0)
    high_um_s: Drawn = LogUniform(low=20.0, high=200.0)
    compliance_um: Drawn = LogUniform(low=0.02, high=0.3)
    ball_pass_order: Drawn = Uniform(low=3.0, high=5.5)
    shaft_depth: Drawn = LogUniform(low=0.03, high=0.4)
    level_std: Drawn = LogUniform(low=0.1, high=0.6)
    level_time_ms: Drawn = LogUniform(low=1.0, high=8.0)


class MachineNumbers(Machines):
    """Of noise of density √(1 + (low_corner/f)^low_exponent) (measured shape; assumed), falling as 1/f above a corner.

    Levels were measured from 40 to 80 Hz alone; far above, frames and mounts pass little (assumed). It swells with the
    shaft of the machine and by chance, as the noise of bearings does (assumed; of two machines the envelope of all
    noise above 1.5 kHz swelled by 0.1 to 0.5 with a shaft, and its kurtosis was 3 to 4: measured).
    """

    low_corner_hz: Drawn = LogUniform(low=15.0, high=120.0)
    low_exponent: Drawn = Uniform(low=2.0, high=3.0)
    high_corner_hz: Drawn = LogUniform(low=200.0, high=1000.0)
    shaft_depth: Drawn = LogUniform(low=0.03, high=0.4)
    level_std: Drawn = LogUniform(low=0.1, high=0.6)
    level_time_ms: Drawn = LogUniform(low=1.0, high=8.0)


class ShaftNumbers(ShaftLines):
    """Misalignment and run-out of a coupling (assumed), its forces at 2x to 4x over 1x, balance of the rotor beside.

    Measured: velocity at -22 to -4, -26 to -8 and -32 to -12 dB. Grades G2.5 to G16 of ISO 21940-11, at the rated speed
    of the pinion's shaft; the gear's by the ratio.
    """

    offset_um: Drawn = LogUniform(low=10.0, high=100.0)
    second_db: Drawn = Uniform(low=-16.0, high=2.0)
    third_db: Drawn = Uniform(low=-16.5, high=1.5)
    fourth_db: Drawn = Uniform(low=-20.0, high=0.0)
    rotor_grade_mm_s: Drawn = LogUniform(low=2.5, high=16.0)
    rated_speed_hz: Drawn = 50.0


class ForeignNumbers(ForeignMesh):
    """Line h has h to minus `decay_exponent` of the first, and two sidebands beside it (measured).

    Where teeth share the load along a ramp, forces fall as 1/h² (derived; assumed about it). On machines accelerations
    fell with 0.5 to 1.2: the housing passes more of the higher lines.

    Its gears pass it on through their own shafts on bearings, which isolate above their natural frequency (assumed: as
    those that are simulated).
    """

    decay_exponent: Drawn = Uniform(low=1.5, high=2.2)
    sideband_db: Drawn = Uniform(low=-25.0, high=-10.0)
    support_hz: Drawn = LogUniform(low=800.0, high=2500.0)
    support_damping: Drawn = Uniform(low=0.02, high=0.07)
