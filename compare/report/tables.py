"""The report's printed tables: rows as they stand on the page, and the beam each was run for."""

import csv
import tomllib
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any

from compare.report.errata import corrected_cells
from compare.report.program.listing import Case
from hill import SteppedBeam, UniformBeam

DATA = files("compare") / "report" / "data"
TABLES = (1, 2, 3)


@dataclass(frozen=True)
class Row:
    """One printed value of T, with its z where the table has them.

    Attributes
    ----------
    id : str
        "T1-01" in printed order; the two columns of Table 3 are "T3-01a" and "T3-01b".
    table : int
    page : str
        Heading of the page it stands on.
    resonance : str
        The label printed on its line, or empty.
    Omega_printed, T_printed : str
        As printed.
    z_printed : tuple of str
        Real and imaginary parts as printed, in pairs; empty in Table 3.
    Omega : float
        The forcing frequency the program used, recovered (see `compare.report.recover`).
    Omega_from : str
        How it was recovered.
    initial_conditions : bool or None
        Which column of Table 3.
    """

    id: str
    table: int
    page: str
    resonance: str
    Omega_printed: str
    T_printed: str
    z_printed: tuple[str, ...]
    Omega: float = float("nan")
    Omega_from: str = ""
    initial_conditions: bool | None = None

    @property
    def T(self) -> float:
        """Printed T as a number."""
        return number(self.T_printed)

    @property
    def z(self) -> tuple[complex, ...]:
        """Printed z as numbers."""
        parts = [number(text) for text in self.z_printed]
        return tuple(complex(*pair) for pair in zip(parts[::2], parts[1::2], strict=True))

    @property
    def run(self) -> dict[str, Any]:
        """Parameters of the table's run."""
        return dict(heading(self.table)["run"])

    @property
    def omega_L(self) -> float:
        """Infinite in Tables 1 and 2; 2 Omega in Table 3."""
        return 2.0 * self.Omega if self.table == 3 else float("inf")

    @property
    def gamma(self) -> float:
        """T1/T0."""
        return float(self.run["gamma"])

    def beam(self, modes: int) -> UniformBeam | SteppedBeam:
        """The beam of the table's heading, with this many bending modes."""
        common: dict[str, Any] = parameters(self.table)
        if self.run["beam"] == "uniform":
            return UniformBeam(**common, g=self.run["g"], omega_L=self.omega_L, modes=modes)
        return SteppedBeam(**common, omega_L=self.omega_L, modes=modes)

    @property
    def case(self) -> Case:
        """The same, in the listing's terms: what its data cards said."""
        run = self.run
        case = Case(XG=run["xi_G"], SPC=run["K_theta"], TO=run["T0"], GAMMA=run["gamma"])
        if self.table == 2:
            step = (run["xi_c"], run["area_ratio"], run["inertia_ratio"])
            return replace(case, RC=step[0], RA=step[1], RI=step[2], always_compliant=True)
        if self.table == 3:
            return replace(case, OMEGL=self.omega_L, Q=2 if self.initial_conditions else 0)
        return case


def number(text: str) -> float:
    """A printed number; a dash stands for zero."""
    return 0.0 if text in {"", "-"} else float(text)


@cache
def heading(table: int) -> dict[str, Any]:
    """The TOML beside a table: its heading as printed, and the parameters it was run with."""
    return tomllib.loads((DATA / f"table{table}.toml").read_text())


def parameters(table: int) -> dict[str, float]:
    """The parameters that a table's beam has in every row."""
    names = ("T0", "K_theta", "xi_G", "xi_c", "area_ratio", "inertia_ratio")
    run = heading(table)["run"]
    return {name: run[name] for name in names if name in run}


UNIFORM = parameters(1)
"""The beam of Table 1."""

STEPPED = parameters(2)
"""The beam of Table 2."""


GAMMA = float(heading(1)["run"]["gamma"])
"""Of all three tables."""

ETA = 0.01
"""The transverse damping of section 7.3, wherever there is any."""


@cache
def recovered_frequencies() -> dict[str, dict[str, Any]]:
    """Omega as run and where it comes from, by printed row."""
    return tomllib.loads((DATA / "recovered.toml").read_text())


def printed_lines(table: int) -> list[dict[str, str]]:
    """The lines of a table's CSV."""
    return list(csv.DictReader((DATA / f"table{table}.csv").read_text().splitlines()))


@cache
def rows(table: int, *, recovered: bool = True) -> tuple[Row, ...]:
    """All rows of one table, in printed order; with the Omega they were run at, or without."""
    found = []
    for line in printed_lines(table):
        known = recovered_frequencies()[line["id"]] if recovered else {}
        common = {
            "table": table,
            "page": line["page_label"],
            "resonance": line["resonance"],
            "Omega_printed": line["Omega"],
            "Omega": known.get("Omega", float("nan")),
            "Omega_from": known.get("from", ""),
        }
        if table == 3:
            for suffix, column, initial in (("a", "T_without", False), ("b", "T_with", True)):
                found.append(
                    Row(
                        id=line["id"] + suffix,
                        T_printed=line[column],
                        z_printed=(),
                        initial_conditions=initial,
                        **common,
                    )
                )
        else:
            parts = tuple(line[f"z{k}_{part}"] for k in (1, 2, 3) for part in ("re", "im"))
            found.append(Row(id=line["id"], T_printed=line["T"], z_printed=parts, **common))
    return tuple(found)


def all_rows(tables: tuple[int, ...] = TABLES) -> tuple[Row, ...]:
    """Rows of several tables."""
    return tuple(row for table in tables for row in rows(table))


def is_named(row: Row, name: str) -> bool:
    """Whether a name means the row; "T3-02" means both columns of that line."""
    return name.upper() in (row.id.upper(), row.id.upper().rstrip("AB"))


def corrected(row: Row) -> Row:
    """The row with the cells that the errata correct."""
    cells = corrected_cells(row.id)
    z = list(row.z_printed)
    for field, text in cells.items():
        if field.startswith("z"):
            z[2 * int(field[1]) - 2 + field.endswith("im")] = text
    return replace(
        row,
        z_printed=tuple(z),
        Omega_printed=cells.get("Omega", row.Omega_printed),
        T_printed=cells.get("T", row.T_printed),
    )
