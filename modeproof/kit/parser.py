"""What our command lines share: options have their whole names, and a refusal is one line."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from modeproof.kit.errors import Unjudged, nearest


class Parser(argparse.ArgumentParser):
    """A parser that takes options by their whole names and raises Unjudged for anything else."""

    def __init__(self, *given: Any, **options: Any) -> None:
        super().__init__(*given, **{"allow_abbrev": False, **options})

    def error(self, message: str) -> NoReturn:
        """Refuse in one line, which names the help of the command that was called."""
        raise Unjudged(f"{message} (`{self.prog} --help` says what is allowed)")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """As argparse does; but a command refuses its own unknown options, and before anything else."""
        words = list(sys.argv[1:] if args is None else args)
        self._refuse_unknown(words)
        found, rest = super().parse_known_args(words, namespace)
        if rest:
            self.error(f"too much: {' '.join(rest)}")
        return found, rest

    def _refuse_unknown(self, words: Sequence[str]) -> None:
        known = self._option_string_actions
        for word in words:
            if word == "--" or (self._subparsers is not None and not word.startswith("-")):
                return  # what follows is no option, or the business of the command named
            name = word.partition("=")[0]
            if name.startswith("--") and " " not in word and name not in known:
                close = nearest(name, (one for one in known if one.startswith("--")))
                self.error(f"no option {name}{f'; did you mean {close[0]}?' if close else ''}")
