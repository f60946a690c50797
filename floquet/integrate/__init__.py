"""From the identity to the fundamental matrix: the equation in CasADi, one file a method."""
