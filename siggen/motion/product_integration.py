"""ProductIntegration: the smooth approach is interpolated, the stiffness that jumps is integrated exactly (derived).

With the mean stiffness k_ref and the mesh damper in the constant part, ż = A z + B u, u = -Δk(t) x, where x is the
penetration of the loaded flank and Δk = K - k_ref. On a step of length h, τ = t/h in [0, 1]:

1. x(τ) = Σ_b H_b(τ) X_b with X = (x_0, h ẋ_0, x_1, h ẋ_1) and the cubic Hermite basis H.
2. m_l = ∫ P_l Δk x dτ with the shifted Legendre polynomials P_0..P_3. Every pair is integrated by Gauss-Legendre
   quadrature over that part of the step in which it is in contact, so the jump where it enters or leaves lies at an end
   of its quadrature.
3. u is replaced by the cubic with the same moments: z_1 = Φ z_0 - Σ_l w_l m_l,
   w_l = (2l + 1) ∫ e^{A (h - s)} B P_l(s/h) ds over [0, h].
4. x_1 and h ẋ_1 enter m_l linearly: two equations with two unknowns.
5. External inputs are linear over the step; their response is that of the constant part, exactly.

Where contact is lost or may be lost within a step, the step is made of Runge-Kutta substeps with the same force.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.mesh.mesh_force import MeshLaw, row_stiffness, table_row
from siggen.motion.equations import Equations, approach_of, external_push, linear_rate, state_matrix
from siggen.motion.exponential_scheme import matrix_exponential
from siggen.motion.runge_kutta import runge_kutta_step

NODES = 5
"""Gauss-Legendre nodes per pair and step: exact to degree 9, the product of P_l, H_b and a cubic stiffness."""
SUBSTEPS = 16
"""Runge-Kutta steps that replace a step in which contact may be lost."""
HERMITE_DIP = 4.0 / 27.0
"""Largest value of the Hermite functions of the end slopes: how far, times the slopes, a cubic dips below its ends."""


class ProductScheme(NamedTuple):
    """Constants of the method for one step length (a named tuple, since compiled code takes no dataclass).

    The columns of `transition` and `response` are z_1, then x_1 - x_s and h ẋ_1, then zeros up to a multiple of four.
    """

    step_s: float
    transition: FloatArray  # (2n, columns) Φᵀ
    response: FloatArray  # (4, columns) w_l
    reference_moments: FloatArray  # (4, 4) ∫ P_l H_b dτ
    nodes: FloatArray  # (NODES,) on [0, 1]
    weights: FloatArray  # (NODES,)
    products: FloatArray  # (NODES, 4, 4) weight P_l H_b at the nodes
    input_response: FloatArray  # (2, m, columns) to the inputs at the start and at the end of the step


class ProductIntegration:
    """Advances the state with one product-integration step per time step."""

    def __init__(self, equations: Equations, law: MeshLaw, step_s: float) -> None:
        self._equations = equations
        self._law = law
        self._scheme = scheme(equations, law, step_s)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""
        _advance(self._equations, self._law, self._scheme, pitches, inputs, trajectory)


def scheme(equations: Equations, law: MeshLaw, step_s: float) -> ProductScheme:
    """Return the constants of the method for the step length [s]."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    products = np.array([w * _legendre(t)[:, None] * _hermite(t)[None, :] for t, w in zip(nodes, weights, strict=True)])
    transition, response = _exponentials(equations, law, step_s)
    return ProductScheme(
        step_s=step_s,
        transition=_with_approach(transition.T, equations.mesh_vector[0], step_s),
        response=_with_approach(response, equations.mesh_vector[0], step_s),
        reference_moments=products.sum(axis=0),
        nodes=nodes,
        weights=weights,
        products=products,
        input_response=np.array(
            [_with_approach(one, equations.mesh_vector[0], step_s) for one in _input_responses(equations, law, step_s)]
        ),
    )


def _with_approach(rows: FloatArray, mesh_vector: FloatArray, step_s: float) -> FloatArray:
    """Append to states (k, 2n) their approach and h times its rate, and zeros up to a multiple of four columns."""
    n = mesh_vector.size
    result = np.zeros((len(rows), -(-(2 * n + 2) // 4) * 4))
    result[:, : 2 * n] = rows
    result[:, 2 * n] = (rows[:, :n] * mesh_vector).sum(axis=1)
    result[:, 2 * n + 1] = step_s * (rows[:, n:] * mesh_vector).sum(axis=1)
    return result


def _exponentials(equations: Equations, law: MeshLaw, step_s: float) -> tuple[FloatArray, FloatArray]:
    """Return Φ (2n, 2n) and w (4, 2n) from one exponential of the augmented matrix [[A, B, 0..], [0, shift]] h.

    Velocities are scaled by h, which brings all entries to the same size. With c = (c_0..c_3) the chain ċ_j = c_{j+1}
    makes the input Σ c_j τ^j / j!, whose response turns into that of the Legendre polynomials by their coefficients.
    """
    n = equations.mesh_vector.shape[1]
    scale = np.concatenate([np.ones(n), np.full(n, step_s)])
    augmented = np.zeros((2 * n + 4, 2 * n + 4))
    augmented[: 2 * n, : 2 * n] = _scaled_matrix(equations, law, step_s)
    augmented[n : 2 * n, 2 * n] = step_s**2 * equations.mesh_input[0]
    for j in range(3):
        augmented[2 * n + j, 2 * n + j + 1] = 1.0
    exponential = matrix_exponential(augmented)
    transition = exponential[: 2 * n, : 2 * n] / scale[:, None] * scale[None, :]
    monomial = exponential[: 2 * n, 2 * n :] * np.array([1.0, 1.0, 2.0, 6.0]) / scale[:, None]
    weights = (2.0 * np.arange(4) + 1.0)[:, None] * SHIFTED_LEGENDRE
    return transition, weights @ monomial.T


def _scaled_matrix(equations: Equations, law: MeshLaw, step_s: float) -> FloatArray:
    """Return h A (2n, 2n) of the constant part with velocities scaled by h."""
    n = equations.mesh_vector.shape[1]
    scale = np.concatenate([np.ones(n), np.full(n, step_s)])
    matrix = state_matrix(equations, equations.reference_stiffness, np.array([law.damping_n_s_per_m]))
    return np.asarray(step_s * matrix * scale[:, None] / scale[None, :])


def _input_responses(equations: Equations, law: MeshLaw, step_s: float) -> tuple[FloatArray, FloatArray]:
    """Return what a unit of each input at the start, falling to 0, and at the end, rising from 0, adds (m, 2n) to z_1.

    From one exponential of [[A, V, 0], [0, 0, 1], [0, 0, 0]] h: the responses to 1 and to τ.
    """
    count, n = equations.external_input.shape
    augmented = np.zeros((2 * n + 2 * count, 2 * n + 2 * count))
    augmented[: 2 * n, : 2 * n] = _scaled_matrix(equations, law, step_s)
    augmented[n : 2 * n, 2 * n : 2 * n + count] = step_s**2 * equations.external_input.T
    augmented[2 * n : 2 * n + count, 2 * n + count :] = np.eye(count)
    exponential = (
        matrix_exponential(augmented)[: 2 * n, 2 * n :] / np.concatenate([np.ones(n), np.full(n, step_s)])[:, None]
    )
    constant, rising = exponential[:, :count].T, exponential[:, count:].T
    return constant - rising, rising


SHIFTED_LEGENDRE = np.array(
    [[1.0, 0.0, 0.0, 0.0], [-1.0, 2.0, 0.0, 0.0], [1.0, -6.0, 6.0, 0.0], [-1.0, 12.0, -30.0, 20.0]]
)
"""Coefficients of 1, τ, τ², τ³ in P_0..P_3 on [0, 1]."""


def _legendre(t: float) -> FloatArray:
    return np.asarray(SHIFTED_LEGENDRE @ np.array([1.0, t, t * t, t * t * t]))


def _hermite(t: float) -> FloatArray:
    return np.array([_hermite_value(b, t) for b in range(4)])


@entry(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _hermite_value(b: int, t: float) -> float:
    s = 1.0 - t
    if b == 0:
        return s * s * (1.0 + 2.0 * t)
    if b == 1:
        return t * s * s
    if b == 2:
        return t * t * (3.0 - 2.0 * t)
    return -t * t * s


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _legendre_value(degree: int, t: float) -> float:
    if degree == 0:
        return 1.0
    if degree == 1:
        return 2.0 * t - 1.0
    if degree == 2:
        return 1.0 + t * (-6.0 + 6.0 * t)
    return -1.0 + t * (12.0 + t * (-30.0 + 20.0 * t))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _stiffness_moments(
    law: MeshLaw, scheme: ProductScheme, k_ref: float, start: float, end: float, nodal: FloatArray, moments: FloatArray
) -> None:
    """Write ∫ P_l H_b Δk dτ into `moments` (4, 4) for the step from pinion angle `start` to `end` (in base pitches).

    Pairs in contact during the whole step share their nodes: their stiffness is summed first, in `nodal` (NODES,).
    """
    nodal[:] = 0.0
    for p in range(4):
        for b in range(4):
            moments[p, b] = -k_ref * scheme.reference_moments[p, b]
    advance = end - start
    pair = int(np.floor(end))
    while start - pair < law.contact_ratio:
        row, place = table_row(law, pair), start - pair
        if place >= 0.0 and place + advance <= law.contact_ratio:
            for q in range(NODES):
                nodal[q] += row_stiffness(law, row, place + scheme.nodes[q] * advance)
        else:
            _add_clipped_pair(law, scheme, row, place, advance, moments)
        pair -= 1
    for q in range(NODES):
        for p in range(4):
            for b in range(4):
                moments[p, b] += nodal[q] * scheme.products[q, p, b]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _add_clipped_pair(
    law: MeshLaw, scheme: ProductScheme, row: int, place: float, advance: float, moments: FloatArray
) -> None:
    """Add the moments of a pair that enters or leaves within the step, over the part in which it is in contact."""
    low = max(-place / advance, 0.0)
    high = min((law.contact_ratio - place) / advance, 1.0)
    for q in range(NODES):
        t = low + (high - low) * scheme.nodes[q]
        k = row_stiffness(law, row, place + t * advance) * scheme.weights[q] * (high - low)
        for p in range(4):
            for b in range(4):
                moments[p, b] += k * _legendre_value(p, t) * _hermite_value(b, t)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _free_motion(scheme: ProductScheme, start: FloatArray, free: FloatArray) -> None:
    """Write the state after one step without input, with its approach, into `free` (columns,), four at a time."""
    for i in range(0, free.size, 4):
        a, b, c, d = 0.0, 0.0, 0.0, 0.0
        for j in range(start.size):
            z = start[j]
            a += scheme.transition[j, i] * z
            b += scheme.transition[j, i + 1] * z
            c += scheme.transition[j, i + 2] * z
            d += scheme.transition[j, i + 3] * z
        free[i], free[i + 1], free[i + 2], free[i + 3] = a, b, c, d


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _end_of_step(
    scheme: ProductScheme, moments: FloatArray, size: int, rest: float, x_0: float, v_0: float, state: FloatArray
) -> None:
    """Turn the free motion `state` (columns,) into the state after the step; v stands for h ẋ, `rest` for x_s."""
    x_1, v_1 = rest + state[size], state[size + 1]
    a, b, c, d = 1.0, 0.0, 0.0, 1.0
    for p in range(4):
        known = moments[p, 0] * x_0 + moments[p, 1] * v_0
        on_x, on_v = scheme.response[p, size], scheme.response[p, size + 1]
        x_1 -= on_x * known
        v_1 -= on_v * known
        a += on_x * moments[p, 2]
        b += on_x * moments[p, 3]
        c += on_v * moments[p, 2]
        d += on_v * moments[p, 3]
    x_1, v_1 = (d * x_1 - b * v_1) / (a * d - b * c), (a * v_1 - c * x_1) / (a * d - b * c)
    for p in range(4):
        moment = moments[p, 0] * x_0 + moments[p, 1] * v_0 + moments[p, 2] * x_1 + moments[p, 3] * v_1
        for i in range(state.size):
            state[i] -= scheme.response[p, i] * moment


@njit(cache=True, _nrt=False, error_model="numpy")
def _substeps(
    equations: Equations,
    law: MeshLaw,
    step_s: float,
    pitches_0: float,
    pitches_1: float,
    pushes: FloatArray,
    state: FloatArray,
    scratch: FloatArray,
) -> None:
    """Advance `state` (2n,) over one step by SUBSTEPS Runge-Kutta steps; `pushes` (4, n): at its ends, and space."""
    advance = (pitches_1 - pitches_0) / SUBSTEPS
    for j in range(SUBSTEPS):
        first = pitches_0 + j * advance
        model = (equations, law)
        low, high = pushes[2], pushes[3]
        for i in range(low.size):
            rise = (pushes[1, i] - pushes[0, i]) / SUBSTEPS
            low[i], high[i] = pushes[0, i] + j * rise, pushes[0, i] + (j + 1) * rise
        runge_kutta_step(
            linear_rate, model, step_s / SUBSTEPS, (first, first + advance), pushes[2:], state, state, scratch
        )


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _add_inputs(scheme: ProductScheme, start: FloatArray, end: FloatArray, state: FloatArray) -> None:
    """Add to the motion after one step (columns,) what inputs (m,), linear over the step, contribute."""
    for k in range(start.size):
        for i in range(state.size):
            state[i] += scheme.input_response[0, k, i] * start[k] + scheme.input_response[1, k, i] * end[k]


@entry(cache=True)
def _advance(
    equations: Equations,
    law: MeshLaw,
    scheme: ProductScheme,
    pitches: FloatArray,
    inputs: FloatArray,
    trajectory: FloatArray,
) -> None:
    size = trajectory.shape[1]
    pushes = np.empty((4, size // 2 if inputs.shape[1] > 0 else 0))
    moments, nodal, scratch = np.empty((4, 4)), np.empty(NODES), np.empty((3, size))
    after = np.empty(scheme.transition.shape[1])
    stiffness, side = equations.reference_stiffness[0], equations.side[0]
    rest, shift = equations.static_force[0] / stiffness, side * law.half_backlash_m
    for i in range(pitches.size - 1):
        approach, rate = approach_of(equations, 0, trajectory[i])
        x_0, v_0 = approach - shift, scheme.step_s * rate
        _stiffness_moments(law, scheme, stiffness, pitches[i], pitches[i + 1], nodal, moments)
        _free_motion(scheme, trajectory[i], after)
        if inputs.shape[1] > 0:
            _add_inputs(scheme, inputs[i], inputs[i + 1], after)
        _end_of_step(scheme, moments, size, rest, x_0, v_0, after)
        trajectory[i + 1] = after[:size]
        x_1, v_1 = rest + after[size], after[size + 1]
        lowest = min(side * x_0, side * x_1) - HERMITE_DIP * (abs(v_0) + abs(v_1))
        if law.half_backlash_m > 0.0 and lowest <= 0.0:
            trajectory[i + 1] = trajectory[i]
            external_push(equations.external_input, inputs[i], pushes[0])
            external_push(equations.external_input, inputs[i + 1], pushes[1])
            _substeps(equations, law, scheme.step_s, pitches[i], pitches[i + 1], pushes, trajectory[i + 1], scratch)
