"""General periodic systems from the literature, with what their source says; and random ones."""

import numpy as np

from benchmarks.routes.systems import random_periodic
from hill import Fourier, PeriodicEquation

__all__ = [
    "BITTANTI_COLANERI", "BITTANTI_COLANERI_FIRST_ORDER", "EXPONENTS", "VINOGRAD",
    "ZHOU_HAGIWARA", "asymmetric_rotor", "random_periodic",
]  # fmt: skip

# A = [[-1 - 9 c^2 + 12 s c, 12 c^2 + 9 s c], [-12 s^2 + 9 s c, -1 - 9 s^2 - 12 s c]], c = cos 6t,
# s = sin 6t: its eigenvalues are -1 and -10 at every t (Vinograd 1952). Period pi/6.
VINOGRAD = PeriodicEquation.first_order(
    A=Fourier(
        [[-5.5, 6.0], [-6.0, -5.5]],
        cos={1: [[-4.5, 6.0], [6.0, 4.5]]},
        sin={1: [[6.0, 4.5], [4.5, -6.0]]},
    ),
    Omega=12.0,
)
# A = [[-1 - sin^2 2t, 2 - sin(4t)/2], [-2 - sin(4t)/2, -1 - cos^2 2t]] (Zhou and Hagiwara 2002).
ZHOU_HAGIWARA = PeriodicEquation.first_order(
    A=Fourier(
        [[-1.5, 2.0], [-2.0, -1.5]],
        cos={1: [[0.5, 0.0], [0.0, -0.5]]},
        sin={1: [[0.0, -0.5], [-0.5, 0.0]]},
    ),
    Omega=4.0,
)
# x'' + (24 + 10 sin t) x' + 10 cos t x is (x' + (24 + 10 sin t) x)' (Bittanti and Colaneri).
BITTANTI_COLANERI = PeriodicEquation(
    K=Fourier([[0.0]], cos={1: [[10.0]]}), C=Fourier([[24.0]], sin={1: [[10.0]]}), Omega=1.0
)
BITTANTI_COLANERI_FIRST_ORDER = PeriodicEquation.first_order(
    A=Fourier(
        [[0.0, 1.0], [0.0, -24.0]],
        cos={1: [[0.0, 0.0], [-10.0, 0.0]]},
        sin={1: [[0.0, 0.0], [0.0, -10.0]]},
    ),
    Omega=1.0,
)


def asymmetric_rotor(damping: float = 0.0) -> PeriodicEquation:
    """Stiffness 1 +- 0.2 turning at the speed 1, seen from where it does not turn."""
    return PeriodicEquation(
        K=Fourier(
            np.eye(2),
            cos={1: [[0.2, 0.0], [0.0, -0.2]]},
            sin={1: [[0.0, 0.2], [0.2, 0.0]]},
        ),
        C=damping * np.eye(2),
        Omega=2.0,
    )


# From their sources; the imaginary part up to whole multiples of Omega.
EXPONENTS: dict[str, tuple[PeriodicEquation, tuple[complex, ...]]] = {
    "vinograd": (VINOGRAD, (2.0 + 6.0j, -13.0 + 6.0j)),
    "zhou-hagiwara": (ZHOU_HAGIWARA, (-1.0 + 2.0j, -2.0 + 2.0j)),
    "bittanti-colaneri": (BITTANTI_COLANERI, (0.0, -24.0)),
    "bittanti-colaneri, first order": (BITTANTI_COLANERI_FIRST_ORDER, (0.0, -24.0)),
    # turned with it: r'' + 2 J r' + diag(k0 + dk - 1, k0 - dk - 1) r = 0
    "asymmetric rotor": (
        asymmetric_rotor(),
        tuple(
            1j + s * np.sqrt(-2.0 + t * np.sqrt(4.04) + 0j)
            for s in (1.0, -1.0)
            for t in (1.0, -1.0)
        ),
    ),
}
