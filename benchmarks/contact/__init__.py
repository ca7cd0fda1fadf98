"""Contact across the face beside independent solvers: `python -m benchmarks contact`, `-m benchmarks.contact TABLE`."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.row import Row

SINK_GOAL, SINK_GOAL_M = 0.02, 0.02e-6
NOTCH_GOAL_DEEP, NOTCH_GOAL_NEAR = 0.10, 0.20
LOSS_GOAL_POINTS = 2.0
TABLE_GOAL_S = 40e-3
SLICES = 100


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield errors against pressure cells, finite elements and the contact in three dimensions, and the cost."""
    yield _half_plane_row(quick)
    yield from _notch_rows(quick)
    yield from _loss_rows(quick)
    yield from _cost_rows(quick)


def _half_plane_row(quick: bool) -> Row:
    from benchmarks.contact.comparisons import half_plane_gaps

    pairs = list(half_plane_gaps(11 if quick else 41))
    worst = max(pairs, key=lambda p: abs(p.error_m))
    share = max(abs(p.share - p.solver_share) for p in pairs)
    met = all(abs(p.error_m) <= max(SINK_GOAL * p.solver_m, SINK_GOAL_M) for p in pairs)
    what = f"sink over gaps of 0.3 to 1.5 mm, {len(pairs)} places and loads"
    measured = f"largest error {1e9 * abs(worst.error_m):.1f} nm, share of the edges {share:.4f}"
    return Row(what, measured, "pressure cells on a half plane", None, "2 % or 20 nm", met)


def _notch_rows(quick: bool) -> Iterator[Row]:
    what = "what a notch adds at one edge"
    try:
        import skfem  # noqa: F401 - only whether it is there
    except ImportError:
        yield Row(what, "", "finite elements: not installed (the extra 'fem')")
        return
    from benchmarks.contact.comparisons import NOTCH_DEPTHS_M, notched_gaps, notches

    found = list(notches(NOTCH_DEPTHS_M[-1:] if quick else NOTCH_DEPTHS_M))
    deep = max(abs(law / fem - 1.0) for _, _, ahead, fem, law in found if ahead <= -1.0)
    near = max(abs(law / fem - 1.0) for _, _, ahead, fem, law in found if -1.0 < ahead <= 1.0)
    beyond = max(abs(law - fem) for _, _, ahead, fem, law in found if ahead > 1.0)
    fem = "plane finite elements"
    yield Row(f"{what}, d/a <= -1", f"largest error {deep:.1%}", fem, None, "10 %", deep <= NOTCH_GOAL_DEEP)
    yield Row(f"{what}, d/a to 1", f"largest error {near:.1%}", fem, None, "20 %", near <= NOTCH_GOAL_NEAR)
    yield Row(f"{what}, d/a = 1.5", f"largest error {beyond:.3f} κF", fem)
    lengths = (0.3e-3,) if quick else (0.3e-3, 0.5e-3, 0.8e-3, 1.5e-3)
    pairs = list(notched_gaps(lengths, NOTCH_DEPTHS_M[-1:] if quick else NOTCH_DEPTHS_M))
    error = max(abs(p.error_m) for p in pairs)
    share = max(abs(p.share - p.solver_share) for p in pairs)
    met = all(
        abs(p.error_m) <= max(SINK_GOAL * p.solver_m, SINK_GOAL_M) for p in pairs if p.offset_m <= 0.5 * p.length_m
    )
    measured = f"largest error {1e9 * error:.0f} nm, share of the edges {share:.3f}"
    yield Row(f"sink over notched gaps, {len(pairs)} places and loads", measured, fem, None, "2 % or 20 nm", met)


def _loss_rows(quick: bool) -> Iterator[Row]:
    from benchmarks.contact.case import BENDING, RIGID
    from benchmarks.contact.comparisons import losses

    for force in (1200.0,) if quick else (300.0, 1200.0, 4000.0):
        for name, teeth in (("rigid", RIGID), ("bending", BENDING)):
            for loss in losses(force, (SLICES,), teeth=teeth):
                library = loss.library[SLICES]
                yield Row(
                    f"loss of pair stiffness, {name} teeth, {loss.land}, {force:.0f} N, {SLICES} slices",
                    f"{library:.2f} %",
                    f"contact in three dimensions: {loss.solver:.2f} %",
                    None,
                    "2 points",
                    abs(library - loss.solver) <= LOSS_GOAL_POINTS,
                )


def _cost_rows(quick: bool) -> Iterator[Row]:
    from benchmarks.contact.cost import SPALLS, slice_errors, table

    for name, options in SPALLS.items():
        for slices in (SLICES,) if quick else (40, SLICES):
            cost = min(table(slices, options)[2] for _ in range(3))
            what = f"table of 120 positions x 33 approaches, spall {name}, {slices} slices"
            error = "{:.1e} / {:.1e}, moment {:.1e}".format(*slice_errors(slices, options))
            measured = f"{1e3 * cost:.0f} ms of CPU, {1e3 * cost / 120:.2f} ms a position"
            beside = f"largest / rms error of F over 1,200 N against 200 slices: {error}"
            yield Row(what, measured, beside, None, "40 ms", cost <= TABLE_GOAL_S)
    from benchmarks.contact.loop_options import approach_table_cost, options

    nine = next(o for o in options() if o.name == "table, cubic with slopes over 9 approaches")
    cost = min(approach_table_cost(9, SLICES) for _ in range(3))
    measured = f"{1e3 * cost:.0f} ms of CPU"
    beside = f"largest error of F between approaches over 1,200 N: {nine.force_largest:.1e}"
    what = f"the same with 9 approaches and their slopes, skewed and wavy, {SLICES} slices"
    yield Row(what, measured, beside, None, "40 ms", cost <= TABLE_GOAL_S)
