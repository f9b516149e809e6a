"""What a message says of something that was made from another text than the present one.

First comes what may be wrong: the change may not have been meant. Then the one command that makes everything
anew that hangs on it, and publishes only what the specification accepts.
"""

from __future__ import annotations

RENEW = "modeproof renew"


def renew_command(document: str = "", reason: bool = False) -> str:
    """The command that renews a document, or all; with the reason that it asks where a pin moves."""
    return RENEW + (f" --document {document}" if document else "") + (" --reason TEXT" if reason else "")


def stale(what: str, document: str = "", reason: bool = False) -> str:
    """A message: what has changed, what to do if nobody meant it, and what if somebody did."""
    return f"{what}; if that was not meant, undo it; if it was: {renew_command(document, reason)}"
