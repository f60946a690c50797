"""The claims as data, and many of them judged."""

import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.resources import files
from typing import Any

from compare.report.claims.finding import CHECKS, VERDICTS, Finding, Verdict

THEMES = (
    "frequencies",
    "steps",
    "tongues",
    "places",
    "damping",
    "compliance",
    "resonance",
    "initial",
    "examples",
    "truncation",
)


@dataclass(frozen=True)
class Claim:
    """One conclusion of the report.

    Attributes
    ----------
    id, section, title
        Its name here, where it stands, and a few words for a table.
    claim : str
        What the report concludes there, in other words than its own.
    computed, rule : str
        What is computed for it, and how the verdict follows from that.
    expected : str
        The verdict on record.
    """

    id: str
    section: str
    title: str
    claim: str
    computed: str
    rule: str
    expected: Verdict


@dataclass(frozen=True)
class JudgedClaim:
    """A claim with what was found."""

    claim: Claim
    finding: Finding

    @property
    def as_expected(self) -> bool:
        """Whether the verdict is the one on record."""
        return self.finding.verdict == self.claim.expected


@cache
def claims() -> tuple[Claim, ...]:
    """All claims, in the order of the file."""
    text = (files("compare") / "report/data/claims.toml").read_text()
    return tuple(Claim(**entry) for entry in tomllib.loads(text)["claim"])


def check_of(name: str) -> Callable[[], Finding]:
    """The function that computes a claim."""
    for theme in THEMES:
        import_module(f"compare.report.claims.{theme}")
    return CHECKS[name]


def select(names: Iterable[str] | None = None) -> tuple[Claim, ...]:
    """Claims by id, in the order of the file; all of them without names.

    Raises
    ------
    ValueError
        No claim has such an id.
    """
    if not names:
        return claims()
    wanted, known = list(names), {claim.id for claim in claims()}
    for name in wanted:
        if name not in known:
            raise ValueError(f"claim = {name!r}: no such claim; `verify claims` lists them")
    return tuple(claim for claim in claims() if claim.id in wanted)


def judge(
    names: Iterable[str] | None = None, *, progress: Callable[[JudgedClaim], Any] | None = None
) -> tuple[JudgedClaim, ...]:
    """Compute claims and judge them by their rules.

    Parameters
    ----------
    names : iterable of str, optional
        Only these ids.
    progress : callable, optional
        Called with each as it is done.

    Returns
    -------
    tuple of JudgedClaim

    Raises
    ------
    RoutesDisagree
        The two routes differ by more than their error bounds allow.
    ValueError
        No claim has such an id.
    """
    found = []
    for claim in select(names):
        found.append(JudgedClaim(claim, check_of(claim.id)()))
        if progress is not None:
            progress(found[-1])
    return tuple(found)


def count(judged: Iterable[JudgedClaim]) -> dict[str, int]:
    """How many of each verdict."""
    verdicts = [one.finding.verdict for one in judged]
    return {verdict: verdicts.count(verdict) for verdict in VERDICTS}
