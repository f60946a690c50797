"""P(z) of many equations at once."""

from floquet.batch.equations import Polynomials, polynomials, sweep
from floquet.batch.which_kernel import kernel_in_use

__all__ = ["Polynomials", "kernel_in_use", "polynomials", "sweep"]
