"""Why the explorer gives no answer: one line that says what, where and what to write instead."""


class ExplorationError(Exception):
    """The function cannot be explored; nothing may be concluded from it."""


class ConcretizationError(ExplorationError, TypeError):
    """The code asked a symbolic value for more than it can give."""


class HiddenStateError(ExplorationError):
    """The code did something else when the same path was run again: it keeps state between calls."""


class TooManyPathsError(ExplorationError):
    """The code has more paths, or longer ones, than the limit."""


class UndecidedError(ExplorationError):
    """The solver could not say whether a branch is feasible."""


class LintError(ExplorationError):
    """The code contains what no symbolic value can notice."""
