"""P(z) of many equations at once."""

from floquet.batch.equations import Polynomials, polynomials, sweep

__all__ = ["Polynomials", "polynomials", "sweep"]
