"""The table of codes as the document prints it, taken from its text by machine: code, name, outputs in order,
T for TRUE and SAFETRUE, F for FALSE and SAFEFALSE. Written for neither specification nor code.
"""

from __future__ import annotations

ORDER = (
    "Ready",
    "S_OSSD_Out",
    "S_TestOut",
    "TestPossible",
    "TestExecuted",
    "SafetyDemand",
    "ResetRequest",
    "Error",
)

PRINTED = """
C000 TFTFFFFT Parameter Error
C001 TFTFFFFT Reset Error 1
C011 TFTFFFFT Reset Error 2
C021 TFTFFFFT Reset Error 3
C031 TFTFFFFT Reset Error 4
C041 TFTFFFFT Reset Error 5
C051 TFTFTFFT Reset Error 6
C410 TFTFFFTT Test Error 1
C010 TFTFFFFT Test Error 1
0000 FFTFFFFF Idle
8401 TFTFFFTF Init
8802 TFTFFTFF ESPE Interrupted 1
8402 TFTFFFTF Wait for Reset 1
8002 TFTFFFFF External Function Test
8804 TFTFFTFF ESPE Interrupted External Test
8404 TFTFFFTF End External Test
8010 TTTTFFFF ESPE Free No Test
8806 TFTFTTFF ESPE Interrupted 2
8406 TFTFTFTF Wait for Reset 2
8020 TTFFFFFF Test Request
8030 TTTFFFFF Test Active
8000 TTTTTFFF ESPE Free Test ok
"""


def rows() -> dict[tuple[str, int], tuple[bool, ...]]:
    """By name and code: the outputs in ORDER."""
    found = {}
    for line in PRINTED.strip().splitlines():
        code, letters, name = line.split(maxsplit=2)
        found[name, int(code, 16)] = tuple(letter == "T" for letter in letters)
    return found


def state_of(name: str, code: int) -> str:
    """The state of ours that has this printed name; Test Error 1 has two rows and so two states."""
    short = "".join(word[0].upper() + word[1:] for word in name.split())
    return f"{short}{code:04X}" if short == "TestError1" else short
