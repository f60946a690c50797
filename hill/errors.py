"""Refusals that somebody may want to tell apart from each other, and from a mistake in the code."""


class Refused(ValueError):
    """Input that cannot be answered, said in one line."""


class LongitudinalResonance(Refused):
    """The undamped axial force is infinite: there is no equation at this point."""
