"""The report's FORTRAN as it was run: its constants, its truncation, its slips. Not its intent.

Kept apart from the corrected equations so that the printed numbers can be explained. What differs
from chapters 4 to 6 is marked SLIP. Arithmetic is double, not the 7094's 27 bits, so printed digits
come back to a unit or so in the last place wherever they are not themselves sensitive.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]

RIGID = 50.0
"""OMEGL beyond which the stepped program drops compliance (appendix B-4)."""

MAX_HARMONICS = 14

MAX_STEPS = 100
"""Steps one way before the search for a boundary is given up: the report's runs take five."""


@dataclass(frozen=True)
class Case:
    """One run of either program, in the listing's terms.

    XG, SPC, TO, GAMMA, ETA, OMEGL, GA are xi_G, K_theta, T0, gamma, eta, omega_L and g; RC, RA, RI
    are xi_c and the area and inertia ratios, None for the uniform program. Q is omega_L/Omega where
    initial conditions are included, 0 where they are not; S is the number of their terms.
    `always_compliant` takes the stepped program's test of OMEGL away: Table 2 was made without it.
    """

    XG: float
    SPC: float
    TO: float
    GAMMA: float
    ETA: float = 0.0
    OMEGL: float = 100.0
    GA: float = 0.0
    Q: int = 0
    S: int = 5
    RC: float | None = None
    RA: float = 1.0
    RI: float = 1.0
    always_compliant: bool = False


@dataclass(frozen=True, eq=False)
class Uniform:
    """Constants of the uniform program's deck, with its number of bending modes."""

    N: int
    PI: float
    R: Float
    B: Float
    PH: Float
    DPH: Float
    DPHG: Float


@dataclass(frozen=True, eq=False)
class Stepped:
    """Constants of the stepped program's deck: mode shapes tabulated at xi = .1, .2, ..., 1."""

    N: int
    PI: float
    R: Float
    B: Float
    D0PH: Float
    D1PH: Float
    D2PH: Float
    D3PH: Float


@dataclass(frozen=True, eq=False)
class Stab:
    """What STAB prints for one OMEGB."""

    OMEGB: float
    roots: Complex
    STAB1: float
    doubtful: int
    """How many of its determinants wanted more harmonics than there is room for."""

    @property
    def unstable(self) -> bool:
        """ITS = 2."""
        return self.STAB1 > 1e-7


class NoBoundary(ValueError):
    """SWITCH has found nothing stable on one side."""


def stab(deck: Uniform | Stepped, case: Case, OMEGB: float) -> Stab:
    """SUBROUTINE STAB: roots z and the characteristic argument at one forcing frequency."""
    F, G, H = coefficients(deck, case, OMEGB)
    w = np.sqrt(np.abs(np.diag(F))) / OMEGB  # SLIP: hides a negative F_jj
    M = (np.sqrt(abs(F[deck.N - 1, deck.N - 1])) / OMEGB + w + 1.0).astype(int)
    kept = np.minimum(M, MAX_HARMONICS)
    zeta = np.cos(2.0 * deck.PI * w)
    K = np.array(
        [
            deck.PI * np.sin(2.0 * deck.PI * w_j) / w_j * _deter(F, G, H, case, OMEGB, j, kept[j])
            for j, w_j in enumerate(w)
        ]
    )
    cleared = np.poly(zeta)
    for j, K_j in enumerate(K):
        cleared[1:] += K_j * np.poly(np.delete(zeta, j))
    z = np.roots(cleared).astype(complex)
    z.imag[np.abs(z.imag) < 1e-4] = 0.0
    root = np.sqrt(z * z - 1.0)
    R = np.maximum(np.abs(z + root), np.abs(z - root)).max()
    STAB1 = float(np.log(R) * OMEGB / deck.PI - case.ETA)
    return Stab(OMEGB, z, STAB1, int(np.sum(M > MAX_HARMONICS)))


def switch(
    deck: Uniform | Stepped, case: Case, OMEGB: float, *, first_T: float | None = None
) -> list[Stab]:
    """SUBROUTINE SWITCH around one resonance, with what STAB finds; see `search`."""
    return list(search(partial(stab, deck, case), OMEGB, case.ETA, first_T=first_T))


def search(
    evaluate: Callable[[float], Stab], OMEGB: float, ETA: float, *, first_T: float | None = None
) -> Iterator[Stab]:
    """SUBROUTINE SWITCH: from a resonance outward until the boundary is bracketed, both ways.

    Steps of 1.2 T (.04 where that exceeds .10), T from the resonance or `first_T`, as long as it is
    unstable, then back by halves and quarters. Its further search by .002, for steps of .10 and
    more, can never be reached.

    Raises
    ------
    NoBoundary
        All unstable down to OMEGB = 0, or over `MAX_STEPS`: the listing would go on for ever.
    """
    first = evaluate(OMEGB)
    yield first
    if not first.unstable:
        return
    step = 1.2 * ((first.STAB1 if first_T is None else first_T) + ETA)
    step = 0.04 if step > 0.10 else step
    for away in (-step, step):
        at, inside, outside, steps = OMEGB + away, 0, 0, 0
        while True:
            steps += 1
            if at <= 0.0 or steps > MAX_STEPS:
                raise NoBoundary(
                    f"SWITCH finds no boundary of the instability at OMEGB = {OMEGB:.3f}, "
                    f"as far as {at - away:.3f} by steps of {abs(away):.2g}"
                )
            found = evaluate(at)
            yield found
            if found.unstable and not outside:
                at += away
                continue
            inside += found.unstable
            outside += not found.unstable
            if outside == 3 or inside == 2 or (outside == 2 and inside == 1):
                break
            if found.unstable:
                at += away / 4.0
            else:
                at -= away / 2.0 if outside == 1 else away / 4.0


def _deter(F: Float, G: Float, H: Float, case: Case, OMEGB: float, j: int, M: int) -> float:
    """SUBROUTINE DETER for one pole: the finite determinant Delta_j."""
    n, blocks = len(F), 2 * M + 1
    m = np.arange(M, -M - 1, -1)
    w = np.sqrt(np.abs(F[j, j])) / OMEGB
    divisor = np.diag(F) / OMEGB**2 - ((w - m) ** 2)[:, None]
    divisor[M, j] = 1.0
    table = np.kron(np.eye(blocks), F - np.diag(np.diag(F)))
    table += np.kron(np.eye(blocks, k=1) + np.eye(blocks, k=-1), 0.5 * case.GAMMA * G)
    if case.Q:
        for i, H_i in enumerate(H, start=1):
            p = i * case.Q
            table += np.kron(np.eye(blocks, k=p) + np.eye(blocks, k=-p), 0.5 * H_i)
    table /= (divisor * OMEGB**2).reshape(-1, 1)
    table[np.diag_indices(n * blocks)] = 1.0
    table[M * n + j, M * n + j] = 0.0
    return float(np.linalg.det(table))


def coefficients(deck: Uniform | Stepped, case: Case, OMEGB: float) -> tuple[Float, Float, Float]:
    """F (less eta^2/4), G and H as DETER sees them."""
    if isinstance(deck, Stepped):
        F, G = _stepped(deck, case, OMEGB)
        return F - 0.25 * case.ETA**2 * np.eye(len(F)), G, np.zeros((0, *F.shape))
    F, G, H = _uniform(deck, case, OMEGB)
    scale = case.TO / deck.R[0] ** 4
    F, N = scale * F, deck.N
    # SLIP: the rotation coordinate keeps its eta^2/4
    F[range(N), range(N)] += (deck.R[:N] / deck.R[0]) ** 4 - 0.25 * case.ETA**2
    return F, scale * G, scale * H


def frequencies(deck: Uniform | Stepped, case: Case) -> Float:
    """FREQ(1), FREQ(2), ... of FORMAT 1, ascending by their squares, signs dropped."""
    F, _, _ = coefficients(deck, replace(case, OMEGL=100.0), 1.0)  # F depends on neither
    if case.SPC == 0.0:
        F = F[: deck.N, : deck.N]
    return np.sqrt(np.abs(np.sort(np.linalg.eigvals(F).real)))


def _uniform(deck: Uniform, case: Case, OMEGB: float) -> tuple[Float, Float, Float]:
    """SUBROUTINE COEF of the uniform program, before the factor TO/R(1)**4."""
    N, PI = deck.N, deck.PI
    SIG = OMEGB / case.OMEGL
    X = PI * np.sqrt(SIG**2 - 1j * case.GA) if case.GA > 0 else PI * SIG
    FJK, GJK, HIJK = _integ(deck, case, X)
    PH, DPH, DPHG = deck.PH[:N], deck.DPH[:N], deck.DPHG[:N]

    F, G = np.zeros((N + 1, N + 1)), np.zeros((N + 1, N + 1))
    side = np.outer(PH, DPH + case.SPC * DPHG)
    F[:N, :N], G[:N, :N] = side - FJK, side - GJK[:N, :N]
    F[N, :N] = 12.0 * (0.5 * DPH - PH + 0.5 * case.SPC * DPHG)
    G[N, :N] = F[N, :N] + 12.0 * GJK[N, :N]
    F[:N, N] = case.SPC * PH
    G[:N, N] = GJK[:N, N] + case.SPC * PH
    F[N, N] = 6.0 * case.SPC
    G[N, N] = 12.0 * (0.5 - np.real((1.0 - np.cos(X)) / (X * np.sin(X))) + 0.5 * case.SPC)

    H = np.zeros((case.S, N + 1, N + 1))
    for i in range(1, case.S + 1):
        # SLIP: A_s of (4.6.3) for C_s of (4.6.6), a factor s pi too small
        A = 2.0 * (-1.0) ** i * (1.0 / i**2 + case.GAMMA / (i**2 - SIG**2)) / PI**2
        H[i - 1] = -A * HIJK[i - 1]
        H[i - 1, N] *= 12.0
        H[i - 1, N, N] = 12.0 * ((-1.0) ** i - 1.0) * A / (PI * i)
    return F, G, H


def _integ(deck: Uniform, case: Case, X: complex) -> tuple[Float, Float, Float]:
    """SUBROUTINE INTEG of the uniform program."""
    N, R, B = deck.N, deck.R, deck.B
    turn = 1j ** np.arange(4)
    FJK, GJK = np.zeros((N, N)), np.zeros((N + 1, N + 1))
    HIJK = np.zeros((case.S, N + 1, N + 1))
    Y = deck.PI * np.arange(1, case.S + 1)
    sign = (-1.0) ** np.arange(1, case.S + 1)
    for j in range(N):
        for k in range(j, N):
            CA = np.add.outer(R[j] * turn, R[k] * turn)
            CB = 0.25 * R[j] * R[k] * np.multiply.outer(B[j] + turn, B[k] + turn)
            force = (CA * np.sin(X) - X * np.cos(X)) * np.exp(CA) + X
            GJK[j, k] = GJK[k, j] = np.sum(CB / (CA**2 + X**2) * force / np.sin(X)).real
            HIJK[:, j, k] = HIJK[:, k, j] = [
                np.sum(CB * y / (CA**2 + y**2) * (1.0 - s * np.exp(CA))).real
                for y, s in zip(Y, sign, strict=True)
            ]
            FJK[j, k] = FJK[k, j] = _fjk(j, k, R, B)
    if case.SPC == 0.0:
        GJK[:N, :N] = FJK
    for k in range(N):
        odd = (-1.0) ** (k + 1)
        D, P, C, S = deck.DPH[k], deck.PH[k], np.cos(X), np.sin(X)
        over = 1.0 / (R[k] ** 4 - X**4)
        GJK[N, k] = np.real(over * (X**3 * D * (odd - C) - X**4 * P * S) / S)
        # SLIP: not the integral of phi_j Phi' that (4.5.24) asks for
        GJK[k, N] = np.real(-over * (X**2 * D * S + X**3 * P * (C + odd)) / S)
        HIJK[:, N, k] = HIJK[:, k, N] = Y**3 * D * (sign - odd) / (R[k] ** 4 - Y**4)
    return FJK, GJK, HIJK


def _fjk(j: int, k: int, R: Float, B: Float) -> float:
    """Integral of xi phi_j' phi_k' by the formulas of reference 7."""
    if j == k:
        return float(0.5 * B[j] * R[j] * (B[j] * R[j] - 6.0))
    sign = (-1.0) ** (j + k)
    apart = R[k] ** 4 - R[j] ** 4
    first = 4.0 * sign * R[j] * R[k] / apart * (B[k] * R[j] ** 3 - B[j] * R[k] ** 3)
    return float(first + 16.0 * (R[j] * R[k]) ** 4 / apart**2 * (sign - 1.0))


@dataclass(frozen=True, eq=False)
class _Station:
    """phi and its derivatives over powers of lambda, all modes, at one tabulated station."""

    xi: float
    d0: Float
    d1: Float
    d2: Float
    d3: Float


def _station(deck: Stepped, xi: float) -> _Station:
    """Row L = 10 xi of the tables; row 11 stands for xi = 0, filled in by symmetry."""
    L, N = int(10.0 * xi + 0.5), deck.N
    tables = (deck.D0PH, deck.D1PH, deck.D2PH, deck.D3PH)
    if L >= 1:
        return _Station(xi, *(table[L - 1, :N] for table in tables))
    sign, none = (-1.0) ** np.arange(N), np.zeros(N)
    return _Station(0.0, sign * deck.D0PH[9, :N], -sign * deck.D1PH[9, :N], none, none)


def _stepped(deck: Stepped, case: Case, OMEGB: float) -> tuple[Float, Float]:
    """SUBROUTINES COEF and INTEG of the stepped program."""
    if case.RC is None:
        raise ValueError("RC = None: the stepped program needs the station of the step")
    N, RC, RA, RI, SPC = deck.N, case.RC, case.RA, case.RI, case.SPC
    R = deck.R[:N]
    start, step, end, sensor = (_station(deck, xi) for xi in (0.0, RC, 1.0, case.XG))
    MR = RA + (1.0 - RA) * (1.0 - RC)
    TOR4 = case.TO / R[0] ** 4

    mass_inner, bend_inner = _beyond_step(R, step, end)
    beyond = _xi_slopes(R, end) - RA * _xi_slopes(R, start) - (1.0 - RA) * _xi_slopes(R, step)
    beyond -= RC * (1.0 - RA) * (_slopes(R, end) - _slopes(R, step))
    P11 = (RA * end.d0 + (1.0 - RA) * ((1.0 - RC) * end.d0 + step.d3 / R)) / MR
    P1 = 0.5 * (RA + (1.0 - RA) * (1.0 - RC) ** 2) / MR

    A, C = np.empty((N + 2, N + 2)), np.zeros((N + 2, N + 2))
    A[:N, :N] = (1.0 - RA) * mass_inner + RA * np.eye(N)
    A[N, :N] = A[:N, N] = -(1.0 - RA) * (RC * R * step.d3 - step.d2) / R**2
    A[N + 1, :N] = A[:N, N + 1] = -(1.0 - RA) * step.d3 / R
    A[N, N] = (RA + (1.0 - RA) * (1.0 - RC**3)) / 3.0
    A[N, N + 1] = A[N + 1, N] = 0.5 * (RA + (1.0 - RA) * (1.0 - RC**2))
    A[N + 1, N + 1] = MR
    side = (end.d1 + SPC * sensor.d1) * R
    C[:N, :N] = np.outer(end.d0, side) - beyond / MR
    C[N, :N], C[N + 1, :N] = side - P11, side
    C[:N, N] = end.d0 * (1.0 + SPC) - P11
    C[N, N], C[N + 1, N] = 1.0 + SPC - P1, 1.0 + SPC
    D = C.copy()
    if case.OMEGL <= RIGID or case.always_compliant:
        P211, P21, P2 = _compliant(deck, case, OMEGB)
        D[:N, :N] = np.outer(end.d0, side) - P211
        D[N, :N] = side - P21
        D[:N, N] = end.d0 * (1.0 + SPC) - P21
        D[N, N] = 1.0 + SPC - P2
    C, D = TOR4 * C, TOR4 * D
    C[:N, :N] += (1.0 - RI) * bend_inner / R[0] ** 4 + np.diag(RI * (R / R[0]) ** 4)
    F, G = np.linalg.solve(A, C), np.linalg.solve(A, D)
    return F[: N + 1, : N + 1], G[: N + 1, : N + 1]


def _compliant(deck: Stepped, case: Case, OMEGB: float) -> tuple[Float, Float, float]:
    """P211, P21 and P2 of INTEG: integrals with the pulsating force of Eq. (5.3.12)."""
    N, RC, RA = deck.N, float(case.RC or 0.0), case.RA
    R, B, X = deck.R[:N], deck.B[:N], deck.PI * OMEGB / case.OMEGL
    BE = np.sin(X * (1 - RC)) * np.cos(X * RC) + RA * np.sin(X * RC) * np.cos(X * (1 - RC))
    BC = (1.0 - RA) / BE * np.cos(X * RC)
    BD = (1.0 - BC * np.sin(X * (1 - RC))) / np.sin(X)

    def csum(Y: float, CA: Complex, Z: float) -> Complex:
        return np.exp(Z * CA) * (CA * np.sin(X * Y) - X * np.cos(X * Y))

    def force(CA: Complex, CB: Complex) -> float:
        whole = csum(1.0, CA, 1.0) - csum(0.0, CA, 0.0)
        step = csum(1.0 - RC, CA, 1.0) - csum(0.0, CA, RC)
        return float(np.sum(CB / (CA**2 + X**2) * (BD * whole + BC * step)).real)

    turn = 1j ** np.arange(4)
    P21 = np.array([0.5 * R[j] * force(R[j] * turn, B[j] + turn) for j in range(N)])
    P211 = np.array(
        [
            [
                0.25
                * R[j]
                * R[k]
                * force(
                    np.add.outer(R[j] * turn, R[k] * turn),
                    np.multiply.outer(B[j] + turn, B[k] + turn),
                )
                for k in range(N)
            ]
            for j in range(N)
        ]
    )
    P2 = (BD * (1.0 - np.cos(X)) + BC * (1.0 - np.cos(X * (1.0 - RC)))) / X
    return P211, P21, float(P2)


def _beyond_step(R: Float, c: _Station, end: _Station) -> tuple[Float, Float]:
    """T00CL and T22CL: integrals of phi_j phi_k and phi_j'' phi_k'' from the step to the end."""
    N = len(R)
    T00, T22 = np.empty((N, N)), np.empty((N, N))
    for j in range(N):
        for k in range(N):
            a, b = R[j], R[k]
            if j == k:
                T00[j, j] = 0.25 * end.d0[j] ** 2 - 0.25 * (
                    3.0 * c.d0[j] * c.d3[j] / a
                    + c.xi * c.d0[j] ** 2
                    - 2.0 * c.xi * c.d1[j] * c.d3[j]
                    - c.d1[j] * c.d2[j] / a
                    + c.xi * c.d2[j] ** 2
                )
                inner = 3.0 * c.d2[j] * c.d1[j] - c.d0[j] * c.d3[j]
                inner += c.xi * a * (c.d2[j] ** 2 - 2.0 * c.d1[j] * c.d3[j] + c.d0[j] ** 2)
                T22[j, j] = 0.25 * a**3 * (a * end.d0[j] ** 2 - inner)
                continue
            T00[j, k] = -(
                c.d0[k] * c.d3[j] * a**3
                - c.d0[j] * c.d3[k] * b**3
                - c.d1[k] * c.d2[j] * b * a**2
                + c.d1[j] * c.d2[k] * a * b**2
            ) / (a**4 - b**4)
            T22[j, k] = (
                -((a * b) ** 2)
                * (
                    c.d1[j] * c.d2[k] * a**3
                    - c.d1[k] * c.d2[j] * b**3
                    - c.d0[j] * c.d3[k] * b * a**2
                    + c.d0[k] * c.d3[j] * a * b**2
                )
                / (a**4 - b**4)
            )
    return T00, T22


def _slopes(R: Float, at: _Station) -> Float:
    """FUNCTIONS CJJ and CJK: an antiderivative of phi_j' phi_k'."""
    a, b = R[:, None], R[None, :]
    d0, d1, d2, d3 = at.d0, at.d1, at.d2, at.d3
    cross = _cross(R, at)
    apart = a**4 - b**4
    table = np.divide(cross, apart, out=np.zeros_like(cross), where=apart != 0)
    own = 3.0 * d0 * d1 * R - d2 * d3 * R
    own += at.xi * R**2 * (d1**2 - 2.0 * d0 * d2 + d3**2)
    table[np.diag_indices(len(R))] = 0.25 * own
    return table


def _xi_slopes(R: Float, at: _Station) -> Float:
    """FUNCTIONS XJJ and XJK: an antiderivative of xi phi_j' phi_k'."""
    a, b = R[:, None], R[None, :]
    d0, d1, d2, d3 = at.d0, at.d1, at.d2, at.d3
    apart = a**4 - b**4
    second = np.outer(d3, d1) * b * a**3 * (a**4 + 3.0 * b**4)
    second += np.outer(d1, d3) * a * b**3 * (3.0 * a**4 + b**4)
    second -= 2.0 * np.outer(d2, d2) * (a * b) ** 2 * (a**4 + b**4)
    second -= 4.0 * np.outer(d0, d0) * (a * b) ** 4
    apart_or_1 = np.where(apart == 0, 1.0, apart)
    table = at.xi * _cross(R, at) / apart_or_1 - second / apart_or_1**2
    x = at.xi * R
    own = 6.0 * x * d0 * d1 - 2.0 * x * d2 * d3 - 3.0 * d0**2 + d2**2
    own += x**2 * (d1**2 - 2.0 * d0 * d2 + d3**2)
    table[np.diag_indices(len(R))] = 0.125 * own
    return table


def _cross(R: Float, at: _Station) -> Float:
    a, b = R[:, None], R[None, :]
    cross: Float = np.outer(at.d0, at.d1) * b * a**4 - np.outer(at.d1, at.d0) * a * b**4
    cross += np.outer(at.d2, at.d3) * a**2 * b**3 - np.outer(at.d3, at.d2) * b**2 * a**3
    return cross
