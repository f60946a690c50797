"""The report's beams in balls, from exact decimals, in closed form.

Modes are sums of exponentials exp(lambda_n i^p xi), and so are the products whose integrals make
the matrices: `hill.matrices` says the same in floats, with equation numbers.
"""

from functools import lru_cache
from typing import Any

from flint import acb, arb, arb_mat, ctx

from hill.decimals import ExactBeam
from hill.enclosure.rows import number

Term = tuple[Any, tuple[int, int] | None]
"""A coefficient, and (n, p) of its exponent; None where that is zero."""

Shape = list[Term]


@lru_cache(maxsize=64)
def matrices(beam: ExactBeam, bits: int) -> tuple[Any, Any, list[Any]]:
    """F, G and the H_s, (modes + 1, modes + 1) each."""
    with ctx.workprec(bits):
        modes = _Modes(beam.modes)
        return _stepped(beam, modes) if beam.stepped else _uniform(beam, modes)


class _Modes:
    """Roots lambda_n, modes and slopes, and integrals of products of two of them."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.roots = [_root(n) for n in range(1, count + 1)]
        self.shapes = [self._mode(n) for n in range(count)]
        self.slopes = [self.derived(f) for f in self.shapes]

    def _mode(self, n: int) -> Shape:
        """phi_n, Eq. (4.5.31): cosh + cos - a (sinh + sin)."""
        x = self.roots[n]
        a = (x.cosh() - x.cos()) / (x.sinh() - x.sin())
        parts = [acb(1 - a), acb(1, a), acb(1 + a), acb(1, -a)]
        return [(part / 2, (n, p)) for p, part in enumerate(parts)]

    def exponent(self, key: tuple[int, int]) -> Any:
        """lambda_n i^p."""
        n, p = key
        return acb(self.roots[n]) * (acb(1), acb(0, 1), acb(-1), acb(0, -1))[p]

    def derived(self, f: Shape) -> Shape:
        """d/dxi."""
        return [(c * self.exponent(key), key) for c, key in f if key is not None]

    def at(self, f: Shape, x: Any) -> Any:
        """Value at a station."""
        total = acb(0)
        for c, key in f:
            total += c * (self.exponent(key) * x).exp() if key is not None else c
        return total.real

    def product(self, f: Shape, g: Shape) -> list[tuple[Any, Any]]:
        """Coefficients and exponents; None where the exponents cancel exactly."""
        return [(c * d, self._sum(a, b)) for c, a in f for d, b in g]

    def _sum(self, a: tuple[int, int] | None, b: tuple[int, int] | None) -> Any:
        if a is None or b is None:
            one = a if b is None else b
            return None if one is None else self.exponent(one)
        if a[0] == b[0] and (a[1] - b[1]) % 4 == 2:
            return None
        return self.exponent(a) + self.exponent(b)

    def integral(self, f: Shape, g: Shape, a: Any, b: Any, power: int = 0) -> Any:
        """Of f g xi^power from a to b."""
        total = acb(0)
        for c, mu in self.product(f, g):
            total += c * _moment(mu, power, a, b)
        return total.real

    def with_sine(self, f: Shape, g: Shape, nu: Any, start: Any) -> Any:
        """Integral of f g sin(nu (xi - start))/nu from `start` to 1; nu is not zero."""
        total, turn = acb(0), (acb(0, 1) * nu * start).exp()
        for c, mu in self.product(f, g):
            up = _exponential(acb(0, 1) * nu, mu, start)
            down = _exponential(acb(0, -1) * nu, mu, start)
            total += c * (up / turn - down * turn)
        return total / (acb(0, 2) * nu)


UNIT: Shape = [(acb(1), None)]


def _root(n: int) -> Any:
    """lambda_n: where cos x - sech x, monotonic about (n + 1/2) pi, changes its sign."""
    middle = arb(2 * n + 1) / 2 * arb.pi()
    about = middle + arb(0, 0.1)

    def value(x: Any) -> Any:
        return x.cos() - 1 / x.cosh()

    slope = about.sinh() / about.cosh() ** 2 - about.sin()
    assert slope > 0 or slope < 0, "monotonic"
    x = middle.mid()
    for _ in range(2 + ctx.prec.bit_length()):
        x = (x - value(x) / (x.sinh() / x.cosh() ** 2 - x.sin())).mid()
    off = arb(2) ** (8 - ctx.prec) * x
    low, high = value(x - off), value(x + off)
    assert (low > 0 and high < 0) or (low < 0 and high > 0), "a change of sign"
    return x + arb(0, off.upper())


def _moment(mu: Any, power: int, a: Any, b: Any) -> Any:
    """Integral of xi^power exp(mu xi) from a to b; mu = None is zero."""
    if mu is None:
        return acb((b ** (power + 1) - a ** (power + 1)) / (power + 1))
    if power == 0:
        return ((mu * b).exp() - (mu * a).exp()) / mu
    ends = b**power * (mu * b).exp() - a**power * (mu * a).exp()
    return (ends - power * _moment(mu, power - 1, a, b)) / mu


def _exponential(turn: Any, mu: Any, start: Any) -> Any:
    """Integral of exp((mu + turn) xi) from `start` to 1, which may be near zero."""
    m = turn if mu is None else turn + mu
    width = 1 - start
    return width * (m * (1 + start) / 2).exp() * (acb(0, 1) * m * width / 2).sinc()


def _uniform(beam: ExactBeam, modes: _Modes) -> tuple[Any, Any, list[Any]]:
    """Eqs. (4.5.19) to (4.5.30) as corrected."""
    slopes = [*modes.slopes, UNIT]
    arm = [*(modes.at(f, 1) for f in modes.shapes), arb(1) / 2]
    side = [modes.at(f, 1) + number(beam.K_theta) * modes.at(f, number(beam.xi_G)) for f in slopes]
    scale = number(beam.T0) / modes.roots[0] ** 4
    scales = [*([scale] * modes.count), 12 * scale]

    def thrust(axial: list[list[Any]]) -> Any:
        return arb_mat(
            [
                [scales[j] * (arm[j] * side[k] - axial[j][k]) for k in range(len(side))]
                for j in range(len(arm))
            ]
        )

    zero, one = arb(0), arb(1)
    steady = [[modes.integral(f, g, zero, one, 1) for g in slopes] for f in slopes]
    stiffness = [
        [(modes.roots[j] / modes.roots[0]) ** 4 if j == k and j < modes.count else zero
         for k in range(len(arm))]
        for j in range(len(arm))
    ]  # fmt: skip
    F = arb_mat(stiffness) + thrust(steady)
    if beam.sigma or beam.g:
        wave = acb(number(beam.sigma))
        if beam.g:
            wave = (wave**2 - acb(0, 1) * number(beam.g)).sqrt()
        nu = wave * arb.pi()
        pulsating = [
            [(modes.with_sine(f, g, nu, zero) / nu.sinc()).real for g in slopes] for f in slopes
        ]
        G = thrust(pulsating)
    else:
        G = thrust(steady)
    H = []
    for s in range(1, beam.terms + 1):
        # C_s of (4.6.6) as corrected
        sigma, gamma = number(beam.sigma), number(beam.gamma)
        start = 2 * s * (-1) ** s / arb.pi() * (arb(1) / s**2 + gamma / (s**2 - sigma**2))
        nu = acb(arb.pi() * s)
        load = [[(modes.with_sine(f, g, nu, zero) * nu).real for g in slopes] for f in slopes]
        H.append(arb_mat([[-scales[j] * start * x for x in row] for j, row in enumerate(load)]))
    return F, G, H


def _stepped(beam: ExactBeam, modes: _Modes) -> tuple[Any, Any, list[Any]]:
    """A, B and C of chapter 5, over lambda_1^4, and A^-1 B, A^-1 C."""
    zero, one, c = arb(0), arb(1), number(beam.xi_c)
    area, inertia = number(beam.area_ratio), number(beam.inertia_ratio)
    shapes = [*modes.shapes, UNIT, UNIT]
    powers = [*([0] * modes.count), 1, 0]
    size = modes.count + 2

    def weighed(f: Shape, g: Shape, ahead: Any, power: int = 0) -> Any:
        return ahead * modes.integral(f, g, zero, c, power) + modes.integral(f, g, c, one, power)

    A = arb_mat(
        [
            [weighed(shapes[j], shapes[k], area, powers[j] + powers[k]) for k in range(size)]
            for j in range(size)
        ]
    )
    bends = [modes.derived(f) for f in modes.slopes]
    B = [[zero] * size for _ in range(size)]
    for j, f in enumerate(bends):
        for k, g in enumerate(bends):
            B[j][k] = weighed(f, g, inertia) / modes.roots[0] ** 4
    slopes: list[Shape] = [*modes.slopes, UNIT, []]
    arm = [*(modes.at(f, 1) for f in modes.shapes), one, one]
    side = [modes.at(f, 1) + number(beam.K_theta) * modes.at(f, number(beam.xi_G)) for f in slopes]

    def thrust(sigma: Any) -> Any:
        nu = number(sigma) * arb.pi()
        rest = 1 - c
        stiffness = (nu * c).cos() * rest * (nu * rest).sinc() + area * c * (nu * c).sinc() * (
            nu * rest
        ).cos()
        d, e = area / stiffness, (1 - area) * (nu * c).cos() / stiffness

        def axial(f: Shape, g: Shape) -> Any:
            if sigma:
                wave = acb(nu)
                ahead, behind = (modes.with_sine(f, g, wave, start) for start in (zero, c))
                return (d * ahead + e * behind).real
            first = modes.integral(f, g, zero, one, 1)
            step = modes.integral(f, g, c, one, 1) - c * modes.integral(f, g, c, one)
            return d * first + e * step

        scale = number(beam.T0) / modes.roots[0] ** 4
        return arb_mat(
            [
                [scale * (arm[j] * side[k] - axial(slopes[j], slopes[k])) for k in range(size)]
                for j in range(size)
            ]
        )

    def reduced(load: Any) -> Any:
        return arb_mat([row[:-1] for row in A.solve(load).tolist()[:-1]])

    return reduced(arb_mat(B) + thrust(0)), reduced(thrust(beam.sigma)), []
