"""Evidence: one JSON file a run, written atomically, checked by one schema on writing and on reading."""

from modeproof.ground.evidence.files import (
    OURS,
    YOURS,
    discard,
    discard_undeclared,
    evidence_path,
    read,
    read_document,
    write,
)
from modeproof.ground.evidence.kept import Rests, why_again
from modeproof.ground.evidence.record import (
    SCHEMA_VERSION,
    day,
    is_sealed,
    machine,
    make,
    other_tools,
    own_tools,
    package,
    result_sha256,
    sha256,
    solvers,
    tool,
)
from modeproof.ground.meaning import meanings as hashes

__all__ = [
    "OURS",
    "SCHEMA_VERSION",
    "YOURS",
    "Rests",
    "day",
    "discard",
    "discard_undeclared",
    "evidence_path",
    "hashes",
    "is_sealed",
    "machine",
    "make",
    "other_tools",
    "own_tools",
    "package",
    "read",
    "read_document",
    "result_sha256",
    "sha256",
    "solvers",
    "tool",
    "why_again",
    "write",
]
