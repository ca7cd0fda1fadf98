"""How many points of every record a page holds, so that it stays below its size."""

from __future__ import annotations

from dataclasses import dataclass, replace

SMALL_BYTES = 3_900_000
"""Signals of a page; with indicators, names and program it stays below 5 MB."""

FULL_BYTES = 27_000_000
"""The same for all samples, below 30 MB."""

BYTES_PER_POINT = 8 / 3
"""A 16-bit number in base 64."""

LEAST_SCALE = 0.05
MOST_BUCKETS = 1_500
MOST_FINE_SAMPLES = 16_384


@dataclass(frozen=True, slots=True)
class Detail:
    """Points of a channel of one record.

    Attributes
    ----------
    buckets : int
        Stretches of the whole record that are drawn by their minimum and maximum.
    fine_samples : int
        Samples from the first pulse on that are all kept.
    order_points : int
        Points of the order spectrum.
    envelope_points : int
        Points of the envelope spectrum.
    steps_per_tooth : int
        Angle steps of averages.
    """

    buckets: int
    fine_samples: int
    order_points: int
    envelope_points: int
    steps_per_tooth: int

    def points(self, teeth: int) -> int:
        """Return the 16-bit numbers of a channel of a record; an extreme has a place and a value."""
        averages = teeth * self.steps_per_tooth
        return 4 * self.buckets + self.fine_samples + self.order_points + self.envelope_points + averages


WANTED = Detail(550, 1_000, 1_500, 400, 24)
WANTED_FULL = Detail(550, 0, 6_000, 1_000, 24)


def page_detail(channel_records: int, samples: int, teeth: int, *, full: bool) -> Detail:
    """Return the detail of a page.

    Parameters
    ----------
    channel_records : int
        Channels times records.
    samples : int
        Samples of a record.
    teeth : int
        Teeth of pinion and gear together.
    full : bool
        Whether all samples are wanted; so many as fit are kept.
    """
    room = (FULL_BYTES if full else SMALL_BYTES) / BYTES_PER_POINT / max(channel_records, 1)
    if full:
        rest = int(room - WANTED_FULL.points(teeth))
        return replace(WANTED_FULL, fine_samples=min(samples, max(rest, WANTED.fine_samples)))
    scale = min(1.0, max(room / WANTED.points(teeth), LEAST_SCALE))
    spare = max(int(room) - WANTED.points(teeth), 0)
    # first to the whole record, so that it looks as dense as the stretch that is kept whole
    more = min(spare // 4, MOST_BUCKETS - WANTED.buckets)
    return Detail(
        int(WANTED.buckets * scale) + more,
        min(int(WANTED.fine_samples * scale) + spare - 4 * more, MOST_FINE_SAMPLES, samples),
        int(WANTED.order_points * scale),
        int(WANTED.envelope_points * scale),
        max(int(WANTED.steps_per_tooth * scale), 4),
    )
