"""Derivatives of T and z, by CasADi's automatic differentiation through the period."""
