"""The infinite determinant: finite ones, their limit, many at once, residues, rounding."""
