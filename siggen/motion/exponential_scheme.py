"""Constants of the exponential integrator: exact propagation of the linear part and of forces given at Gauss nodes.

Derived: ż = A z + Σ_c b_c e_c(t) + Σ_k v_k u_k(t) with the mesh's mean stiffness and damper in A. Over a step of length
h every e_c is the parabola through its values at the three Gauss-Legendre nodes τ_q, so that for any τ in [0, 1]

    z(τ h) = e^{A τ h} z_0 + Σ_c Σ_q W_cq(τ) e_c(τ_q) + R_0(τ) u_0 + R_1(τ) u_1,
    W_cq(τ) = ∫ e^{A (τ h - s)} b_c L_q(s/h) ds over [0, τ h],

with L_q the Lagrange polynomials of the nodes; inputs are linear. It is asked for at the end, and at the nodes for what
the mesh sees there: approach and its rate, both parts of the sliding speed, and where gears tilt, tilt and its rate
(collocation). The state in the middle of a step is handed on too: it costs no forces. All of it comes from exponentials
of augmented matrices, without an inverse of A.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, lru_cache
from math import ceil, factorial, log2
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.drivetrain.structure import MeshVectors, Structure, without_drift
from siggen.lanes import LANES, aligned
from siggen.motion.equations import Equations, PairEquations, inverse_times, state_matrix

# MatrixExponential: e^A of a small matrix, the same to the last bit for any number of numeric threads.
#
# Scaling and squaring with a Taylor series of degree 16 in blocks of four powers, which takes six products (Paterson
# and Stockmeyer 1973). Below norm 1/2 the first term left out is below 1e-19. `scipy.linalg.expm` is not used: its
# last bits depend on how many threads the linear algebra library runs, even for matrices of this size. The products
# are sums in the order of the columns.

LARGEST_NORM = 0.5
BLOCKS = (12, 8, 4, 0)
"""Lowest powers of the blocks, the highest one first; one term stands above them."""


def matrix_exponential(matrix: FloatArray) -> FloatArray:
    """Return e^A (n, n) of a finite real matrix A (n, n), dimensionless."""
    norm = float(np.abs(matrix).sum(axis=0).max(initial=0.0))
    halvings = max(0, ceil(log2(norm / LARGEST_NORM))) if norm > 0.0 else 0
    small = np.ascontiguousarray(matrix * 0.5**halvings)
    square = _product(small, small)
    powers = (np.eye(len(matrix)), small, square, _product(square, small))
    fourth = _product(square, square)
    result = np.zeros_like(small)
    for lowest in BLOCKS:
        block = sum(power / factorial(lowest + k) for k, power in enumerate(powers))
        ahead = fourth / factorial(lowest + 4) if lowest == BLOCKS[0] else _product(result, fourth)
        result = ahead + block
    for _ in range(halvings):
        result = _product(result, result)
    return result


@entry(cache=True)
def _product(left: FloatArray, right: FloatArray) -> FloatArray:
    result = np.zeros((left.shape[0], right.shape[1]))
    for i in range(left.shape[0]):
        for j in range(left.shape[1]):
            factor = left[i, j]
            for k in range(right.shape[1]):
                result[i, k] += factor * right[j, k]
    return result


NODES = 3
PLACES = LANES // 2
"""For the values of one kind at the nodes; the last is empty."""
LEVELS = 5
SPLIT = 2
"""A step with an event becomes this many, and each of them again this many, up to LEVELS lengths in all."""


class Scheme(NamedTuple):
    """Constants of the method (a named tuple, since compiled code takes no dataclass).

    First axis of the first four: lengths of a step, h, h/2, .. h/16. The columns are the 2n numbers of the state at the
    end, zeros up to a multiple of LANES, then PLACES places each for what every mesh sees at the nodes: two of it are
    one vector. Channels stand mesh after mesh. Arrays begin where a line of the cache does.
    """

    steps_s: FloatArray  # (LEVELS,)
    transition: FloatArray  # (LEVELS, 2n, columns)
    response: FloatArray  # (LEVELS, channels, NODES, columns) to ΣN, ΣF, Σ s F, and where gears tilt Σμ, Σ ζ F
    input_response: FloatArray  # (LEVELS, 2, m, columns)
    middle: FloatArray  # (2n + channels x NODES + 2 m, 2n and zeros) of start, forces and inputs to the state at h/2
    nodes: FloatArray  # (NODES,) τ_q on [0, 1]
    weights: FloatArray  # (NODES,)
    legendre: FloatArray  # (NODES, NODES) (2l + 1) w_q P_l(τ_q): values at the nodes to Legendre coefficients
    extrapolation: (
        FloatArray  # (LEVELS, LEVELS, NODES, LANES) of the values at the nodes of the step before, to those of this
    )
    linear: FloatArray  # (meshes, 7) stiffness, damping, static force, approach, tilt; both parts of the rigid sliding
    places: FloatArray  # (meshes, 2) base pitches of a mesh: the first times those of the first mesh, plus the second


def exponential_scheme(
    structure: Structure,
    equations: Equations,
    of_pairs: PairEquations,
    damping_n_s_per_m: FloatArray,
    step_s: float,
) -> Scheme:
    """Return the constants for steps of `step_s` [s] with the dampers of the meshes [N s/m] in the linear part.

    Parameters
    ----------
    structure, equations, of_pairs
    damping_n_s_per_m : (meshes,)
    step_s : float
    """
    nodes, weights = _gauss()
    steps = np.asarray(step_s * float(SPLIT) ** -np.arange(LEVELS))
    matrix = state_matrix(equations, equations.reference_stiffness, damping_n_s_per_m)
    forces, observed = _forces(structure), _observed(structure)
    keys = tuple(_key(array) for array in (matrix, forces, equations.external_input, observed))
    transition, response, inputs, middle = _all_levels(keys, step_s)
    parts = zip(structure.meshes, equations.reference_stiffness, damping_n_s_per_m, strict=True)
    linear = [
        [k, c, *of_pairs.static[m, :2], _static_tilt(mesh, equations), *of_pairs.rigid_sliding[m]]
        for m, (mesh, k, c) in enumerate(parts)
    ]
    return Scheme(
        steps_s=steps,
        transition=transition,
        response=response,
        input_response=inputs,
        middle=middle,
        nodes=nodes,
        weights=weights,
        legendre=np.array([_legendre(nodes, degree) * weights * (2.0 * degree + 1.0) for degree in range(NODES)]),
        extrapolation=_extrapolation(),
        linear=np.array(linear),
        places=of_pairs.places,
    )


def _static_tilt(mesh: MeshVectors, equations: Equations) -> float:
    return 0.0 if mesh.tilt is None else float((mesh.tilt * equations.static_deflection).sum())


def _key(array: FloatArray) -> tuple[tuple[int, ...], bytes]:
    return array.shape, np.ascontiguousarray(array).tobytes()


Keys = tuple[tuple[tuple[int, ...], bytes], ...]
"""Shapes and values of matrix, forces, inputs and what is observed."""


@lru_cache(maxsize=4)
def _all_levels(keys: Keys, step_s: float) -> tuple[FloatArray, ...]:
    """Return transition, response and inputs of all lengths, and the middle; kept: states of a gearbox share them."""
    matrix, forces, inputs, _ = _arrays(keys)
    nodes, _ = _gauss()
    steps = step_s * float(SPLIT) ** -np.arange(LEVELS)
    parts = [_propagated(keys, float(step)) for step in steps]
    half = _exponentials(matrix, forces, inputs, step_s, 0.5, nodes)
    middle = _filled(np.concatenate([part.reshape(-1, len(matrix)) for part in half]), LANES)
    return (*(aligned(np.array([part[k] for part in parts])) for k in range(3)), aligned(middle))


def _arrays(keys: Keys) -> Iterator[FloatArray]:
    return (np.frombuffer(data).reshape(shape) for shape, data in keys)


def _filled(values: FloatArray, multiple: int) -> FloatArray:
    """Return values with zeros behind them, up to a multiple of so many."""
    return np.concatenate([values, np.zeros((*values.shape[:-1], -values.shape[-1] % multiple))], axis=-1)


def _forces(structure: Structure) -> FloatArray:
    """Return the accelerations (channels, n) by a unit of every channel, mesh after mesh."""
    vectors: list[FloatArray] = []
    for mesh in structure.meshes:
        vectors += [mesh.vector, *without_drift(structure, mesh.sliding)]
        if mesh.tilt is not None:
            vectors += [mesh.tilt, mesh.friction_tilt]
    return -inverse_times(structure.mass, np.array(vectors).T).T


def _observed(structure: Structure) -> FloatArray:
    """Return what the meshes see of a state, (2n, 4) each, or (2n, 6) where gears tilt, side by side."""
    rows: list[tuple[FloatArray, FloatArray]] = []
    for mesh in structure.meshes:
        still = np.zeros_like(mesh.vector)
        rows += [(mesh.vector, still), (still, mesh.vector)]
        rows += [(still, sliding) for sliding in mesh.sliding]
        if mesh.tilt is not None:
            rows += [(mesh.tilt, still), (still, mesh.tilt)]
    return np.array([np.concatenate(row) for row in rows]).T


@lru_cache(maxsize=12)  # twice as many steps per sample have all lengths but one in common
def _propagated(keys: Keys, step_s: float) -> tuple[FloatArray, ...]:
    """Return transition (2n, columns), response (channels, NODES, columns) and input response (2, m, columns)."""
    matrix, forces, inputs, observed = _arrays(keys)
    nodes, _ = _gauss()
    at_end = _exponentials(matrix, forces, inputs, step_s, 1.0, nodes)
    at_nodes = [_exponentials(matrix, forces, inputs, step_s, float(t), nodes) for t in nodes]
    columns = []
    for k, end in enumerate(at_end):
        seen = np.stack([(part[k][..., None] * observed).sum(axis=-2) for part in at_nodes], axis=-1)
        seen = _filled(seen, PLACES).reshape(*end.shape[:-1], observed.shape[1] * PLACES)
        columns.append(np.concatenate([_filled(end, LANES), seen], axis=-1))
    return tuple(columns)


def _exponentials(
    matrix: FloatArray, forces: FloatArray, inputs: FloatArray, step_s: float, share: float, nodes: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return e^{A τ h} transposed (2n, 2n), W(τ) (channels, NODES, 2n) and R(τ) (2, m, 2n) at τ = `share`.

    One exponential of [[A, B, 0..], [0, shift]] τ h gives the responses to (s/(τ h))^j of every force along B;
    velocities are scaled by τ h, which brings all entries to the same size.
    """
    n, channels, count, time = forces.shape[1], len(forces), len(inputs), step_s * share
    scale = np.concatenate([np.ones(n), np.full(n, time)])
    linear = time * matrix * scale[:, None] / scale[None, :]
    transition, powers = _powers(linear, time**2 * forces.T, NODES)
    monomials = np.linalg.inv(np.vander(nodes, NODES, increasing=True))  # [j, q]: τ^j in L_q
    monomials = monomials * (share ** np.arange(NODES))[:, None]
    powers = powers.reshape(2 * n, NODES, channels) / scale[:, None, None]
    response = (powers[:, :, :, None] * monomials[:, None, :]).sum(axis=1).transpose(1, 2, 0)
    _, rising = _powers(linear, time**2 * inputs.T, 2)
    rising = rising.reshape(2 * n, 2, count) / scale[:, None, None]
    driven = np.stack([(rising[:, 0] - share * rising[:, 1]).T, share * rising[:, 1].T])
    return (transition / scale[:, None] * scale[None, :]).T, response, driven


def _powers(linear: FloatArray, forces: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Return e^L and the responses (2n, count x c) to τ^0 .. τ^(count-1) of forces (n, c) on the velocities."""
    (n, c), size = forces.shape, len(linear)
    augmented = np.zeros((size + count * c, size + count * c))
    augmented[:size, :size] = linear
    augmented[n:size, size : size + c] = forces
    for j in range(count - 1):
        rows, columns = size + j * c, size + (j + 1) * c
        augmented[rows : rows + c, columns : columns + c] = np.eye(c)
    exponential = matrix_exponential(augmented)
    factorials = np.cumprod([1.0, *range(1, count)])
    return exponential[:size, :size], exponential[:size, size:] * np.repeat(factorials, c)


@cache
def _gauss() -> tuple[FloatArray, FloatArray]:
    """Return the Gauss nodes on [0, 1] and their weights (NODES,), read-only as the one node of `pair_forces`."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    nodes.setflags(write=False)
    weights.setflags(write=False)
    return nodes, weights


def _legendre(t: FloatArray, degree: int) -> FloatArray:
    """Return the shifted Legendre polynomial P_degree at t on [0, 1]."""
    return np.asarray(np.polynomial.legendre.legval(2.0 * t - 1.0, np.eye(NODES)[degree]))


@cache
def _extrapolation() -> FloatArray:
    """Return what continues the parabola through the values at the nodes of a step to those of the next one."""
    nodes, weights = _gauss()
    steps = float(SPLIT) ** -np.arange(LEVELS)
    result = np.zeros((LEVELS, LEVELS, NODES, LANES))
    for before, last in enumerate(steps):
        for now, step in enumerate(steps):
            ahead = 1.0 + nodes * step / last
            for degree in range(3 if step <= last else 1):  # a longer step after short ones: their mean
                part = _legendre(nodes, degree) * weights * (2.0 * degree + 1.0)
                result[before, now, :, :NODES] += part[:, None] * _legendre(ahead, degree)[None, :]
    result.setflags(write=False)
    return result
