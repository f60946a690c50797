"""How the page writes numbers and tables, and its section on the limit."""

from collections.abc import Sequence
from typing import Any

from benchmarks.measure import spread

GENERAL = """\
## General equations

One equation alone, us, and the error of the multipliers' polynomial over its largest coefficient,
against ball arithmetic. With z: the same system in its special form, whose polynomial is P(z), and
in general form. With damping that pulsates there is the general form only. Peers integrate to the
monodromy matrix, at the loosest tolerance with which they are about as accurate as `floquet` here,
or else at their tightest; `hill` and `floquet` also give error bounds, exponents, T and a verdict.
heyoka compiles every equation anew, which its time leaves out."""

LIMIT = """\
## Where the limit is

Measured here, one thread: {gflops:.0f} Gflop/s in a matrix product, {memory:.1f} GB/s copying
memory, {cache:.0f} GB/s copying within the first cache (bytes read and written).

{table}

A chart's point needs {series:.0f} operations of the series' matrix products and {roots:.0f} of the
cubic's closed form, {slow:.0f} of them slow ones (roots, cosines, logarithms, each counted as one
here); it leaves {bytes:.0f} bytes behind. In arrays the closed form moves {moved:.0f} bytes a point
through the cache, {through:.0f} ns of copying alone. Of the {whole:.0f} ns that the chart takes a
point at {points} points, nodes and checks are {nodes:.0f}, the series {products:.0f}, the roots
{closed:.0f}; the rest puts the results together.

A direct point takes {steps:.1f} Taylor steps of order {order} on average, {flops:.0f} operations in
all, on numbers that stay in registers and caches: arithmetic is the limit, not memory."""


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table: names to the left, numbers to the right."""
    rule = ["---", *["---:"] * (len(header) - 1)]
    return "\n".join("| " + " | ".join(line) + " |" for line in (header, rule, *rows))


def micro(seconds: float) -> str:
    """Microseconds, three digits."""
    return digits(1e6 * seconds)


def digits(value: float) -> str:
    """Three digits, thousands set apart, no exponent."""
    if value >= 100.0:
        rounded = float(f"{value:.3g}")
        return f"{rounded:,.0f}"
    return f"{value:#.3g}".rstrip(".")


def factor(value: float) -> str:
    """A ratio, two digits."""
    if value >= 10.0:
        return f"{float(f'{value:.2g}'):,.0f}"
    return f"{value:.2g}"


def error(value: float | None) -> str:
    """One digit and a power; a dash where it was not measured."""
    return "-" if value is None else f"{value:.0e}"


def size(count: int) -> str:
    """A number of points: a power of ten as one."""
    text = str(count)
    if count >= 10**4 and text.strip("0") == "1":
        return f"1e{len(text) - 1}"
    return f"{count:,}"


def limit(found: dict[str, Any], direct_seconds: float | None) -> str:
    """Operations and bytes a point, the time they would take, and the time they do.

    Parameters
    ----------
    found : dict
        The results' section.
    direct_seconds : float or None
        What the quickest direct batch takes a point.
    """
    m, chart, batch = found["machine"], found["chart"], found["batch"]
    operations = chart["series_flops"] + chart["roots_operations"]
    rows = [
        _bound("chart", operations, chart["bytes"], chart["seconds"], m),
        _bound("direct batch", batch["flops"], batch["bytes"], direct_seconds, m),
    ]
    header = ["", "operations", "bytes", "ns for the operations", "ns for the bytes", "ns taken"]
    header += ["share of the limit"]
    return LIMIT.format(
        gflops=m["flops"] / 1e9,
        memory=m["memory"] / 1e9,
        cache=m["cache"] / 1e9,
        table=table(header, rows),
        series=chart["series_flops"],
        roots=chart["roots_operations"],
        slow=chart["roots_slow"],
        bytes=chart["bytes"],
        moved=chart["roots_bytes"],
        through=1e9 * chart["roots_bytes"] / m["cache"],
        whole=1e9 * chart["seconds"],
        points=size(chart["points"]),
        nodes=1e9 * chart["nodes_seconds"] / chart["points"],
        products=1e9 * chart["series_seconds"],
        closed=1e9 * chart["roots_seconds"],
        steps=batch["steps"],
        order=batch["order"],
        flops=batch["flops"],
    )


def general(found: dict[str, Any]) -> str:
    """Each system and contender a line, the numbers of coordinates its columns."""
    counts = sorted({line["n"] for line in found["lines"]})
    header = ["", "system", *(cell for n in counts for cell in (f"n = {n}", "error"))]
    rows: dict[tuple[str, str], list[str]] = {}
    for line in found["lines"]:
        row = rows.setdefault((line["name"], line["system"]), [line["name"], line["system"]])
        row += [micro(spread(line["seconds"]).median), error(line["error"])]
    how = [
        f"{line['name']}, n = {line['n']}: {line['settings']}"
        + (f", compiled in {line['build_seconds']:.2g} s" if line["build_seconds"] > 0.1 else "")
        for line in found["lines"]
        if not line["ours"]
    ]
    return "\n\n".join([GENERAL, table(header, list(rows.values())), "; ".join(how) + "."])


def _bound(
    name: str, operations: float, moved: float, taken: float | None, m: dict[str, float]
) -> list[str]:
    work, traffic = operations / m["flops"], moved / m["memory"]
    least = max(work, traffic)
    cells = [name, digits(operations), digits(moved), digits(1e9 * work), digits(1e9 * traffic)]
    if taken is None:
        return [*cells, "", ""]
    return [*cells, digits(1e9 * taken), f"{100.0 * least / taken:.2g}%"]
