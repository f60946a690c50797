"""``docs/claims.md``, and claims as Markdown and JSON: findings in, a string out.

``python -m compare.report.claims.page`` writes the page.
"""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from compare.output import check_writable, write_whole
from compare.provenance import in_words, provenance
from compare.report.claims.run import JudgedClaim, count, judge

ABOUT = {"of": "the report's conclusions, each with its own beam and forcing as it says"}
"""What a file of claims is of."""

FORMATS = ("text", "md", "json")
HEADING = """\
# The report's conclusions, one by one

What chapters 6 to 8, Appendix A and section B-4 conclude, each held against numbers by both routes:
Hill's determinant with its tail summed, and the monodromy matrix. A number stands here only if the
two agree within their own error bounds; where one column is empty there is only one way to it.
Unless a line says otherwise the beam is that of Table 1 (uniform) or Table 2 (stepped), gamma = .1,
no damping, omega_L infinite. T is the report's characteristic argument, twice the growth exponent.
Claims are restated here; the section numbers say where the report makes them (the scan has no page
numbers).

The verdict follows from the numbers by the rule that is given with each claim: **confirmed**,
**qualified** (true with a restriction that the report does not make), or **refuted**. "Visible" is
a twentieth, one square of the report's graph paper on a region an inch in radius.

This page is generated: `python -m compare.report.claims.page`.
"""


PAGE = Path("docs/claims.md")


def whole_page(judged: Iterable[JudgedClaim] | None = None) -> str:
    """The whole page."""
    found = tuple(judge() if judged is None else judged)
    return f"{HEADING}\n{markdown(found)}"


def markdown(judged: Iterable[JudgedClaim]) -> str:
    """A table of verdicts, and every claim with its numbers."""
    found = tuple(judged)
    lines = [" ".join(summary(found)), "", "| claim | section | verdict |", "| --- | --- | --- |"]
    lines += [
        f"| [{j.claim.title}](#{j.claim.id.lower()}) | {j.claim.section} | {j.finding.verdict} |"
        for j in found
    ]
    for one in found:
        lines += ["", *_entry(one)]
    return "\n".join([*lines, "", in_words(ABOUT)]) + "\n"


def _entry(one: JudgedClaim) -> list[str]:
    claim, finding = one.claim, one.finding
    lines = [f"## {claim.id}", "", f"**{finding.verdict.capitalize()}** ({claim.section}). "]
    lines[-1] += finding.because
    lines += ["", f"Claim: {claim.claim}", ""]
    lines += [f"Computed: {claim.computed}", "", f"Rule: {claim.rule}"]
    lines += ["", "| number | Hill | Floquet |", "| --- | ---: | ---: |"]
    for number in finding.numbers:
        label = number.label.replace("|", "\\|")
        lines.append(f"| {label} | {number.texts[0]} | {number.texts[1]} |")
    return lines


def summary(judged: Iterable[JudgedClaim]) -> tuple[str, str]:
    """Two lines that say what was found."""
    found = tuple(judged)
    counts = count(found)
    changed = [one.claim.id for one in found if not one.as_expected]
    record = f"differ from the record: {', '.join(changed)}" if changed else "are those on record"
    verdicts = ", ".join(f"{n} {verdict}" for verdict, n in counts.items())
    return (
        f"{len(found)} claim{'s' * (len(found) != 1)}: {verdicts}.",
        f"The two routes agree on every number; the verdicts {record}.",
    )


def as_json(shown: Iterable[JudgedClaim], judged: Iterable[JudgedClaim]) -> str:
    """Everything, every digit."""
    everything = tuple(judged)
    content = provenance(ABOUT) | {
        "summary": {"claims": len(everything), **count(everything)}
        | {"ok": all(one.as_expected for one in everything)},
        "claims": [as_dict(one) for one in shown],
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def as_dict(one: JudgedClaim) -> dict[str, Any]:
    """One claim with the names of the JSON."""
    numbers = [
        {"label": n.label, "hill": n.hill, "floquet": n.floquet, "digits": n.digits}
        for n in one.finding.numbers
    ]
    found = {"verdict": one.finding.verdict, "because": one.finding.because, "numbers": numbers}
    return vars(one.claim) | found


def main() -> None:
    """Write docs/claims.md, from the root of a clone."""
    check_writable(PAGE)
    write_whole(PAGE, whole_page())


if __name__ == "__main__":
    main()
