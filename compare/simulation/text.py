"""A simulated motion in words: does it grow, how fast, in which modes, in which coordinates."""

import math

import numpy as np
from rich.console import Console

from compare.console import bare_table, say
from compare.console import show as show_table
from compare.provenance import in_words
from compare.simulation.followed import Float, Followed

ENDS = 100
"""Periods at either end of a history in which the largest excursion is told."""

MOST_MODES = 10
"""Pairs that are told."""

# Of a mode in one coordinate; who has the rest is not told.
ENOUGH = 0.95


def show(f: Followed, console: Console) -> None:
    """Print it."""
    h, s, T = f.history, f.subject, f.known.T
    say(console, f"{s.title[:1].upper()}{s.title[1:]}", "bold")
    console.print()
    for line, style in _growth(f):
        say(console, line, style)
    console.print()
    _coordinates(f, console)
    console.print()
    _modes(f, console)
    console.print()
    last, size = slice(-h.samples, None), float(np.max(np.abs(h.q[-h.samples :])))
    known = ""
    if size:
        share = np.max(h.error[last]) / size
        known = f", the last period's known to {share:.0e} of their size"
    say(console, f"Begun in {f.began}; {len(h.tau):,} samples{known}.")
    if s.printed:
        say(console, _printed(f))
    console.print()
    say(console, in_words(about(f) | {"T": T}), "dim")


def about(f: Followed) -> dict[str, object]:
    """For the record in files."""
    h = f.history
    return f.subject.about | {
        "began_in": f.began,
        "periods": h.periods,
        "samples": h.samples,
        "stopped": h.stopped or None,
    }


def headline(f: Followed) -> str:
    """Verdict and both growths in a line."""
    found = f"{f.known.verdict}: T = {_T(f.known.T)}"
    if f.measured is None:
        return found
    return f"{found}; measured over {f.history.periods:,} periods {_T(f.measured.T)}"


def _growth(f: Followed) -> list[tuple[str, str]]:
    h, known, unit = f.history, f.known, f.subject.time
    found = headline(f)
    lines = [(found[0].upper() + found[1:] + ".", "red" if known.verdict == "unstable" else "")]
    if f.measured is not None:
        apart = abs(f.measured.T - known.T)
        lines.append(
            (f"They are {apart:.0e} apart; T is known to {known.T_error:.0e}, the average to "
             f"about {f.measured.error_estimate:.0e}.", "")
        )  # fmt: skip
    if f.subject.in_time and known.T > 0.0:
        doubling = 2.0 * math.log(2.0) / known.T
        lines.append((f"It doubles every {doubling:.4g} {unit or 'units of time'}.", ""))
    if h.stopped:
        lines.append((f"{h.stopped[0].upper()}{h.stopped[1:]}.", "yellow"))
    return lines


def _coordinates(f: Followed, console: Console) -> None:
    h = f.history
    ends = max(min(ENDS, h.periods // 2), 1)
    first, last = f.largest(0, ends), f.largest(h.periods - ends, h.periods)
    table = bare_table(gap=2)
    table.add_column("coordinate")
    for name in (f"largest in first {ends}", f"in last {ends}", "share of history"):
        table.add_column(name, justify="right")
    shares = None if f.content is None else f.content.coordinates
    for i, name in enumerate(f.names):
        share = "-" if shares is None else f"{shares[i]:.4f}"
        table.add_row(name, f"{first[i]:.4g}", f"{last[i]:.4g}", share)
    show_table(console, table)


def _modes(f: Followed, console: Console) -> None:
    """Of each pair the one of positive frequency."""
    modes = f.modes
    table = bare_table(gap=1)
    cycles = f.subject.in_time
    unit = f.subject.frequency or "cycles"
    for name in ("T", unit if cycles else "frequency", "multiplier", "|mu|"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("mostly in")
    table.add_column("share", justify="right")
    own = [i for i in range(len(modes.exponents)) if modes.exponents[i].imag >= 0.0]
    for i in own[:MOST_MODES]:
        value, mu = modes.exponents[i], modes.multipliers[i]
        frequency = value.imag / (2.0 * math.pi) if cycles else value.imag
        # a pair's shares are those of both
        twins = np.isclose(modes.exponents, value.conjugate(), rtol=1e-9, atol=1e-12)
        twins[i] = True
        share = "-" if f.content is None else f"{np.sum(f.content.shares[twins]):.3f}"
        table.add_row(
            _T(_shown(2.0 * value.real, 2.0 * float(modes.exponent_errors[i]))),
            f"{frequency:.6g}",
            f"{_plain(mu.real)} +- {_plain(abs(mu.imag))}i" if twins.sum() > 1 else _plain(mu.real),
            f"{abs(mu):.4g}" if abs(mu) < 1e5 else f"{abs(mu):.1e}",
            _mostly(f.names, modes.participation[i]),
            share,
        )
    show_table(console, table)
    if len(own) > MOST_MODES:
        say(console, f"... and {len(own) - MOST_MODES} more that grow less.")


def _mostly(names: tuple[str, ...], shares: Float) -> str:
    """The coordinates with the largest shares, one or two."""
    order = np.argsort(-shares, kind="stable")
    told = order[:1] if shares[order[0]] > ENOUGH else order[:2]
    return ", ".join(f"{100 * shares[i]:.0f}% {names[i]}" for i in told)


def _printed(f: Followed) -> str:
    s, h = f.subject, f.history
    T = float(s.printed)
    said = "unstable" if T > 0.0 else "stable"
    if not f.print_is_wrong:
        return f"Print has T = {s.printed}, {said}."
    ends = max(min(ENDS, h.periods // 2), 1)
    grown = np.max(f.largest(h.periods - ends, h.periods)) / np.max(f.largest(0, ends))
    would = 0.5 * T * h.tau[-1] / math.log(10.0)
    print_has = f"{would:.0f} powers of ten" if T > 0.0 else "no growth"
    return (
        f"Print has T = {s.printed}, {said}, and is wrong: over {h.periods:,} periods the largest "
        f"excursion becomes {grown:.3g} times what it was; as printed, {print_has}."
    )


def _shown(value: float, error: float) -> float:
    """0 where it may be."""
    return 0.0 if abs(value) <= error else value


def _T(value: float) -> str:
    small = abs(value) < 1e-6
    return "0" if value == 0.0 else f"{value:.1e}" if small else f"{value:.6f}"


def _plain(value: float) -> str:
    return f"{value:.4f}" if abs(value) < 1e4 else f"{value:.2e}"
