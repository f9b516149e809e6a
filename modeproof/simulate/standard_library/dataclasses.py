"""`dataclass`, `field`-less: frozen records with defaults, compared and hashed by their values."""

from __future__ import annotations


class _Missing:
    def __repr__(self) -> str:
        return "MISSING"


MISSING = _Missing()


class FrozenInstanceError(AttributeError):
    """A field of a frozen record was set."""


class Field:
    """One field of a record: its name, and its default where it has one."""

    def __init__(self, name, default):
        self.name, self.default, self.default_factory = name, default, MISSING


def dataclass(cls=None, *, frozen=False, slots=False):
    """Make a class a record. `slots` changes nothing here; of `frozen` a later assignment is refused."""
    if cls is None:
        return lambda of: _made(of, frozen)
    return _made(cls, frozen)


def _made(cls, frozen):
    names = list(cls.__annotations__)
    cls.__dataclass_fields__ = {name: Field(name, getattr(cls, name, MISSING)) for name in names}
    given = ", ".join(
        f"{name}=_defaults[{name!r}]" if of.default is not MISSING else name
        for name, of in cls.__dataclass_fields__.items()
    )
    body = "".join(f"    _set(self, {name!r}, {name})\n" for name in names)
    after = "    self.__post_init__()\n" if hasattr(cls, "__post_init__") else ""
    text = f"def __init__(self{', ' if given else ''}{given}):\n{body}{after}    return None\n"
    room = {"_set": object.__setattr__, "_defaults": {n: f.default for n, f in _fields(cls)}}
    exec(text, room)
    cls.__init__ = room["__init__"]
    cls.__eq__ = _equal
    cls.__hash__ = lambda self: hash(_values(self))
    cls.__repr__ = _shown
    if frozen:
        cls.__setattr__ = _refuse
    return cls


def _fields(cls):
    return cls.__dataclass_fields__.items()


def _values(record):
    return tuple([getattr(record, name) for name in record.__dataclass_fields__])


def _equal(self, other):
    if type(self) is not type(other):
        return NotImplemented
    return _values(self) == _values(other)


def _shown(self):
    inner = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__dataclass_fields__)
    return f"{type(self).__qualname__}({inner})"


def _refuse(self, name, value):
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def fields(record):
    """The fields of a record or of its class, in order."""
    return tuple(record.__dataclass_fields__.values())


def replace(record, **changes):
    """A record with other values in some fields."""
    values = {name: getattr(record, name) for name in record.__dataclass_fields__}
    return type(record)(**{**values, **changes})
