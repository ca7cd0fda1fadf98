"""Independent, slow evaluation of tooth compliances: adaptive quadrature in x of a tooth outline that is inverted
numerically.

Shares no code with the package besides the gear's defining numbers: closed forms of the outline are written out
again, sections of pitted teeth are cut out of a polygon-free interval list in plain Python, and scipy's adaptive rule
does the integrals.
"""

from __future__ import annotations

from itertools import pairwise
from math import asin, cos, pi, sin, sqrt, tan

import numpy as np
from scipy.integrate import quad

from siggen.damage.pits import FlankPit


class Outline:
    """Involute outline of a gear in its roll angle, from teeth, module, shift and pressure angle alone."""

    def __init__(self, gear):
        angle = gear.pressure_angle_rad
        self.radius = 0.5 * gear.module_m * gear.teeth * cos(angle)
        self.half = pi / (2 * gear.teeth) + tan(angle) - angle + 2 * gear.profile_shift * tan(angle) / gear.teeth

    def x(self, roll):
        return self.radius * (cos(roll - self.half) + roll * sin(roll - self.half) - cos(self.half))

    def h(self, roll):
        return self.radius * (roll * cos(roll - self.half) - sin(roll - self.half))

    def slope(self, roll):
        return self.radius * roll * cos(roll - self.half)


def spall_intervals(spall, x):
    """Intervals of the face that a polygonal spall covers at a height, each with its depth there (even-odd rule)."""
    corners = spall.outline.vertices_m
    ends = []
    for (x1, w1), (x2, w2) in zip(corners, corners[1:] + corners[:1], strict=True):
        if (x1 <= x) != (x2 <= x):
            ends.append(w1 + (x - x1) / (x2 - x1) * (w2 - w1))
    heights = [height for height, _ in corners]
    u = (2 * x - max(heights) - min(heights)) / (max(heights) - min(heights))
    depth = spall.depth_m * (sqrt(max(1 - u * u, 0.0)) if spall.floor == "dish" else 1.0)
    ends.sort()
    return [(pair, depth) for pair in zip(ends[::2], ends[1::2], strict=True)]


def depth_integrals(pits, x, h, face_width):
    """S0, S1, S2 of one section: the face is cut at every outline, then adaptive quadrature of the largest depth."""
    present = [p for p in pits if isinstance(p, FlankPit) and abs(x - p.height_m) < p.semi_axis_profile_m]
    spalls = [(interval, d) for s in pits if not isinstance(s, FlankPit) for interval, d in spall_intervals(s, x)]
    if not present and not spalls:
        return 0.0, 0.0, 0.0

    def depth(w):
        deepest = max((d for (low, high), d in spalls if low < w < high), default=0.0)
        for p in present:
            rest = 1 - ((x - p.height_m) / p.semi_axis_profile_m) ** 2 - ((w - p.face_m) / p.semi_axis_face_m) ** 2
            if rest > 0:
                deepest = max(deepest, p.depth_m * (sqrt(rest) if p.floor == "dish" else 1.0))
        return deepest

    cuts = {0.0, face_width}
    for p in present:
        reach = p.semi_axis_face_m * sqrt(1 - ((x - p.height_m) / p.semi_axis_profile_m) ** 2)
        cuts |= {min(max(p.face_m + side * reach, 0.0), face_width) for side in (-1, 1)}
    cuts |= {min(max(end, 0.0), face_width) for interval, _ in spalls for end in interval}
    cuts = sorted(cuts)
    total = np.zeros(3)
    dishes = any(p.floor == "dish" for p in present)
    for low, high in pairwise(cuts):
        if not dishes:  # constant depth between cuts
            d = depth(0.5 * (low + high))
            total += (high - low) * np.array([d, d * (h - d / 2), (h**3 - (h - d) ** 3) / 3])
            continue
        for i, term in enumerate((lambda d: d, lambda d: d * (h - d / 2), lambda d: (h**3 - (h - d) ** 3) / 3)):
            # Sine substitution for the dishes' square-root ends; the adaptive rule finds equal depths by itself.
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            total[i] += quad(
                lambda t, term=term, middle=middle, half=half: term(depth(middle - half * cos(t))) * half * sin(t),
                0,
                pi,
                epsabs=0,
                epsrel=1e-10,
                limit=1000,
            )[0]
    return tuple(total)


def section(pits, x, h, face_width):
    """Area and second moment of a section with pits, about its own neutral axis."""
    s0, s1, s2 = depth_integrals(pits, x, h, face_width)
    area = 2 * h * face_width - s0
    return area, 2 / 3 * h**3 * face_width - s2 - s1**2 / area


def beam_compliances(pair, gear, roll, start, pits=(), points=()):
    """Bending, shear and axial compliance of the involute part above the roll `start`, loaded at `roll`."""
    outline = Outline(gear)
    slant, d, reach = roll - outline.half, outline.x(roll), outline.h(roll)
    young, width = pair.youngs_modulus_pa, pair.face_width_m
    modulus = young / (2 * (1 + pair.poisson_ratio))

    def integrand(kind, psi):
        x, h = outline.x(psi), outline.h(psi)
        area, inertia = section(pits, x, h, width) if pits else (2 * h * width, 2 / 3 * h**3 * width)
        value = {
            "bending": (cos(slant) * (d - x) - sin(slant) * reach) ** 2 / (young * inertia),
            "shear": 1.2 * cos(slant) ** 2 / (modulus * area),
            "axial": sin(slant) ** 2 / (young * area),
        }[kind]
        return value * outline.slope(psi)

    inside = sorted({start, roll, *(p for p in points if start < p < roll)})

    def total(kind):
        return sum(
            quad(lambda psi, kind=kind: integrand(kind, psi), low, high, epsabs=0, epsrel=1e-11, limit=400)[0]
            for low, high in pairwise(inside)
        )

    return np.array([total(kind) for kind in ("bending", "shear", "axial")])


def alpha_form(pair, gear, roll):
    """Base-circle beam in the literature's angle alpha: bending, shear, axial by adaptive quadrature."""
    outline = Outline(gear)
    half, load = outline.half, roll - outline.half
    young, width, nu = pair.youngs_modulus_pa, pair.face_width_m, pair.poisson_ratio

    def thick(a):
        return sin(a) + (half - a) * cos(a)

    def bending(a):
        lever = 1 + cos(load) * ((half - a) * sin(a) - cos(a))
        return 3 * lever**2 * (half - a) * cos(a) / (2 * young * width * thick(a) ** 3)

    def shear(a):
        return 1.2 * (1 + nu) * (half - a) * cos(a) * cos(load) ** 2 / (young * width * thick(a))

    def axial(a):
        return (half - a) * cos(a) * sin(load) ** 2 / (2 * young * width * thick(a))

    return np.array([quad(f, -load, half, epsabs=0, epsrel=1e-12)[0] for f in (bending, shear, axial)])


def straight_root_closed_form(pair, gear, roll):
    """Bending, shear and axial compliance that the straight piece below the base circle adds (closed forms)."""
    outline = Outline(gear)
    half, load = outline.half, roll - outline.half
    root = gear.root_radius_m
    alpha3, share = asin(outline.radius * sin(half) / root), root / outline.radius
    young, width, nu = pair.youngs_modulus_pa, pair.face_width_m, pair.poisson_ratio
    ends = (1 - share * cos(load) * cos(alpha3)) ** 3 - (1 - cos(load) * cos(half)) ** 3
    length = cos(half) - share * cos(alpha3)
    return np.array(
        [
            ends / (2 * young * width * cos(load) * sin(half) ** 3),
            1.2 * (1 + nu) * cos(load) ** 2 * length / (young * width * sin(half)),
            sin(load) ** 2 * length / (2 * young * width * sin(half)),
        ]
    )
