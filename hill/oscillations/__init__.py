"""Oscillations one by one: of the steady system, and two at a time under pulsation."""
