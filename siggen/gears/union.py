"""Compiled union of pits in one section of a tooth: covered length across the face and moments of the depth.

Derived. At a height x every pit covers an interval of the face; the depth field is the largest depth of the pits that
cover a point:

    D(w) = max_i D_i(w),   D_i = delta_i (flat) or delta_i sqrt(1 - u^2 - v^2) (dish),   u = (x - mu_i)/b_i,  v = (w -
    w_i)/a_i

Nothing is rasterised: the face is cut where pits start, end or become the deepest, and each piece is integrated in
closed form.
"""

from __future__ import annotations

from math import atan2, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@njit(cache=True)
def active_pits(x: float, pits: FloatArray, active: IntArray) -> int:
    """Write the rows of the pits whose height range holds x into `active` and return their number."""
    count = 0
    for i in range(pits.shape[0]):
        if pits[i, 0] - pits[i, 3] < x < pits[i, 0] + pits[i, 3]:
            active[count] = i
            count += 1
    return count


@njit(cache=True)
def add_intervals(
    x: float,
    pits: FloatArray,
    active: IntArray,
    count: int,
    face_width: float,
    left: FloatArray,
    right: FloatArray,
    owner: IntArray,
    filled: int,
) -> int:
    """Insert the active pits' intervals, clipped to the face, into lists sorted by `left`; return their number."""
    for position in range(count):
        i = active[position]
        mu, w, a, b = pits[i, 0], pits[i, 1], pits[i, 2], pits[i, 3]
        if not mu - b < x < mu + b:
            continue
        u = (x - mu) / b
        reach = a * sqrt(max((1.0 - u) * (1.0 + u), 0.0))
        low, high = max(w - reach, 0.0), min(w + reach, face_width)
        if high <= low:
            continue
        k = filled
        while k > 0 and left[k - 1] > low:
            left[k], right[k], owner[k] = left[k - 1], right[k - 1], owner[k - 1]
            k -= 1
        left[k], right[k], owner[k] = low, high, i
        filled += 1
    return filled


@njit(cache=True)
def covered_length(left: FloatArray, right: FloatArray, count: int) -> float:
    """Return the length of the union of intervals that are sorted by `left`."""
    length = 0.0
    end = -np.inf
    for k in range(count):
        if left[k] > end:
            length += right[k] - left[k]
            end = right[k]
        elif right[k] > end:
            length += right[k] - end
            end = right[k]
    return length


@njit(cache=True)
def _square_depth(x: float, w: float, pits: FloatArray, i: int) -> float:
    square = pits[i, 4] * pits[i, 4]
    if pits[i, 5] == 0.0:
        return square
    u, v = (x - pits[i, 0]) / pits[i, 3], (w - pits[i, 1]) / pits[i, 2]
    return square * max((1.0 - u) * (1.0 + u) - v * v, 0.0)


@njit(cache=True)
def _add_piece(x: float, low: float, high: float, pits: FloatArray, i: int, moments: FloatArray) -> None:
    """Add int D dw, int D^2 dw, int D^3 dw of pit i over [low, high]."""
    depth = pits[i, 4]
    if pits[i, 5] == 0.0:
        span = high - low
        moments[0] += depth * span
        moments[1] += depth * depth * span
        moments[2] += depth * depth * depth * span
        return
    u, scale = (x - pits[i, 0]) / pits[i, 3], depth * pits[i, 2]
    square = max((1.0 - u) * (1.0 + u), 0.0)
    reach = sqrt(square)
    if reach == 0.0:
        return
    for sign, end in ((1.0, high), (-1.0, low)):
        v = min(max((end - pits[i, 1]) / pits[i, 2], -reach), reach)
        root = sqrt(max((reach - v) * (reach + v), 0.0))
        # The angle from v and root: asin(v / reach) would lose half the digits at a dish's edge.
        cap = 0.5 * (v * root + square * atan2(v, root))
        moments[0] += sign * scale * cap
        moments[1] += sign * scale * depth * (square * v - v * v * v / 3.0)
        moments[2] += sign * scale * depth * depth * (0.25 * v * root * root * root + 0.75 * square * cap)


@njit(cache=True)
def _depth_crossings(x: float, pits: FloatArray, i: int, j: int, cuts: FloatArray, count: int) -> int:
    """Append the face coordinates where pits i and j are equally deep: roots of a quadratic about the centre of i."""
    c2 = c1 = c0 = 0.0
    for sign, k in ((1.0, i), (-1.0, j)):
        square = sign * pits[k, 4] * pits[k, 4]
        if pits[k, 5] == 0.0:
            c0 += square
        else:
            u, shift = (x - pits[k, 0]) / pits[k, 3], pits[k, 1] - pits[i, 1]
            curve = square / (pits[k, 2] * pits[k, 2])
            c2 -= curve
            c1 += 2.0 * curve * shift
            c0 += square * (1.0 - u) * (1.0 + u) - curve * shift * shift
    if c2 == 0.0:
        if c1 != 0.0:
            cuts[count] = pits[i, 1] - c0 / c1
            count += 1
        return count
    discriminant = c1 * c1 - 4.0 * c2 * c0
    if discriminant <= 0.0:
        return count
    q = -0.5 * (c1 + (sqrt(discriminant) if c1 >= 0.0 else -sqrt(discriminant)))
    cuts[count] = pits[i, 1] + q / c2
    count += 1
    if q != 0.0:
        cuts[count] = pits[i, 1] + c0 / q
        count += 1
    return count


@njit(cache=True)
def cut_room(pits: int) -> int:
    """Return how many cuts pits can make in one section: two ends each, two equal depths per couple."""
    return 2 * pits + pits * (pits - 1)


@njit(cache=True)
def _cluster_cuts(
    x: float,
    pits: FloatArray,
    left: FloatArray,
    right: FloatArray,
    owner: IntArray,
    first: int,
    last: int,
    cuts: FloatArray,
) -> int:
    """Write the sorted face coordinates where a cluster's deepest pit may change; return their number."""
    count = 0
    for k in range(first, last):
        cuts[count], cuts[count + 1] = left[k], right[k]
        count += 2
        for other in range(first, k):
            i, j = owner[k], owner[other]
            if left[k] < right[other] and (pits[i, 5] != 0.0 or pits[j, 5] != 0.0):
                count = _depth_crossings(x, pits, i, j, cuts, count)
    for k in range(1, count):
        cut, position = cuts[k], k
        while position > 0 and cuts[position - 1] > cut:
            cuts[position] = cuts[position - 1]
            position -= 1
        cuts[position] = cut
    return count


@njit(cache=True)
def _add_cluster(
    x: float,
    pits: FloatArray,
    left: FloatArray,
    right: FloatArray,
    owner: IntArray,
    first: int,
    last: int,
    cuts: FloatArray,
    moments: FloatArray,
) -> None:
    """Add the moments of intervals first..last-1, an overlapping chain, piece by piece of its deepest pit."""
    count = _cluster_cuts(x, pits, left, right, owner, first, last, cuts)
    open_from = first
    for position in range(count - 1):
        low, high = cuts[position], cuts[position + 1]
        if high <= low:
            continue
        middle = 0.5 * (low + high)
        while open_from < last and right[open_from] <= middle:
            open_from += 1
        deepest, best = -1, -1.0
        for k in range(open_from, last):
            if left[k] >= middle:
                break
            if middle < right[k]:
                square = _square_depth(x, middle, pits, owner[k])
                if square > best:
                    deepest, best = owner[k], square
        if deepest >= 0:
            _add_piece(x, low, high, pits, deepest, moments)


@njit(cache=True)
def depth_moments(
    x: float,
    pits: FloatArray,
    left: FloatArray,
    right: FloatArray,
    owner: IntArray,
    count: int,
    cuts: FloatArray,
    moments: FloatArray,
) -> None:
    """Write int D dw [m2], int D^2 dw [m3] and int D^3 dw [m4] of the union of the intervals into `moments` (3,).

    `cuts` is working room of size `cut_room(number of pits)`.
    """
    moments[:] = 0.0
    uniform = True
    for k in range(count):
        if pits[owner[k], 5] != 0.0 or pits[owner[k], 4] != pits[owner[0], 4]:
            uniform = False
    if count > 0 and uniform:
        depth = pits[owner[0], 4]
        length = covered_length(left, right, count)
        moments[0] = depth * length
        moments[1] = depth * depth * length
        moments[2] = depth * depth * depth * length
        return
    first = 0
    while first < count:
        last, end = first + 1, right[first]
        while last < count and left[last] < end:
            end = max(end, right[last])
            last += 1
        if last == first + 1:
            _add_piece(x, left[first], right[first], pits, owner[first], moments)
        else:
            _add_cluster(x, pits, left, right, owner, first, last, cuts, moments)
        first = last


@njit(cache=True)
def lengths_covered(
    heights_one: FloatArray, pits_one: FloatArray, heights_two: FloatArray, pits_two: FloatArray, face_width: float
) -> FloatArray:
    """Return the face length that the pits of two mating flanks cover together at each contact (k,) [m].

    The two flanks share the face coordinate; give one of them no pits (0, 6) for the loss of a single flank.
    """
    room = pits_one.shape[0] + pits_two.shape[0]
    left, right = np.empty(room), np.empty(room)
    owner, active = np.empty(room, np.int64), np.empty(room, np.int64)
    out = np.zeros(heights_one.size)
    for i in range(heights_one.size):
        count = active_pits(heights_one[i], pits_one, active)
        filled = add_intervals(heights_one[i], pits_one, active, count, face_width, left, right, owner, 0)
        count = active_pits(heights_two[i], pits_two, active)
        filled = add_intervals(heights_two[i], pits_two, active, count, face_width, left, right, owner, filled)
        out[i] = covered_length(left, right, filled)
    return out
