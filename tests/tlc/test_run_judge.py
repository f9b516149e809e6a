"""A run is as expected only when verdict, named property, counts, property set and cfg all are.

Each test plants one fault into a run that is otherwise as expected.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from msgspec.structs import replace as with_values

from modeproof.tlc.process import Outcome
from modeproof.tlc.run_judge import HOLDS, INCONCLUSIVE, REACHED, UNJUDGED, UNREACHED, VIOLATED
from tests.tlc.outcomes import STATUS, declared, judged, log_lines, outcome
from tests.toy_tree import CFGS, sha256

WITNESSED = (b'<<"REACHED", "top">>', b'<<"REACHED", "down">>')


@pytest.mark.parametrize(
    ("name", "verdict"), [("MC_toy", HOLDS), ("NEG_small", VIOLATED), ("NEG_reaches", VIOLATED)]
)
def test_without_a_fault_each_run_is_as_expected(name: str, verdict: str) -> None:
    judgement = judged(declared(name), outcome(name))
    assert (judgement.verdict, judgement.as_expected, judgement.reason) == (verdict, True, "")


def test_an_expected_violation_says_so() -> None:
    assert judged(declared("NEG_small"), outcome("NEG_small")).words == "VIOLATED, as expected"
    assert judged(declared("NEG_small", property="TypeOK"), outcome("NEG_small")).words == "VIOLATED"


# ------------------------------------------------------------------ faults in cfg and register


def faulty_cfg(name: str, old: str, new: str) -> tuple[str, str]:
    text = CFGS[name].replace(old, new)
    assert text != CFGS[name]
    return text, sha256(text)


def test_an_invariant_removed_from_the_cfg_is_noticed() -> None:
    text, digest = faulty_cfg("NEG_small", "TypeOK Small", "Small")
    for run in (declared("NEG_small"), declared("NEG_small", cfg_sha256=digest)):
        judgement = judged(run, outcome("NEG_small"), text)
        assert not judgement.as_expected and "does not check TypeOK" in judgement.reason


def test_an_invariant_added_to_the_cfg_alone_is_noticed() -> None:
    text, digest = faulty_cfg("MC_toy", "TypeOK", "TypeOK Small")
    judgement = judged(declared("MC_toy", cfg_sha256=digest), outcome("MC_toy"), text)
    assert not judgement.as_expected and "which runs.toml does not list" in judgement.reason


def test_an_emptied_property_list_is_noticed() -> None:
    text, digest = faulty_cfg("MC_toy", "INVARIANTS TypeOK\n", "")
    judgement = judged(declared("MC_toy", cfg_sha256=digest, properties=()), outcome("MC_toy"), text)
    assert not judgement.as_expected and "checks no property" in judgement.reason
    assert not judged(declared("MC_toy", properties=()), outcome("MC_toy")).as_expected


def test_a_shrunk_constant_is_noticed_even_when_nothing_else_changes() -> None:
    text, _ = faulty_cfg("MC_toy", "N = 4", "N = 2")
    judgement = judged(declared("MC_toy"), outcome("MC_toy"), text)
    assert not judgement.as_expected and "was changed since its counts were pinned" in judgement.reason


@pytest.mark.parametrize("pin", ["distinct", "generated"])
@pytest.mark.parametrize("by", [-1, 1])
def test_a_count_that_differs_is_noticed(pin: str, by: int) -> None:
    counts = {"distinct": 16, "generated": 33}
    judgement = judged(declared("MC_toy", **{pin: counts[pin] + by}), outcome("MC_toy"))
    assert judgement.verdict == HOLDS and not judgement.as_expected
    assert judgement.reason == f"{pin} states: {counts[pin]}, pinned {counts[pin] + by}"


@pytest.mark.parametrize("pin", ["distinct", "generated", "cfg_sha256"])
def test_a_run_without_pins_is_never_as_expected(pin: str) -> None:
    judgement = judged(declared("MC_toy", **{pin: None}), outcome("MC_toy"))
    assert not judgement.as_expected and judgement.reason == f"not pinned yet: {pin}"


# ------------------------------------------------------------------ faults in the outcome


def test_a_violation_of_another_property_is_not_the_expected_one() -> None:
    lines = [line.replace(b"Invariant Small", b"Invariant TypeOK") for line in log_lines("NEG_small")]
    judgement = judged(declared("NEG_small"), outcome("NEG_small", lines))
    assert judgement.verdict == VIOLATED and not judgement.as_expected
    assert judgement.reason == "TypeOK is violated, not Small"


def test_a_negative_that_holds_is_not_as_expected() -> None:
    judgement = judged(declared("NEG_small"), outcome("MC_toy"))
    assert judgement.verdict == HOLDS and judgement.reason == "Small was to be violated, and is not"


def test_a_violation_where_a_run_must_hold_is_not_expected() -> None:
    judgement = judged(declared("MC_toy"), outcome("NEG_small"))
    assert judgement.verdict == VIOLATED and not judgement.as_expected


@pytest.mark.parametrize("pinned", [3, 5])
def test_a_longer_or_shorter_counterexample_is_noticed(pinned: int) -> None:
    judgement = judged(declared("NEG_small", trace_length=pinned), outcome("NEG_small"))
    assert not judgement.as_expected
    assert judgement.reason == f"the counterexample has 4 states, not {pinned}"


def test_an_unnamed_temporal_violation_counts_for_a_single_property_only() -> None:
    text, digest = faulty_cfg("NEG_reaches", "PROPERTY Reaches", "PROPERTIES Reaches Other")
    run = declared("NEG_reaches", cfg_sha256=digest, properties=("Reaches", "Other"))
    judgement = judged(run, outcome("NEG_reaches"), text)
    assert not judgement.as_expected and "an unnamed property is violated" in judgement.reason


@pytest.mark.parametrize("name", sorted(STATUS))
def test_a_log_cut_off_anywhere_is_unjudged(name: str) -> None:
    lines = log_lines(name)
    whole = len(lines)
    for length in range(whole):
        for status in (STATUS[name], 0, -9):
            judgement = judged(declared(name), outcome(name, lines[:length], status))
            assert not judgement.as_expected, f"{length} of {whole} lines, status {status}"
            assert judgement.verdict == UNJUDGED


@pytest.mark.parametrize("name", sorted(STATUS))
def test_an_exit_status_that_contradicts_the_log_is_unjudged(name: str) -> None:
    for status in {0, 1, 10, 11, 12, 13, 151, 255, -15} - {STATUS[name]}:
        judgement = judged(declared(name), outcome(name, status=status))
        assert judgement.verdict == UNJUDGED, status


def test_a_lost_message_is_unjudged() -> None:
    lines = log_lines("MC_toy")
    starts = [n for n, line in enumerate(lines) if line.startswith(b"@!@!@STARTMSG")]
    needed = {b"2262", b"2185", b"2193", b"2199", b"2186"}
    for start in starts:
        code = lines[start].split()[1].split(b":")[0]
        end = next(n for n in range(start, len(lines)) if lines[n].startswith(b"@!@!@ENDMSG " + code))
        judgement = judged(declared("MC_toy"), outcome("MC_toy", lines[:start] + lines[end + 1 :]))
        assert judgement.as_expected == (code not in needed), code


def test_states_left_unexplored_are_unjudged() -> None:
    lines = [line.replace(b"0 states left", b"7 states left") for line in log_lines("MC_toy")]
    assert judged(declared("MC_toy"), outcome("MC_toy", lines)).verdict == UNJUDGED


def test_a_time_limit_is_inconclusive_whatever_was_found_so_far() -> None:
    judgement = judged(declared("MC_toy"), replace(outcome("MC_toy"), timed_out=True))
    assert (
        judgement.verdict == INCONCLUSIVE and not judgement.as_expected and "time limit" in judgement.reason
    )


def test_a_heap_that_is_too_small_is_inconclusive() -> None:
    for found in (
        outcome("MC_toy", log_lines("MC_toy")[:20], status=3),
        outcome(
            "MC_toy", [b"Error occurred during initialization of VM\n", b"Too small maximum heap\n"], status=1
        ),
        replace(outcome("MC_toy", [], status=1), stderr="java.lang.OutOfMemoryError: Java heap space"),
    ):
        judgement = judged(declared("MC_toy"), found)
        assert judgement.verdict == INCONCLUSIVE and "out of memory with heap_mb = 256" in judgement.reason


def test_java_that_cannot_start_is_unjudged_in_its_own_words() -> None:
    judgement = judged(declared("MC_toy"), outcome("MC_toy", [b"Unrecognized VM option\n"], status=1))
    assert judgement.verdict == UNJUDGED and "Unrecognized VM option" in judgement.reason


# ------------------------------------------------------------------ witnesses and graphs


def test_every_listed_witness_must_be_printed() -> None:
    run = declared("WIT_toy")
    assert judged(run, outcome("MC_toy", printed=WITNESSED)).as_expected
    judgement = judged(run, outcome("MC_toy", printed=WITNESSED[:1]))
    assert (judgement.verdict, judgement.as_expected) == (UNREACHED, False)
    assert judgement.reason == "not reached: down"


def test_an_unlisted_witness_and_a_garbled_one_are_noticed() -> None:
    run = declared("WIT_toy")
    extra = judged(run, outcome("MC_toy", printed=(*WITNESSED, b'<<"REACHED", "new">>')))
    assert extra.verdict == REACHED and extra.reason == "reached, but not listed: new"
    assert judged(run, outcome("MC_toy", printed=(*WITNESSED, b'<<"REACHED", new'))).verdict == UNJUDGED
    short = replace(outcome("MC_toy", printed=WITNESSED), printed_all=False)
    assert judged(run, short).verdict == UNJUDGED


def graph_outcome(states: int, edges: int) -> Outcome:
    found = outcome("MC_toy")
    found.log.tags = {"STATE": states, "EDGE": edges}
    return found


def test_a_run_with_an_incomplete_graph_is_not_as_expected() -> None:
    graph = declared("OPEN_toy").graph
    assert graph is not None
    run = declared("OPEN_toy", distinct=16, generated=33, graph=with_values(graph, states=16, edges=32))
    assert judged(run, graph_outcome(16, 32)).as_expected
    lost_edge = judged(run, graph_outcome(16, 31))
    assert lost_edge.reason == "31 edges were printed, but TLC took 32 transitions"
    lost_state = judged(run, graph_outcome(15, 32))
    assert lost_state.reason == "15 states were printed, but TLC found 16"


def test_a_pinned_edge_count_that_differs_is_noticed() -> None:
    graph = declared("OPEN_toy").graph
    assert graph is not None
    run = declared("OPEN_toy", distinct=16, generated=33, graph=with_values(graph, states=16, edges=40))
    assert judged(run, graph_outcome(16, 32)).reason == "graph edges: 32, pinned 40"


def test_a_view_in_a_liveness_run_is_refused() -> None:
    text = "SPECIFICATION FairSpec\nVIEW View\nPROPERTY Reaches\n"
    run = declared("MC_toy", id="LIVE_toy", kind="LIVE", properties=("Reaches",), cfg_sha256=sha256(text))
    judgement = judged(run, outcome("MC_toy"), text)
    assert not judgement.as_expected and "VIEW" in judgement.reason
