"""`Enum` with plain values: members are single objects with `name` and `value`, in the order of the class."""

from __future__ import annotations


class _EnumType(type):
    """Makes the members, and is iterated and called for them."""

    def __new__(meta, name, bases, body):
        """The class with one member for each value of its body."""
        values = {
            key: value for key, value in body.items() if not key.startswith("_") and not callable(value)
        }
        rest = {key: value for key, value in body.items() if key not in values}
        made = type.__new__(meta, name, bases, rest)
        made.members = []
        for key, value in values.items():
            member = object.__new__(made)
            member.name, member.value = key, value
            made.members.append(member)
            setattr(made, key, member)
        return made

    def __iter__(self):
        return iter(self.members)

    def __call__(self, value):
        """The member of this value. Raises ValueError."""
        for member in self.members:
            if member.value == value:
                return member
        raise ValueError(f"{value!r} is not a valid {self.__name__}")


class Enum(metaclass=_EnumType):
    """Base of the classes of members."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__}.{self.name}>"
