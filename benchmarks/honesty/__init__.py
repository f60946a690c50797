"""The trial of the bounds: hostile systems, every route, an arbiter in ball arithmetic."""
