"""Where pits sit on a flank: layers one above the other, or a cluster.

Source: paper A, sections 2.1 and 3.3 (layers of equal pits, the first at the height mu); numbers and spacings are
free, as the paper does not give them. Only positions: sizes belong to the caller. Fewer pits of a layout are always
the first ones of more.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray


def layered_centres(
    layers: int,
    per_layer: int,
    spacing_face_m: float,
    spacing_height_m: float,
    first_height_m: float,
    face_centre_m: float,
    *,
    between: bool = False,
) -> tuple[FloatArray, FloatArray]:
    """Return heights and face coordinates of pits in aligned layers, layer by layer upwards, (n,) each [m].

    Inside a layer pits go from the centre outwards on one lattice, 0, +1, -1, +2, ... spacings from `face_centre_m`,
    so that a layer of fewer pits is a subset of a layer of more. An even number therefore stands half a spacing off
    centre, unless `between` puts the lattice at +-1/2, +-3/2, ... spacings, where odd numbers stand off centre
    instead.

    Parameters
    ----------
    layers, per_layer : int
        At least 1 each.
    spacing_face_m, spacing_height_m : float
        Distance of neighbours across the face and of layers along the height [m].
    first_height_m, face_centre_m : float
        Height of the first layer and centre of the layers across the face [m].
    between : bool
        Whether the centre lies between two pits.

    Raises
    ------
    ValueError
        If there is no layer or no pit.
    """
    if layers < 1 or per_layer < 1:
        raise ValueError(f"received {layers} layers of {per_layer} pits; allowed: at least 1 of each")
    index = np.arange(per_layer)
    side = np.where(index % 2 == 1, 1.0, -1.0)
    steps = -side * (index // 2 + 0.5) if between else side * ((index + 1) // 2)
    height = first_height_m + spacing_height_m * np.repeat(np.arange(layers, dtype=np.float64), per_layer)
    face = np.tile(face_centre_m + spacing_face_m * steps, layers)
    return height, face


def clustered_centres(
    rng: np.random.Generator,
    count: int,
    height_centre_m: float,
    height_spread_m: float,
    face_low_m: float,
    face_high_m: float,
    *,
    height_low_m: float = -np.inf,
    height_high_m: float = np.inf,
) -> tuple[FloatArray, FloatArray]:
    """Return heights and face coordinates of a cluster, (n,) each [m].

    Heights are normal about their centre, cut off at their limits; face coordinates are uniform. Each pit takes two
    uniform numbers from `rng`, so that a smaller cluster is the beginning of a larger one.

    Parameters
    ----------
    rng : numpy.random.Generator
    count : int
        At least 1.
    height_centre_m, height_spread_m : float
        Mean and standard deviation of the heights before the cut [m].
    face_low_m, face_high_m : float
        Limits across the face [m].
    height_low_m, height_high_m : float
        Limits of the heights [m].

    Raises
    ------
    ValueError
        If the count is below 1, a spread negative, or limits leave no room.
    """
    if count < 1:
        raise ValueError(f"received {count} pits; allowed: at least 1")
    if not (height_low_m <= height_high_m and face_low_m <= face_high_m):
        raise ValueError(
            f"received limits {height_low_m:.6g} to {height_high_m:.6g} m and {face_low_m:.6g} to {face_high_m:.6g} m; "
            "allowed: low at most high"
        )
    uniform = rng.random((count, 2))
    height = _cut_normal(uniform[:, 0], height_centre_m, height_spread_m, height_low_m, height_high_m)
    return height, face_low_m + (face_high_m - face_low_m) * uniform[:, 1]


def _cut_normal(uniform: FloatArray, mean: float, spread: float, low: float, high: float) -> FloatArray:
    from scipy.special import ndtr, ndtri

    if not spread >= 0.0:
        raise ValueError(f"received spread {spread!r} m; allowed: at least 0")
    if spread == 0.0:
        return np.full(uniform.size, min(max(mean, low), high))
    first, last = ndtr((low - mean) / spread), ndtr((high - mean) / spread)
    # Far out in a tail both probabilities round to the same number and the inverse leaves the limits.
    return np.asarray(np.clip(mean + spread * ndtri(first + (last - first) * uniform), low, high))
