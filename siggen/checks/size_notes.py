"""Notes on a set that is too small to judge a model by: few gearboxes in the test split, short records."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.errors import counted
from siggen.gearbox.design import SetDesign
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.number import bounds
from siggen.planning.plan import specimen_count

FEWEST_TESTED = 6
WINDOW_TURNS, FEWEST_WINDOWS = 8, 2


def size_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield a sentence on each."""
    config = gearbox.config
    tested = specimen_count(SetDesign(config), "test")
    if tested < FEWEST_TESTED and config.splits.by != "pair":
        share, block = config.splits.test, config.splits.train + config.splits.validation + config.splits.test
        more = f"specimens: {-(-FEWEST_TESTED * block // share)} or more" if share else "a share of splits.test"
        yield (
            f"splits: {counted(tested, 'gearbox', 'gearboxes')} in the test split: below {FEWEST_TESTED} the limits of "
            f"every score are too wide to tell models apart; take {more}"
        )
    slowest_hz = min(abs(bound) for point in config.operating_points for bound in bounds(point.speed_hz))
    slowest_hz *= config.variation.speed_ratios[0]
    turns, wanted = config.duration_s * slowest_hz, FEWEST_WINDOWS * WINDOW_TURNS
    if turns < wanted:
        yield (
            f"duration_s: the slowest record has {turns:.3g} turns of the first shaft, fewer than {FEWEST_WINDOWS} "
            f"windows of {WINDOW_TURNS}, which models read; take {wanted / slowest_hz:.2g} s or more"
        )
