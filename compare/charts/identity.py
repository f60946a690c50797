"""What tells one system from another: its type, its code and every number in it.

A file of finished nodes is of one system, and a worker must have the code that the job was made
with. `hill` and `floquet` have a fingerprint of their own (`source_fingerprint`); this is for what
is neither: a class of the user's, with the functions and constants that its methods name.
"""

import builtins
import hashlib
import re
import sys
import sysconfig
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache, cached_property, partial
from importlib.resources import files
from pathlib import Path
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from floquet.witness import maker

OURS = ("hill", "floquet", "compare")

# Of a class's dictionary: what the interpreter puts there, which no method is changed by.
PASSED_OVER = frozenset(
    re.findall(
        r"\w+",
        """__module__ __dict__ __weakref__ __doc__ __annotations__ __slots__ __dataclass_fields__
        __dataclass_params__ __match_args__ __replace__ __abstractmethods__ _abc_impl __parameters__
        __orig_bases__ _is_protocol __firstlineno__ __static_attributes__ __annotate_func__
        __annotations_cache__ __slotnames__ __repr__ __protocol_attrs__
        __non_callable_proto_members__""",
    )
)


@cache
def source_fingerprint() -> str:
    """A name for what computes: it changes whenever `hill` or `floquet` do."""
    digest = hashlib.sha256()
    for package in ("hill", "floquet"):
        root = Path(str(files(package)))
        for path in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".c")):
            name = path.relative_to(root).as_posix()
            digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def type_name(system: Any) -> str:
    """Module and name of a system's type; a script is `__main__` in its workers too."""
    kind = type(system)
    module = kind.__module__.replace("__mp_main__", "__main__")
    return f"{module}.{kind.__qualname__}"


def code_fingerprint(system: Any) -> str:
    """A name for the code of a system's type, the same wherever that code is."""
    digest = hashlib.sha256()
    walk = _Walk()
    for part in walk.of_class(type(system)):
        digest.update(part)
    # and of the witness's own matrices, where there are some
    make = maker(system)
    for part in walk.of_value(make) if make else ():
        digest.update(part)
    return digest.hexdigest()[:16]


def own_modules(system: Any) -> tuple[str, ...]:
    """The modules of the user's own that the code of a system's type is in, but for a script's."""
    walk = _Walk()
    for _ in walk.of_class(type(system)):
        pass
    return tuple(sorted(walk.modules - {"__main__", "__mp_main__", "builtins"}))


def value_fingerprint(system: Any) -> str:
    """A name for everything that a system holds.

    Raises
    ------
    ValueError
        It holds something of which two cannot be told apart.
    """
    digest = hashlib.sha256()
    for part in _Walk().of_value(system):
        digest.update(part)
    return digest.hexdigest()[:16]


def known_values(system: Any) -> str | None:
    """The same, or None where two of the system cannot be told apart."""
    try:
        return value_fingerprint(system)
    except ValueError:
        return None


class _Walk:
    """Bytes that differ where values or code differ; each object is gone through once."""

    def __init__(self) -> None:
        self.seen: dict[int, Any] = {}
        self.functions: dict[int, Any] = {}
        self.modules: set[str] = set()

    def of_value(self, value: Any) -> Iterator[bytes]:
        """Of a number, an array, a container or an object, by all that it holds."""
        if value is None or isinstance(value, bool | int | float | complex | str | bytes):
            yield f"{type(value).__name__} {value!r}\0".encode()
        elif isinstance(value, np.generic | np.ndarray) and value.dtype != object:
            yield f"array {value.dtype.str} {value.shape}\0".encode() + value.tobytes()
        elif id(value) in self.seen:
            yield b"again\0"
        else:
            # held, so that nothing else takes its place and its number
            self.seen[id(value)] = value
            yield from self._of_object(value)

    def _of_object(self, value: Any) -> Iterator[bytes]:
        if isinstance(value, type):
            yield from self.of_class(value)
        elif isinstance(value, ModuleType):
            yield from _of_module(value)
        elif isinstance(value, FunctionType):
            yield from self.of_function(value)
        elif isinstance(value, MethodType):
            yield from self.of_function(value.__func__)
            yield from self.of_value(value.__self__)
        elif isinstance(value, partial):
            for part in (value.func, value.args, value.keywords):
                yield from self.of_value(part)
        elif isinstance(value, Mapping):
            yield f"mapping {len(value)}\0".encode()
            for key in sorted(value, key=repr):
                yield from self.of_value(key)
                yield from self.of_value(value[key])
        elif isinstance(value, list | tuple):
            yield f"{type(value).__name__} {len(value)}\0".encode()
            for part in value:
                yield from self.of_value(part)
        elif isinstance(value, set | frozenset):
            yield f"set {sorted(map(repr, value))}\0".encode()
        else:
            yield from self._of_instance(value)

    def _of_instance(self, value: Any) -> Iterator[bytes]:
        yield f"of {type_name(value)}\0".encode()
        if is_dataclass(value):
            state: Any = {f.name: getattr(value, f.name) for f in fields(value)}
        elif hasattr(value, "__dict__"):
            state = vars(value)
        else:
            try:
                state = value.__reduce_ex__(4)
            except TypeError:
                state = None
            if not isinstance(state, tuple):
                raise ValueError(
                    f"resume: two {type_name(value)} cannot be told apart, so a file of nodes "
                    "would not be this system's own; leave resume out"
                )
        yield from self.of_value(state)

    def of_class(self, kind: type) -> Iterator[bytes]:
        """Of the code of a class and of those that it inherits from, as far as they are own."""
        for base in kind.__mro__:
            yield f"class {base.__qualname__}\0".encode()
            if not _is_own(base.__module__, base):
                continue
            self.modules.add(base.__module__)
            for name, value in sorted(vars(base).items()):
                if name not in PASSED_OVER:
                    yield f"{name}\0".encode()
                    yield from self._of_member(value)

    def _of_member(self, value: Any) -> Iterator[bytes]:
        if isinstance(value, property):
            inner = (value.fget,)
        elif isinstance(value, classmethod | staticmethod):
            inner = (value.__func__,)
        elif isinstance(value, cached_property):
            inner = (value.func,)
        else:
            inner = (value,)
        for one in inner:
            if not isinstance(one, FunctionType):
                yield from self._named(one)
            # made by @dataclass, from the fields
            elif "__create_fn__" not in one.__code__.co_qualname:
                yield from self.of_function(one)

    def of_function(self, function: Any) -> Iterator[bytes]:
        """Of its code, its defaults, and what they name."""
        if id(function) in self.functions:
            return
        self.functions[id(function)] = function
        if not _is_own(function.__module__, function):
            yield f"function {function.__module__}.{function.__qualname__}\0".encode()
            return
        self.modules.add(function.__module__ or "__main__")
        yield from self._of_code(function.__code__)
        for value in (function.__defaults__, function.__kwdefaults__):
            yield from self.of_value(value)
        for cell in function.__closure__ or ():
            yield from self._named(cell.cell_contents)
        for name in sorted(_names(function.__code__)):
            if name in function.__globals__:
                yield f"{name} = \0".encode()
                yield from self._named(function.__globals__[name])

    def _of_code(self, code: CodeType) -> Iterator[bytes]:
        yield code.co_code
        yield repr((code.co_names, code.co_varnames, code.co_freevars)).encode()
        for constant in code.co_consts:
            if isinstance(constant, CodeType):
                yield from self._of_code(constant)
            else:
                yield repr(constant).encode()

    def _named(self, value: Any) -> Iterator[bytes]:
        """What a method names: gone into where it can be."""
        try:
            yield from list(self.of_value(value))
        except ValueError:
            yield f"of {type_name(value)}\0".encode()


def _names(code: CodeType) -> set[str]:
    inner = (c for c in code.co_consts if isinstance(c, CodeType))
    return set(code.co_names).union(*map(_names, inner))


def _of_module(module: ModuleType) -> Iterator[bytes]:
    yield f"module {module.__name__}\0".encode()
    path = getattr(module, "__file__", None)
    if path and _is_own(module.__name__, module) and Path(path).is_file():
        yield Path(path).read_bytes()


def _is_own(module: str | None, value: Any) -> bool:
    """Whether a name is the user's: not ours, not Python's, not of an installed distribution."""
    top = (module or "").partition(".")[0]
    if top in OURS:
        return False
    if top == "builtins":
        # code that was run without a module's name takes this one
        return getattr(builtins, getattr(value, "__name__", ""), None) is not value
    if top in sys.stdlib_module_names and top != "__main__":
        return False
    path = getattr(sys.modules.get(top), "__file__", None)
    installed = {sysconfig.get_paths()[name] for name in ("purelib", "platlib", "stdlib")}
    return path is None or not any(Path(path).is_relative_to(place) for place in installed)
