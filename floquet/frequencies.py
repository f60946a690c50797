"""Natural frequencies of the unforced equation, from the time domain's own matrices."""

import numpy as np

from floquet.arrays import Complex
from hill import HillEquation


def natural_frequencies(equation: HillEquation) -> Complex:
    """Square roots of F's eigenvalues, (n,), ascending by real part.

    A stable beam's are real; an imaginary one diverges, a conjugate pair flutters.
    """
    squares, _ = np.linalg.eig(equation.F)
    roots = np.sqrt(squares.astype(complex))
    return np.asarray(roots[np.lexsort((roots.imag, roots.real))])
