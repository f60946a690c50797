"""The report's figures, 3 to 29: number, caption, kind and parameters. Data only.

The drawings are lost. Captions are the report's; parameters are those of its text and tables, and
where it gives none, `assumed` says what was taken.
"""

from dataclasses import dataclass
from math import inf
from typing import Any, Literal

from compare.report.tables import ETA, STEPPED, UNIFORM

Kind = Literal[
    "frequencies", "growth", "regions", "critical", "compliance", "integral", "resonant", "coupled"
]

NORM = {"T0": 0.0, "K_theta": 1.0, "xi_G": 0.5}
"""Section 7.2."""

ORDER = (
    "2 omega_(B)",
    "omega_(1) + omega_(B)",
    "omega_(2) - omega_(1)",
    "2 omega_(1)",
    "omega_(2) + omega_(B)",
    "2 omega_(2)",
)
"""Resonances of Tables 1 and 2 (and Table 3: the difference), by frequency."""


@dataclass(frozen=True)
class Figure:
    """One figure of the report.

    Attributes
    ----------
    number : int
    caption : str
        The report's, with its misprints corrected.
    kind : str
        How it is computed and drawn.
    beam : dict
        Parameters of `UniformBeam` or, with xi_c, `SteppedBeam`.
    assumed : str
        What the report does not say and was taken here.
    along : {"T0", "gamma", ...}
        The second parameter; of the family, for natural frequencies.
    values : tuple of float
        The family's values: of `along` (natural frequencies), of T0 (critical), of g (coupled).
    span : (float, float)
        Range of the second parameter.
    resonance : str
        For T_x against gamma.
    eta : float
    table : int
        The printed points.
    """

    number: int
    caption: str
    kind: Kind
    beam: dict[str, float]
    assumed: str = ""
    along: str = ""
    values: tuple[float, ...] = ()
    span: tuple[float, float] = (0.0, 0.0)
    resonance: str = ""
    eta: float = 0.0
    table: int = 0
    omega_L: float = inf

    @property
    def stepped(self) -> bool:
        """Which of the two beams."""
        return "xi_c" in self.beam


def _frequencies(number: int, what: str, along: str, **rest: Any) -> Figure:
    beam = "uniform" if number < 5 else "stepped"
    caption = f"Natural frequencies of a {beam} beam under thrust (effect of {what})."
    span = (0.0, {5: 38.0, 7: 33.0}.get(number, 28.0))
    return Figure(number, caption, "frequencies", along=along, span=span, **rest)


def _pair(number: int, caption: str, kind: Kind, **rest: Any) -> tuple[Figure, Figure]:
    """The uniform beam's figure, and the stepped beam's, nine numbers on."""
    span = rest.pop("span", {})
    uniform = Figure(
        number,
        f"{caption} Uniform beam.",
        kind,
        UNIFORM,
        table=1,
        span=span.get("uniform", (0.0, 0.3)),
        **rest,
    )
    stepped = Figure(
        number + 9,
        f"{caption} Stepped beam.",
        kind,
        STEPPED,
        table=2,
        span=span.get("stepped", (0.0, 0.3)),
        **rest,
    )
    return uniform, stepped


THRUSTS = {"uniform": (0.0, 25.0), "stepped": (0.0, 24.0)}
"""Below inertial buckling of the two-mode beams, at 26.58 and 24.46."""

STEP = {"xi_c": 0.6, "area_ratio": 1.0, "inertia_ratio": 1.0}
BOUNDARIES = "Undamped boundaries separating stable and unstable forcing frequencies,"
DAMPED = "Unstable regions existing with damping,"
T0_AXIS = r"range of $\bar T_0$"
GAMMA_AXIS = r"range of $\gamma$"


def _critical(number: int, resonance: str, symbol: str) -> tuple[Figure, Figure]:
    caption = (
        rf"Top: $T_x$ versus $\gamma$ at $\bar\Omega={symbol}$. "
        rf"Bottom: critical $\bar T_0$ and $\gamma$."
    )
    values = (5.0, 10.0, 15.0, 20.0)
    assumed = rf"values of $\bar T_0$; {GAMMA_AXIS}"
    return _pair(
        number, caption, "critical", values=values, resonance=resonance, eta=ETA, assumed=assumed
    )


_ALL = (
    _frequencies(
        3,
        r"control factor, $K_\theta$",
        "K_theta",
        beam=NORM,
        values=(0.25, 0.5, 1.0, 2.0),
        assumed=r"values of $K_\theta$",
    ),
    _frequencies(
        4,
        r"sensor location, $\xi_G$",
        "xi_G",
        beam=NORM,
        values=(0.0, 0.25, 0.5, 0.75, 1.0),
        assumed=r"values of $\xi_G$",
    ),
    _frequencies(
        5,
        r"area ratio, $A_1/A_2$",
        "area_ratio",
        beam=NORM | STEP,
        values=(0.4, 0.6, 0.8, 1.0),
        assumed=r"values of $A_1/A_2$; $I_1/I_2=1$, $\xi_c=0.6$",
    ),
    _frequencies(
        6,
        r"stiffness ratio, $I_1/I_2$",
        "inertia_ratio",
        beam=NORM | STEP,
        values=(0.4, 0.6, 0.8, 1.0),
        assumed=r"values of $I_1/I_2$; $A_1/A_2=1$, $\xi_c=0.6$",
    ),
    _frequencies(
        7,
        r"discontinuity location, $\xi_c$",
        "xi_c",
        beam=NORM | STEP | {"area_ratio": 0.6, "inertia_ratio": 0.6},
        values=(0.2, 0.4, 0.6, 0.8),
        assumed=r"values of $\xi_c$; $A_1/A_2=I_1/I_2=0.6$, as in Example 2 of Appendix A",
    ),
    *_pair(8, r"$\bar\Omega$ versus $T$, plot of characteristic argument.", "growth", eta=ETA),
    *_pair(
        9,
        rf"{BOUNDARIES} $\gamma=T_1/T_0$ held constant.",
        "regions",
        along="T0",
        span=THRUSTS,
        assumed=T0_AXIS,
    ),
    *_pair(
        10,
        rf"{BOUNDARIES} $\bar T_0$ held constant.",
        "regions",
        along="gamma",
        assumed=GAMMA_AXIS,
    ),
    *_critical(11, "2 omega_(B)", r"2\bar\omega_{(B)}"),
    *_critical(12, "omega_(1) + omega_(B)", r"\bar\omega_{(1)}+\bar\omega_{(B)}"),
    *_critical(13, "omega_(2) + omega_(B)", r"\bar\omega_{(2)}+\bar\omega_{(B)}"),
    *_critical(14, "2 omega_(2)", r"2\bar\omega_{(2)}"),
    *_pair(
        15,
        rf"{DAMPED} $\gamma=T_1/T_0$ held constant.",
        "regions",
        along="T0",
        span=THRUSTS,
        eta=ETA,
        assumed=T0_AXIS,
    ),
    *_pair(
        16,
        rf"{DAMPED} $\bar T_0$ held constant.",
        "regions",
        along="gamma",
        eta=ETA,
        assumed=GAMMA_AXIS,
    ),
    Figure(
        26,
        r"$T_x$ versus $\bar\omega_L$, effect of longitudinal compliance upon the characteristic "
        "argument for forcing frequencies at parametric resonance. Uniform beam.",
        "compliance",
        UNIFORM,
        span=(0.3, 30.0),
        table=3,
        assumed=r"range of $\bar\omega_L$",
    ),
    Figure(
        27,
        "Effect of longitudinal damping upon longitudinal compliance near resonance. Uniform beam.",
        "integral",
        UNIFORM,
        values=(0.0, 0.04),
        span=(0.0, 2.0),
    ),
    Figure(
        28,
        r"$\bar\Omega$ versus $T$, plot of characteristic argument near resonance. Uniform beam.",
        "resonant",
        UNIFORM,
        values=(0.0, 0.04, 0.08),
        span=(1.66, 2.14),
        omega_L=2.0,
        assumed=r"$\bar T_0$, $\gamma$, $K_\theta$ and $\xi_G$ of Table 1",
    ),
    Figure(
        29,
        "Effect of longitudinal damping upon regions of instability. Uniform beam.",
        "coupled",
        UNIFORM,
        along="T0",
        values=(0.0, 0.08),
        span=(0.0, 25.0),
        omega_L=2.0,
        assumed=r"$\gamma$, $K_\theta$ and $\xi_G$ of Table 1; $\bar T_0$ as the abscissa",
    ),
)

FIGURES = {figure.number: figure for figure in sorted(_ALL, key=lambda figure: figure.number)}
"""By number."""
