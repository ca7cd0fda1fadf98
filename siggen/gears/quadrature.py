"""Gauss-Legendre nodes and weights on [-1, 1] that the compiled integrals use.

Equations: reference, standard literature (Gauss-Legendre quadrature).
"""

from __future__ import annotations

import numpy as np

NODES_4, WEIGHTS_4 = np.polynomial.legendre.leggauss(4)
NODES_6, WEIGHTS_6 = np.polynomial.legendre.leggauss(6)
NODES_8, WEIGHTS_8 = np.polynomial.legendre.leggauss(8)
NODES_16, WEIGHTS_16 = np.polynomial.legendre.leggauss(16)
NODES_48, WEIGHTS_48 = np.polynomial.legendre.leggauss(48)
