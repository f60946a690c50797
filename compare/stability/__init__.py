"""The judge's own roots and indicators of a given P(z)."""
