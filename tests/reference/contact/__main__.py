"""Prints the tables of the contact checks, or fits the notch again."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator

from tests.reference.contact import case, comparisons


def edge_table() -> Iterator[str]:
    """Lines of the sink at one edge of a half plane over κF."""
    yield "| d/a | pressure cells | G |"
    yield "|---|---|---|"
    for ahead, cells, law in comparisons.one_edge():
        yield f"| {ahead:g} | {cells:.4f} | {law:.4f} |"


def notch_table() -> Iterator[str]:
    """Lines of what a notch adds at one edge over κF; about 15 s for each depth."""
    yield "| D [mm] | F [N/mm] | d/a | finite elements | N | error |"
    yield "|---|---|---|---|---|---|"
    for depth, line, ahead, fem, law in comparisons.notches(comparisons.NOTCH_DEPTHS_M):
        yield f"| {1e3 * depth:g} | {1e-3 * line:g} | {ahead:g} | {fem:.4f} | {law:.4f} | {law / fem - 1:+.1%} |"


def two_edge_table() -> Iterator[str]:
    """Lines of sinks over notched gaps at 60 N/mm; about 15 s for each length and depth."""
    yield "| l [mm] | D [mm] | 2 s/l | finite elements [µm] | law [µm] | share | law | notch's error |"
    yield "|---|---|---|---|---|---|---|---|"
    for p in comparisons.notched_gaps():
        if p.line_load_n_per_m == 60e3:
            yield (
                f"| {1e3 * p.length_m:g} | {1e3 * p.depth_m:g} | {2 * p.offset_m / p.length_m:.2f} "
                f"| {1e6 * p.solver_m:.3f} | {1e6 * p.sink_m:.3f} | {p.solver_share:.3f} | {p.share:.3f} "
                f"| {p.notch_error:+.1%} |"
            )


def loss_table() -> Iterator[str]:
    """Lines of losses of pair stiffness, in per cent."""
    counts = (100, 97, 80, 67, 50)
    yield "| land | F [N] | three dimensions | " + " | ".join(f"{n} slices" for n in counts) + " |"
    yield "|---" * (3 + len(counts)) + "|"
    for force in (300.0, 1200.0, 4000.0):
        for loss in comparisons.losses(force, counts):
            found = " | ".join(f"{loss.library[n]:.2f}" for n in counts)
            yield f"| {loss.land} | {force:.0f} | {loss.solver:.2f} | {found} |"


def teeth_table() -> Iterator[str]:
    """Lines of losses with teeth that bend across the face, in per cent, and of tilts of rigid and of bending teeth."""
    yield "| land | F [N] | three dimensions | 100 slices |"
    yield "|---|---|---|---|"
    for force in (300.0, 1200.0, 4000.0):
        for loss in comparisons.losses(force, (100,), teeth=case.BENDING):
            yield f"| {loss.land} | {force:.0f} | {loss.solver:.2f} | {loss.library[100]:.2f} |"
    yield ""
    yield "| teeth | tilt [µrad] | F [N] | approach [µm] | three dimensions | moment [N m] | three dimensions |"
    yield "|---|---|---|---|---|---|---|"
    for name, teeth in (("rigid", case.RIGID), ("bending", case.BENDING)):
        for force in (300.0, 1200.0):
            for t in comparisons.tilted(force, teeth=teeth):
                yield (
                    f"| {name} | {1e6 * t.tilt_rad:.0f} | {force:.0f} | {1e6 * t.approach_m:.3f} "
                    f"| {1e6 * t.solver_approach_m:.3f} | {t.moment_n_m:.3f} | {t.solver_moment_n_m:.3f} |"
                )


def tilt_table() -> Iterator[str]:
    """Lines of errors of the table over approach and tilt that the time loop reads."""
    from tests.reference.contact.tilted_table import tilt_errors

    yield "| damage of bench | tilt [µrad] | approach | F largest | F median | M largest | M median |"
    yield "|---|---|---|---|---|---|---|"
    for e in tilt_errors():
        where = "a corner touches" if e.touching else "farther"
        yield (
            f"| {e.state} | {1e6 * e.tilt_rad:.0f} | {where} | {e.force_largest:.1e} | {e.force_median:.1e} "
            f"| {e.moment_largest:.1e} | {e.moment_median:.1e} |"
        )


def helical_table() -> Iterator[str]:
    """Lines of load along sloping contact lines under tilts of the shafts; about a minute."""
    from tests.reference.contact.helical_line import helical_lines

    yield "| helix | F [N] | tilt [µrad] | moment [N m] | three dimensions | largest error of any 1 mm / mean |"
    yield "|---|---|---|---|---|---|"
    for e in helical_lines():
        yield (
            f"| {e.helix_deg:.0f}° | {e.force_n:.0f} | {1e6 * e.tilt_rad:.0f} | {e.moment_nm:.3f} "
            f"| {e.solver_moment_nm:.3f} | {e.largest:.1%} |"
        )


def face_table() -> Iterator[str]:
    """Lines of the table that the time loop reads, on the gearbox and damages of bench; the first state compiles."""
    from siggen.gears.contact.contact_table import contact_table
    from siggen.gears.contact.contact_table_error import contact_table_error
    from siggen.gears.contact.table_options import TableOptions, face_slices
    from tests.reference.contact.case import bench_damages

    pair, teeth, damages = bench_damages(("slight", "face_40", "face_80", "through_060", "through_100"))
    yield "| damage of bench | weakened, tilts | slices | columns | CPU a state | rms error of F | 95 % | largest |"
    yield "|---|---|---|---|---|---|---|---|"
    for both in (False, True):
        options = TableOptions(largest_force_n=4000.0, section_loss=both, tilts=both)
        contact_table(pair, damages["slight"], teeth, options)
        for name, damage in damages.items():
            spent = min(_seconds(lambda d=damage, o=options: contact_table(pair, d, teeth, o)) for _ in range(3))
            found = contact_table(pair, damage, teeth, options)
            error = contact_table_error(pair, damage, teeth, options, found, 1200.0)
            columns = len(found.curves) - options.healthy_columns
            slices, so = face_slices(pair, options), "yes" if both else "no"
            yield (
                f"| {name} | {so} | {slices} | {columns} | {1e3 * spent:.0f} ms "
                f"| {error.rms:.0e} | {error.most:.0e} | {error.largest:.0e} |"
            )


def _seconds(run: Callable[[], object]) -> float:
    start = time.process_time()
    run()
    return time.process_time() - start


def fit_notch() -> Iterator[str]:
    """Lines of the notch's coefficients, fitted again to finite elements; about two minutes."""
    from tests.reference.contact.notch_fit import fitted

    yield from (f"{name} = {value:.3f}" for name, value in fitted().items())


TABLES = {
    "edge": edge_table,
    "losses": loss_table,
    "teeth": teeth_table,
    "tilt": tilt_table,
    "table": face_table,
    "helical": helical_table,
    "notch": notch_table,
    "two_edges": two_edge_table,
    "notch_fit": fit_notch,
}


def main() -> None:
    """Print what the command line asks for: `edge` and `losses` without an argument."""
    parser = argparse.ArgumentParser(prog="python -m tests.reference.contact", description=__doc__)
    parser.add_argument("what", nargs="*", default=["edge", "losses"], choices=list(TABLES))
    for what in parser.parse_args().what:
        print(f"\n{what}\n")
        for line in TABLES[what]():
            print(line, flush=True)


if __name__ == "__main__":
    main()
