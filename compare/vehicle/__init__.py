"""Appendix A for one's own vehicle: what the thrust's pulsation does to it, in its own units."""
