"""A figure of what speaks for an angle without a tacho: its speed, the agreement of halves, lines about the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from diagnostics.page.style import GEAR_COLOUR, HEALTHY_COLOUR, PINION_COLOUR, new_figure
from diagnostics.signal.shaft_angle import AGREEMENT, ShaftAngle

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ORDERS_SHOWN, POINTS = 3.0, 601

ANGLE_CAPTION = (
    "Angle without a tacho. Top: speed of the first shaft. Middle: what two disjoint halves of the mesh lines ask to "
    "correct; they may differ by 0.1 tooth pitch. Bottom: lines about the mesh harmonics, mean of all, over the noise; "
    "marks are those of the given teeth."
)


def angle_figure(angle: ShaftAngle) -> Figure:
    """Return the evidence of an angle, or of a speed only."""
    figure, axes = new_figure(3, 1, height_in=5.4)
    speed, halves, lines = axes[:, 0]
    speed.plot(angle.time_s, np.gradient(angle.turns, angle.time_s), color=HEALTHY_COLOUR)
    speed.set(ylabel="speed [Hz]", title=f"{angle.outcome}: {angle.speed_hz:.4f} Hz")
    for correction, colour in ((angle.halves.first, PINION_COLOUR), (angle.halves.second, GEAR_COLOUR)):
        halves.plot(angle.halves.time_s, correction, color=colour)
    for limit in (-0.5 * AGREEMENT, 0.5 * AGREEMENT):
        halves.axhline(limit, color=HEALTHY_COLOUR, linestyle=":")
    halves.set(xlabel="time [s]", ylabel="halves [pitches]")
    away = np.linspace(-ORDERS_SHOWN, ORDERS_SHOWN, POINTS)
    first, second = angle.teeth
    highest = angle.levels.level.size / angle.levels.revolutions - ORDERS_SHOWN
    harmonics = np.arange(1, max(2, int(highest / first) + 1))
    level = np.mean([angle.levels.said(h * first + away, np.ones(1))[0] for h in harmonics], axis=0)
    steps = np.arange(-int(ORDERS_SHOWN * second / first), int(ORDERS_SHOWN * second / first) + 1) * first / second
    for places, colour in ((steps, GEAR_COLOUR), (np.arange(-2.0, 3.0), PINION_COLOUR)):
        for place in places:
            lines.axvline(place, color=colour, alpha=0.35)
    lines.plot(away, level, color="black")
    lines.set(xlabel="orders from the mesh line", ylabel="lines [nats]", xlim=(-ORDERS_SHOWN, ORDERS_SHOWN))
    return figure
