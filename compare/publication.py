"""What a paper with printed tables says of itself, for `verify` to hold it against both routes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Literal, Protocol, TypeVar

from compare.erratum import Erratum

Method = Literal["taylor", "cvodes"]


class PrintedRow(Protocol):
    """A printed value, or a line of them, with what was printed beside it."""

    @property
    def id(self) -> str:
        """Its name; unique, and the same for ever."""
        ...

    @property
    def table(self) -> int:
        """The number of its table."""
        ...


class RowOutcome(Protocol):
    """A row and what was found about it."""

    @property
    def row(self) -> PrintedRow:
        """The row."""
        ...

    @property
    def routes_agree(self) -> bool:
        """Whether the two routes agree on it within their own bounds."""
        ...

    @property
    def expected(self) -> bool:
        """False where print differs and no errata explain it or list it as open."""
        ...

    @property
    def differs(self) -> bool:
        """Whether print differs."""
        ...

    @property
    def flips(self) -> bool:
        """Whether what print says of stability is shown to be wrong."""
        ...


class Counts(Protocol):
    """What was found in numbers: a dataclass, whose fields are the summary of the JSON."""

    @property
    def lines(self) -> tuple[str, ...]:
        """The same in words."""
        ...


@dataclass(frozen=True)
class Column:
    """A column of the table of outcomes.

    Attributes
    ----------
    name : str
    words : bool
        Words stand on the left, numbers on the right.
    width : int
        Of a terminal that is narrower the column is left out.
    """

    name: str
    words: bool = False
    width: int = 0


@dataclass(frozen=True)
class Cell:
    """What stands in a column.

    Attributes
    ----------
    text : str
    style : str
        Of the terminal, as rich calls it.
    loud : bool
        Bold in Markdown.
    short : str
        Instead of the text where columns are left out.
    """

    text: str
    style: str = ""
    loud: bool = False
    short: str = ""


R = TypeVar("R", bound=PrintedRow)
S = TypeVar("S")
Out = TypeVar("Out", bound=RowOutcome)


@dataclass(frozen=True)
class Rendering(Generic[Out]):
    """How outcomes look.

    Attributes
    ----------
    columns : tuple of Column
        Of the table, as text and as Markdown.
    cells : callable
        An outcome to its cells, one a column.
    record : callable
        An outcome to what JSON holds of it.
    csv_header : tuple of str
    csv_line : callable
        An outcome to the values under the header.
    count : callable
        Outcomes to a summary.
    """

    columns: tuple[Column, ...]
    cells: Callable[[Out], tuple[Cell, ...]]
    record: Callable[[Out], dict[str, Any]]
    csv_header: tuple[str, ...]
    csv_line: Callable[[Out], Sequence[Any]]
    count: Callable[[Sequence[Out]], Counts]


@dataclass(frozen=True)
class MoreTerms(Generic[R]):
    """For a paper whose printed values sum a series: what more of its terms would give.

    Attributes
    ----------
    applies : callable
        Whether a row sums any.
    compute : callable
        Such a row to what is found, which says whether the ``routes_agree``.
    record : callable
        That to what JSON holds of it; the names are CSV's too, behind ``more_terms_``.
    line : callable
        The row and what is found, in words.
    """

    applies: Callable[[R], bool]
    compute: Callable[[R], Any]
    record: Callable[[Any], dict[str, Any]]
    line: Callable[[R, Any], str]


@dataclass(frozen=True)
class Publication(Generic[R, S, Out]):
    """A paper with printed tables.

    To add one, put a module or a folder ``NAME`` into ``compare/publications``, its data beside it
    and ``PUBLICATION = Publication(...)`` in it: `verify --publication NAME` finds it there, and
    nothing else has to change. ``compare/publications/mathieu/`` is a small one to start from. What
    it takes is a dataclass for a printed row, another for an outcome (`PrintedRow`, `RowOutcome`
    say what they must have), and the functions below; those are a module's own functions, so that
    other processes can be handed them.

    Attributes
    ----------
    name : str
        As `--publication` has it.
    title : str
        Who wrote what, in one line.
    tables : tuple of int
        Their numbers.
    rows : callable
        A table's number to its rows, in printed order.
    errata : callable
        Nothing to all errata.
    solve : callable
        A row, with the keywords `method` and `modes`, to what both routes find.
    explain : callable
        A row, what both routes find, what its own program gives, its errata: to an outcome, which
        says why print differs.
    rendering : Rendering
    as_run : callable, optional
        A row to what the paper's own program gives, truncation and slips included; without it
        `explain` gets None.
    modes : int, optional
        How many modes the tables were made with; None where there is nothing to choose.
    more_terms : MoreTerms, optional
        Where printed values sum a series, its limit.
    is_named : callable, optional
        Whether a row is meant by a name; by default its id is, in any case.
    """

    name: str
    title: str
    tables: tuple[int, ...]
    rows: Callable[[int], tuple[R, ...]]
    errata: Callable[[], tuple[Erratum, ...]]
    solve: Callable[..., S]
    explain: Callable[[R, S, Any, tuple[Erratum, ...]], Out]
    rendering: Rendering[Out]
    as_run: Callable[[R], Any] | None = None
    modes: int | None = None
    more_terms: MoreTerms[R] | None = None
    is_named: Callable[[R, str], bool] | None = None

    def check(self, row: R, *, method: Method = "taylor", modes: int | None = None) -> Out:
        """Solve a row by both routes and explain what is printed.

        Parameters
        ----------
        row : row of this publication
        method : {"taylor", "cvodes"}, optional
            How the time domain integrates.
        modes : int, optional
            Modes of both routes; by default the tables'.
        """
        found = self.solve(row, method=method, modes=self.modes if modes is None else modes)
        as_run = self.as_run(row) if self.as_run else None
        return self.explain(row, found, as_run, self.errata_of(row))

    def errata_of(self, row: R) -> tuple[Erratum, ...]:
        """The errata that name a row."""
        return tuple(e for e in self.errata() if e.row == row.id)

    def all_rows(self, tables: Sequence[int] | None = None) -> tuple[R, ...]:
        """Rows of several tables, of all by default.

        Raises
        ------
        ValueError
            There is no such table.
        """
        chosen = self.tables if tables is None else tuple(tables)
        for table in chosen:
            if isinstance(table, bool) or not isinstance(table, int) or table not in self.tables:
                known = ", ".join(map(str, self.tables))
                raise ValueError(f"table = {table!r}: must be one of {known}")
        return tuple(row for table in chosen for row in self.rows(table))

    def select(
        self, tables: Sequence[int] | None = None, names: Sequence[str] | None = None
    ) -> tuple[R, ...]:
        """Rows by table and name.

        Raises
        ------
        ValueError
            No row has such a name.
        """
        found = self.all_rows(tables)
        if names is None:
            return found
        for name in names:
            if not any(self._means(row, name) for row in found):
                among = " and ".join(
                    f"Table {table}" for table in (self.tables if tables is None else tables)
                )
                raise ValueError(
                    f"row = {name!r}: no such row in {among} ({found[0].id} to {found[-1].id})"
                )
        return tuple(row for row in found if any(self._means(row, name) for name in names))

    def _means(self, row: R, name: str) -> bool:
        return self.is_named(row, name) if self.is_named else name.upper() == row.id.upper()
