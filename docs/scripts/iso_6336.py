"""Tables of docs/understand/methods.md: mean mesh stiffness of pairs by our models beside ISO 6336-1, method B."""

from math import cos, radians

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.gears.spur_gear import transverse_gear
from siggen.mesh.mesh_stiffness import pair_stiffness, rolls_at
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import axial_part

MODULE_M, FACE_WIDTH_M, RADIUS_RATIO = 3e-3, 20e-3, 3.0
LINE_LOAD_N_PER_M = 300e3
PAIRS = (
    (18, 18),
    (18, 25),
    (18, 47),
    (18, 90),
    (20, 20),
    (20, 60),
    (23, 31),
    (23, 77),
    (25, 25),
    (25, 50),
    (30, 30),
    (30, 45),
    (30, 100),
    (35, 35),
    (40, 40),
    (40, 80),
    (47, 47),
    (60, 60),
    (60, 100),
    (100, 100),
)
HELICAL_PAIRS, HELICES_DEG = ((18, 47), (25, 50), (40, 80)), (0, 10, 20, 30)
MODELS = {
    "base_circle": StiffnessOptions("base_circle"),
    "rack_trochoid": StiffnessOptions("rack_trochoid"),
    "calibrated": StiffnessOptions(),
    "calibrated, weber_banaschek": StiffnessOptions(
        hertz="weber_banaschek", hertz_force_n=LINE_LOAD_N_PER_M * FACE_WIDTH_M
    ),
}


def gear_pair(first: int, second: int, helix_deg: float = 0.0) -> GearPair:
    """Return a standard pair whose roots are three times their bores."""
    helix = radians(helix_deg)
    gears = (
        SpurGear(z, MODULE_M, radians(20), 0.0, 1.0, 0.25, (z / 2 / cos(helix) - 1.25) * MODULE_M / RADIUS_RATIO)
        for z in (first, second)
    )
    return GearPair(*(transverse_gear(gear, helix) for gear in gears), FACE_WIDTH_M, 206e9, 0.3, helix_rad=helix)


def iso_single(pair: GearPair) -> tuple[float, float]:
    """Return c'_th cos β and c' of ISO 6336-1, equations 82 to 94, without shift [N/(mm um)].

    C_M 0.8, C_R 1, C_B 0.975. Numbers of teeth are those of the normal section, z/cos³ β.
    """
    share = cos(pair.helix_rad)
    first, second = (gear.teeth / share**3 for gear in (pair.pinion, pair.gear))
    theory = share / (0.04723 + 0.15551 / first + 0.25791 / second)
    return theory, theory * 0.8 * (1 + 0.5 * (1.2 - 1.25))


def body_twist(pair: GearPair) -> float:
    """Return the twist of both rings between root and bore as compliance along the line of action [mm um/N].

    R_b^2 (1/r_bore^2 - 1/R_f^2)/(4 pi G L) each: exact for a ring under torsion, times the face width here.
    """
    shear_modulus = 206e9 / 2.6
    total = sum(g.base_radius_m**2 * (g.bore_radius_m**-2 - g.root_radius_m**-2) for g in (pair.pinion, pair.gear))
    return total / (4 * np.pi * shear_modulus) * 1e9


def ours(pair: GearPair, options: StiffnessOptions, *, still: bool = False) -> tuple[float, float]:
    """Return largest single-pair stiffness and mean stiffness over a pitch, each over the face width [N/(mm um)].

    `still`: as if bodies of helical gears did not bend along their axes; of the mean alone.
    """
    start, end = pair.contact_start_m, pair.contact_end_m
    nodes, weights = np.polynomial.legendre.leggauss(60)
    position = start + 0.5 * (end - start) * (1 + nodes)
    stiffness = pair_stiffness(pair, position, options)
    if still:
        rolls = zip(("pinion", "gear"), rolls_at(pair, position), strict=True)
        stiffness = 1 / (1 / stiffness - sum(axial_part(pair, which, roll, options) for which, roll in rolls))
    # Every pair passes each position once per pitch: the mean is the integral over the whole path by the pitch.
    mean = 0.5 * (end - start) * float(weights @ stiffness) / pair.base_pitch_m
    along = pair_stiffness(pair, np.linspace(start, end, 801), options)
    return float(along.max()) / FACE_WIDTH_M / 1e9, mean / FACE_WIDTH_M / 1e9


def main() -> None:
    """Print the table of docs/understand/methods.md."""
    print("| z1/z2 | ε | c'th | c' | cγα of c'th | cγα | " + " | ".join(MODELS) + " |")
    print("|---" * (6 + len(MODELS)) + "|")
    ratios = {name: [] for name in MODELS}
    singles = {name: [] for name in MODELS}
    untwisted = {name: [] for name in MODELS}
    for first, second in PAIRS:
        pair = gear_pair(first, second)
        theory, corrected = iso_single(pair)
        factor = 0.75 * pair.contact_ratio + 0.25
        cells = []
        for name, options in MODELS.items():
            single, mean = ours(pair, options)
            ratios[name].append(mean / (theory * factor))
            singles[name].append(single / theory)
            untwisted[name].append(1 / (1 / single - body_twist(pair)) / theory)
            cells.append(f"{mean:.1f} ({ratios[name][-1]:.2f})")
        values = f"{theory:.1f} | {corrected:.1f} | {theory * factor:.1f} | {corrected * factor:.1f}"
        print(f"| {first}/{second} | {pair.contact_ratio:.2f} | {values} | " + " | ".join(cells) + " |")
    print("\nover the pairs, smallest and largest:\n")
    print(
        "| model | mean / cγα of c'th | largest single pair / c'th | the same without twist of the rings | "
        "mean / (largest single pair x (0.75 ε + 0.25)) |"
    )
    print("|---|---|---|---|---|")
    for name in MODELS:
        shape = np.array(ratios[name]) / np.array(singles[name])
        spans = [f"{min(v):.2f} to {max(v):.2f}" for v in (ratios[name], singles[name], untwisted[name], shape)]
        print(f"| {name} | " + " | ".join(spans) + " |")
    helical()


def helical() -> None:
    """Print the table of helical pairs, by calibrated teeth."""
    print(
        "\n| z1/z2 | β | transverse ε | cγα of c'th cos β | calibrated | the same, bodies still along the axis "
        "| calibrated, weber_banaschek |\n" + "|---" * 7 + "|"
    )
    for first, second in HELICAL_PAIRS:
        for helix_deg in HELICES_DEG:
            pair = gear_pair(first, second, helix_deg)
            theory = iso_single(pair)[0] * (0.75 * pair.contact_ratio + 0.25)
            plain = MODELS["calibrated"]
            means = [ours(pair, plain)[1], ours(pair, plain, still=True)[1]]
            means.append(ours(pair, MODELS["calibrated, weber_banaschek"])[1])
            cells = " | ".join(f"{mean:.1f} ({mean / theory:.2f})" for mean in means)
            print(f"| {first}/{second} | {helix_deg}° | {pair.contact_ratio:.2f} | {theory:.1f} | {cells} |")


if __name__ == "__main__":
    main()
