"""TLC's framed messages are understood by code; whatever is cut off is noticed."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.tlc.messages import Counts, LogReader, format_trace, unquote
from tests.tlc.outcomes import log_lines, read_log


def test_a_finished_run_gives_its_counts() -> None:
    log = read_log(log_lines("MC_toy"))
    assert log.counts == Counts(generated=33, distinct=16, queue=0)
    assert (log.initial, log.success, log.finished, log.final, log.broken) == (1, True, True, True, "")
    assert any(name.endswith("Toy.tla") for name in log.files)


def test_a_violated_invariant_is_named_and_its_trace_is_read() -> None:
    log = read_log(log_lines("NEG_small"))
    assert log.violations == [("invariant", "Small")]
    assert [state.number for state in log.trace] == [1, 2, 3, 4]
    assert [state.action for state in log.trace] == ["Initial predicate", "Up", "Up", "Up"]
    assert dict(log.trace[-1].variables)["count"] == "3"
    assert not log.success


def test_a_violated_temporal_property_has_no_name_but_a_loop() -> None:
    log = read_log(log_lines("NEG_reaches"))
    assert log.violations == [("temporal", "")]
    assert log.loop == "stuttering"


def test_a_counterexample_shows_what_each_step_changes() -> None:
    shown = format_trace(read_log(log_lines("NEG_small")).trace, "")
    assert shown.splitlines()[0].split() == ["1", "Initial", "predicate"]
    assert shown.count("count = ") == 4 and shown.count("top") == 1


def test_wires_take_the_place_of_variables_of_their_name() -> None:
    trace = read_log(log_lines("NEG_small")).trace
    shown = format_trace(trace, "", wires=[{"count": f"{n:04X} (mode {n})"} for n in range(len(trace))])
    assert shown.count("count = ") == 4 and "count = 0003 (mode 3)" in shown and "count = 3" not in shown


@given(st.text(st.characters(codec="utf-8", exclude_characters="\n\r")))
def test_a_printed_string_comes_back_as_the_model_wrote_it(text: str) -> None:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    assert unquote(f'"{escaped}"'.encode()) == text.encode()


def test_printed_lines_are_counted_by_their_first_word() -> None:
    seen: list[bytes] = []
    reader = LogReader(on_printed=seen.append)
    reader.feed(b'"<<\\"EDGE\\", <<1, 2>>, \\"Up\\">>"\n')
    reader.feed(b'"<<\\"EDGE\\", <<3>>>>"\r\n')
    reader.feed(b'"<<\\"STATE\\", <<1>>>>"\n')
    reader.feed(b'"other"\n')
    log = reader.close()
    assert log.tags == {"EDGE": 2, "STATE": 1} and log.printed == 4
    assert seen[0] == b'<<"EDGE", <<1, 2>>, "Up">>'


def test_a_printed_line_inside_a_message_belongs_to_the_model() -> None:
    reader = LogReader()
    for line in (b"@!@!@STARTMSG 2193:0 @!@!@\n", b'"<<\\"REACHED\\", \\"a\\">>"\n', b"No error\n"):
        reader.feed(line)
    reader.feed(b"@!@!@ENDMSG 2193 @!@!@\n")
    log = reader.close()
    assert log.success and log.tags == {"REACHED": 1} and not log.broken


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([b"@!@!@STARTMSG 2193:0 @!@!@\n", b"half"], "has no end"),
        ([b"@!@!@ENDMSG 2193 @!@!@\n"], "without a start"),
        ([b'"<<\\"EDGE\\", <<1'], "printed line 1 is cut off"),
        ([b"@!@!@STARTMSG 2199:0 @!@!@\n", b"many states\n", b"@!@!@ENDMSG 2199 @!@!@\n"], "has no counts"),
    ],
)
def test_a_log_that_is_cut_off_or_garbled_is_broken(lines: list[bytes], words: str) -> None:
    assert words in read_log(lines).broken


def test_an_error_inside_an_error_is_kept_with_its_code() -> None:
    lines = [
        b"@!@!@STARTMSG 1000:1 @!@!@\n",
        b": @!@!@STARTMSG 5006:1 @!@!@\n",
        b"It was expecting = or <-\n",
        b"@!@!@ENDMSG 5006 @!@!@\n",
        b"@!@!@ENDMSG 1000 @!@!@\n",
    ]
    assert [code for code, _ in read_log(lines).errors] == [5006, 1000]


def test_the_estimates_of_a_collision_of_fingerprints_are_read() -> None:
    reader = LogReader()
    for line in (
        b"@!@!@STARTMSG 2193:0 @!@!@\n",
        b"Model checking completed. No error has been found.\n",
        b"  calculated (optimistic):  val = 2.5E-8\n",
        b"  based on the actual fingerprints:  val = 9.6E-10\n",
        b"@!@!@ENDMSG 2193 @!@!@\n",
    ):
        reader.feed(line)
    assert reader.log.collision == {"calculated": 2.5e-8, "actual": 9.6e-10}
