"""A vehicle's damping of all coordinates alike, as the forcing's eta.

A chart's T is read with the forcing's eta, and matrices are kept from one eta to the next: what a
vehicle adds to what is asked would be lost.
"""

from dataclasses import replace

from hill import Vehicle


def damping_as_forcing(vehicle: Vehicle, eta: float) -> tuple[Vehicle, float]:
    """The same under the same damping: a vehicle without ``damping.eta``, and the eta in all."""
    own = vehicle.damping
    return replace(vehicle, damping=replace(own, eta=0.0)), eta + own.eta
