"""What every input file needs: reading TOML, tables, and which word was meant."""

import difflib
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any


def one_of(word: str, known: Sequence[str], alike: float = 0.6) -> str:
    """What would be right in place of a word, the nearest first, if as much is alike."""
    by_letters = {name.casefold(): name for name in known}
    near = [by_letters[x] for x in difflib.get_close_matches(word.casefold(), by_letters, 1, alike)]
    text = f"must be one of {', '.join(known)}" if known else "must not be there"
    return f"did you mean {near[0]}? It {text}" if near else text


def only(table: Mapping[str, Any], known: Sequence[str], where: str) -> None:
    """Refuse a key that is not known; `where` stands before its name."""
    for name in table:
        if name not in known:
            # one letter of two is the nearest that there may be: EJ for EI
            right = one_of(name, known, 0.5 if len(name) == 2 else 0.6)
            raise ValueError(f"{where}{name}: {right}")


def content(path: Path) -> dict[str, Any]:
    """What a TOML file holds, or one line that says why it cannot be had."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"{path}: {unreadable(error)}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: is not TOML ({error})") from None
    except RecursionError:
        raise ValueError(f"{path}: is nested too deeply") from None


def unreadable(error: OSError) -> str:
    """Why a file cannot be read, in a few words."""
    return f"cannot be read ({(error.strerror or str(error)).lower()})"


def table(content: Mapping[str, Any], name: str, path: Path | None = None) -> dict[str, Any]:
    """A table of a file's content, empty where it is not there."""
    found = content.get(name, {})
    if not isinstance(found, dict):
        raise ValueError(f"{f'{path}: ' if path else ''}{name}: must be a table, [{name}]")
    return dict(found)


def tables(content: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    """An array of tables, empty where it is not there."""
    found = content.get(name, [])
    if not isinstance(found, list) or not all(isinstance(x, dict) for x in found):
        raise ValueError(f"{name}: must be an array of tables, [[{name}]]")
    return [dict(x) for x in found]
