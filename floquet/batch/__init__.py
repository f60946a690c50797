"""P(z) of many equations at once."""

from floquet.batch.equations import Polynomials, polynomials, sweep
from floquet.batch.which_kernel import in_use

__all__ = ["Polynomials", "in_use", "polynomials", "sweep"]
