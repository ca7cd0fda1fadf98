"""Prints the tables of the finite-element check, makes its figures, or makes the calibration again."""

from __future__ import annotations

import argparse

from tests.reference.finite_elements import (
    comparison,
    coupling,
    crack_comparison,
    face_kernel,
    face_losses,
    helical_tooth,
    neighbour_face,
    part_crack_comparison,
    ring_bending,
    single_pair,
)

TABLES = {
    "models": comparison.model_table,
    "plane_strain": comparison.plane_strain_table,
    "poisson": comparison.poisson_table,
    "convergence": comparison.convergence_table,
    "coupling": coupling.coupling_table,
    "double_contact": coupling.double_contact_table,
    "held_out_coupling": coupling.held_out_coupling_table,
    "held_out": comparison.held_out_table,
    "variants": comparison.variants_table,
    "outside": comparison.outside_table,
    "spots": comparison.spots,
    "crack": crack_comparison.crack_table,
    "crack_convergence": crack_comparison.crack_convergence_table,
    "part_crack": part_crack_comparison.part_crack_table,
    "face": face_kernel.kernel_table,
    "face_losses": face_losses.loss_table,
    "helical": helical_tooth.helical_table,
    "helical_neighbours": helical_tooth.helical_neighbour_table,
    "ring_bending": ring_bending.ring_bending_table,
    "misalignment": face_losses.misalignment_table,
    "neighbour_face": neighbour_face.neighbour_face_table,
    "single_pair": single_pair.single_pair_table,
}

ACTIONS = ("figures", "calibrate", "couple", "fit_crack")


def main() -> None:
    """Run what the command line asks for: `models` (about 5 s) without an argument."""
    parser = argparse.ArgumentParser(prog="python -m tests.reference.finite_elements", description=__doc__)
    parser.add_argument("what", nargs="*", default=["models"], choices=[*TABLES, *ACTIONS])
    for what in parser.parse_args().what:
        if what in TABLES:
            print(f"\n{what}\n", *TABLES[what](), sep="\n")
        elif what == "figures":
            from tests.reference.finite_elements.figures import write_figures

            print(*write_figures(), sep="\n")
        elif what == "couple":
            from tests.reference.finite_elements.coupling_fit import couple

            print(*couple().items(), sep="\n")
        elif what == "fit_crack":
            from tests.reference.finite_elements.crack_fit import fit_crack

            print(*fit_crack().items(), sep="\n")
        else:
            from tests.reference.finite_elements.calibration_file import calibrate

            print(*calibrate().items(), sep="\n")


if __name__ == "__main__":
    main()
