"""Refusals that somebody may want to tell apart from each other, and from a mistake in the code."""


class Refused(ValueError):
    """Input that cannot be answered, said in one line."""


class Singular(Refused):
    """There is no equation at this point: a coefficient has a pole there."""


class LongitudinalResonance(Singular):
    """The undamped axial force is infinite."""
