"""A page as its elements, by the standard library's parser: what it links to, says and names."""

import json
from dataclasses import dataclass, field
from functools import cached_property
from html.parser import HTMLParser
from typing import Any

EMPTY = {"meta", "link", "img", "br", "input"}


@dataclass(eq=False)
class Element:
    name: str
    attributes: dict[str, str]
    parent: "Element | None" = None
    children: list["Element"] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    def all(self, name: str) -> list["Element"]:
        found = [self] if self.name == name else []
        return found + [e for child in self.children for e in child.all(name)]

    @property
    def text(self) -> str:
        return "".join(self.pieces)

    def within(self, name: str) -> "Element | None":
        """The nearest element around it that is called so."""
        above = self.parent
        while above is not None and above.name != name:
            above = above.parent
        return above


class Parsed(HTMLParser):
    """A page; elements that are not closed, or closed by another's end, are an error."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.root = self._open = Element("", {})
        self.feed(text)
        self.close()
        assert self._open is self.root, f"{self._open.name} is not closed"

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        names = [name for name, _ in attrs]
        assert len(names) == len(set(names)), f"{tag} has an attribute twice"
        made = Element(tag, {name: value or "" for name, value in attrs}, self._open)
        self._open.children.append(made)
        if tag not in EMPTY:
            self._open = made

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in EMPTY:
            self.handle_endtag(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.name == tag, f"</{tag}> ends a <{self._open.name}>"
        assert self._open.parent is not None
        self._open = self._open.parent

    def handle_data(self, data: str) -> None:
        here: Element | None = self._open
        while here is not None:
            here.pieces.append(data)
            here = here.parent

    def all(self, name: str) -> list[Element]:
        return self.root.all(name)

    @cached_property
    def ids(self) -> list[str]:
        return [e.attributes["id"] for e in _every(self.root) if "id" in e.attributes]

    @property
    def title(self) -> str:
        (found,) = [e for e in self.all("title") if e.within("head")]
        return found.text

    @property
    def references(self) -> list[str]:
        """Everything that the page has elsewhere or points to."""
        found = [e.attributes.get(name) for e in _every(self.root) for name in ("href", "src")]
        return [reference for reference in found if reference is not None]

    def data(self, within: Element | None = None) -> dict[str, tuple[Any, str]]:
        """What stands for something of the JSON: its value, and what is shown."""
        return {
            e.attributes["data-is"]: (json.loads(e.attributes["value"]), e.text)
            for e in (within or self.root).all("data")
            if "data-is" in e.attributes
        }


def _every(element: Element) -> list[Element]:
    return [element, *(e for child in element.children for e in _every(child))]
