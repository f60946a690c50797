"""What was found over many rows of the report, in numbers and in words."""

from collections.abc import Sequence
from dataclasses import dataclass

from compare.report.row import Outcome

NONE_WRONG = "no printed verdict is wrong"


@dataclass(frozen=True)
class Summary:
    """What was found, in numbers."""

    rows: int
    routes_agree: int
    agrees: int
    truncation: int
    listing_slip: int
    misprint: int
    unexplained: int
    flips: int
    undecided: int
    largest_difference: float
    """Largest |P_hill - P_floquet| over the largest coefficient."""
    largest_share: float
    """Largest |P_hill - P_floquet| over the sum of the two error bounds."""

    @property
    def lines(self) -> tuple[str, str]:
        """Two lines that say what was found."""
        counts = (
            (self.agrees, "agrees with print", "agree with print"),
            (self.truncation, "is a truncation artefact", "are truncation artefacts"),
            (self.listing_slip, "follows a slip of the program", "follow slips of the program"),
            (self.misprint, "is a misprint", "are misprints"),
            (self.unexplained, "has no explanation", "have no explanation"),
        )
        found = [f"{n} {one if n == 1 else many}" for n, one, many in counts if n]
        verdicts = "verdict on stability is" if self.flips == 1 else "verdicts on stability are"
        wrong = f"{self.flips} printed {verdicts} wrong" if self.flips else NONE_WRONG
        if self.undecided:
            wrong += f", {self.undecided} {'is' if self.undecided == 1 else 'are'} undecided"
        return (
            f"{self.rows} printed value{'s' * (self.rows != 1)}: {', '.join(found)}; {wrong}.",
            f"The two routes agree on {self.routes_agree} of {self.rows} within their own error "
            f"bounds; P(z) differs by {self.largest_difference:.1e} of its largest coefficient "
            f"at most, {self.largest_share:.0%} of the bounds.",
        )


def count(outcomes: Sequence[Outcome]) -> Summary:
    """Counts of every kind of outcome."""

    def caused(cause: str) -> int:
        return sum(o.cause == cause for o in outcomes)

    return Summary(
        rows=len(outcomes),
        routes_agree=sum(o.routes_agree for o in outcomes),
        agrees=caused("agrees"),
        truncation=caused("truncation"),
        listing_slip=caused("listing-slip"),
        misprint=caused("misprint"),
        unexplained=caused("unexplained"),
        flips=sum(o.flips for o in outcomes),
        undecided=sum(o.verdict == "undecided" for o in outcomes),
        largest_difference=max(
            (o.difference / float(abs(o.hill.polynomial).max()) for o in outcomes), default=0.0
        ),
        largest_share=max(
            (o.difference / (o.hill.error + o.floquet.error) for o in outcomes), default=0.0
        ),
    )
