"""Taylor steps of a periodic equation from the identity, at any phase, by recurrence in CasADi."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from floquet.arrays import Float
from floquet.integrate import recurrence
from floquet.integrate.normal_form import Harmonic, Layout, NormalForm
from floquet.integrate.phases import Whole
from floquet.integrate.taylor import SX_OPERATIONS


class Steps:
    """The steps of one equation, all of one length.

    Parameters
    ----------
    form : NormalForm
    order : int
        Highest power of the step kept.
    total : int
        How many the period has.
    unit : float
        Of time, a power of two: the state is (q, unit q').

    Attributes
    ----------
    h : float
        Length of a step, in units.
    """

    def __init__(self, form: NormalForm, order: int, total: int, unit: float) -> None:
        layout = form.layout
        self.form, self.order, self.total = form, order, total
        self.h = form.period / total / unit
        stiffness = form.stiffness * (unit if layout.first_order else unit * unit)
        given = [np.hstack(list(stiffness))]
        if layout.damped:
            given.append(np.hstack(list(form.damping * unit)))
        turn = 2.0 * np.pi / total * np.array(form.harmonics, float)
        self._shared = (self.h, turn, *given)

    def __call__(self, at: Whole, of: int) -> Float:
        """Matrices (k, m, m) of the steps that begin at these `of`-ths of the period."""
        function = _mapped(self.form.layout, self.order, len(at))
        wide = np.asarray(function(*self.inputs(at, of)))
        m = self.form.layout.order
        return wide.reshape(m, -1, m).transpose(1, 0, 2)

    def inputs(self, at: Whole, of: int) -> list[Any]:
        """What `step_function` takes, side by side; all but the last two are shared."""
        # in whole numbers the phase of a high harmonic loses nothing
        turns = np.outer(np.array(self.form.harmonics, int), at) + of // 2
        phase = 2.0 * np.pi / of * (turns % of - of // 2)
        return [*self._shared, np.cos(phase), np.sin(phase)]


@lru_cache(maxsize=256)
def _mapped(layout: Layout, order: int, count: int) -> Any:
    """`count` steps side by side; only the phases differ."""
    shared = 4 if layout.damped else 3
    return step_function(layout, order).map("steps", "serial", count, list(range(shared)), [])


@lru_cache(maxsize=64)
def step_function(layout: Layout, order: int) -> Any:
    """A step from the identity, in units of time in which its length is `h`."""
    n, m = layout.n, layout.order
    pulsating = 2 + len(layout.stiffness) + len(layout.damping)
    operations = n * m * order * (order + 2 * m) * pulsating // 2
    kind: Any = ca.SX if operations < SX_OPERATIONS else ca.MX
    h, turn = kind.sym("h"), kind.sym("turn", layout.harmonics)
    c, s = kind.sym("c", layout.harmonics), kind.sym("s", layout.harmonics)

    def system(matrix: Any, harmonics: Sequence[Harmonic]) -> tuple[Any, list[recurrence.Term]]:
        mean, *parts = ca.horzsplit(matrix, n)
        found = []
        for part, (k, is_sine) in zip(parts, harmonics, strict=True):
            series = recurrence.sine if is_sine else recurrence.cosine
            found.append((part, series(c[k], s[k], turn[k], order)))
        return mean, found

    K = kind.sym("K", n, n * (1 + len(layout.stiffness)))
    stiffness, given = system(K, layout.stiffness), [h, turn, K]
    damping = None
    if layout.damped:
        C = kind.sym("C", n, n * (1 + len(layout.damping)))
        damping = system(C, layout.damping)
        given.append(C)
    start = kind(ca.DM(np.eye(m)))
    if layout.first_order:
        end = recurrence.first_order(start, h, order, stiffness)
    else:
        Q, V = start[:n, :], start[n:, :]
        end = ca.vertcat(*recurrence.second_order(Q, V, h, order, stiffness, damping))
    return ca.Function("step", [*given, c, s], [ca.densify(end)])
