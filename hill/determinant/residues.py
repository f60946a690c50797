"""The report's own way to P(z): residues K_j of a finite determinant, Eqs. (6.3.3) to (6.3.7)."""

import numpy as np

from hill.arrays import Complex, Float
from hill.determinant.finite import Blocks, blocks
from hill.equation import HillEquation
from hill.stability import Stability, stability_of

MAX_HARMONICS = 14
"""The listing's largest M: 29 blocks of 3 rows just fit its 100 by 100 array."""

# Two poles closer than this share of a period make residues larger than 1/APART that cancel; the
# digits lost stay below those a finite determinant has anyway (M**-3 with M <= 14).
APART = 1e-6


def report_rule(equation: HillEquation) -> tuple[int, ...]:
    """M for each residue, section 6.2 as coded: (sqrt|F_NN| + sqrt|F_jj|)/Omega + 1, at most 14.

    F_NN is the last bending mode's, the largest diagonal element.
    """
    diagonal = np.diag(equation.F) - 0.25 * equation.damping**2
    root = np.sqrt(np.abs(diagonal))
    return tuple(min(int((root.max() + r) / equation.Omega + 1.0), MAX_HARMONICS) for r in root)


def as_the_report(equation: HillEquation) -> Stability | None:
    """Z and T with the report's truncation, without a bound; None where its residues do not exist.

    `hill.characteristic` with ``truncation="report"`` says how far that is from the converged ones.
    """
    found = polynomial(blocks(equation), report_rule(equation))
    if found is None:
        return None
    return stability_of(found, 0.0, equation.Omega, equation.damping)


def polynomial(system: Blocks, M: tuple[int, ...]) -> Float | None:
    """P(z) = prod_j (z - zeta_j) [1 - sum_j K_j/(zeta_j - z)] (6.3.6); None where poles meet."""
    w = np.sqrt(np.diag(system.Fbar).astype(complex))
    if _poles_meet(w):
        return None
    zeta = np.cos(2.0 * np.pi * w)
    K = np.array([residue(system, w, j, M[j]) for j in range(system.n)])
    return np.real(combine(zeta, K))


def combine(zeta: Complex, K: Complex) -> Complex:
    """Monic coefficients of (6.3.6) cleared of its denominators, highest power first."""
    total: Complex = np.poly(zeta).astype(complex)
    for j, K_j in enumerate(K):
        total[1:] += K_j * np.poly(np.delete(zeta, j))
    return total


def residue(system: Blocks, w: Complex, j: int, M: int) -> complex:
    """K_j = pi sin(2 pi w_j)/w_j Delta_j(w_j), Eq. (6.3.5) as corrected."""
    factor = 2.0 * np.pi**2 * np.sinc(2.0 * w[j])
    return complex(factor * finite_determinant(system, w[j], j, M))


def finite_determinant(system: Blocks, alpha: complex, j: int, M: int) -> complex:
    """Delta_j(alpha) of Eq. (6.3.4) over |m| <= M, at its pole alpha = w_j.

    The row of coordinate j in the block m = 0 is left undivided; its diagonal element is zero.
    """
    n = system.n
    m = np.arange(-M, M + 1)
    divisor = np.diag(system.Fbar) - ((alpha + m) ** 2)[:, None]
    divisor[M, j] = 1.0
    table = np.kron(np.eye(len(m)), system.Fbar - np.diag(np.diag(system.Fbar))).astype(complex)
    for p, B in system.B.items():
        shift = np.eye(len(m), k=p) + np.eye(len(m), k=-p)
        table += np.kron(shift, B)
    table /= divisor.reshape(-1, 1)
    table[np.diag_indices(n * len(m))] += 1.0
    table[M * n + j, M * n + j] -= 1.0
    return complex(np.linalg.det(table))


def _poles_meet(w: Complex) -> bool:
    """Whether +-w_i and +-w_j (w_j and -w_j, for w_j not 0) differ by a whole number."""
    for j, w_j in enumerate(w):
        for k, w_k in enumerate(w[: j + 1]):
            for gap in (w_j - w_k, w_j + w_k):
                own = j == k and gap in (0, 2 * w_j) and round(abs(gap.real)) == 0
                if not own and abs(gap - round(gap.real)) < APART:
                    return True
    return False
