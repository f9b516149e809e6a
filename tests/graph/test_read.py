"""A printed graph is used only when it is whole."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.graph.read import read_graph
from modeproof.ground.errors import Unjudged
from modeproof.tlc.tla_values import TlaError, canonical, parse, unquote
from tests.graph.printed import LETTERS, lines, quoted, write


def refused(path: Path, printed: list[str], **pins: int) -> str:
    with pytest.raises(Unjudged) as caught:
        read_graph(write(path / "g.txt", printed), **pins)
    return caught.value.message


def edges_of(printed: list[str]) -> list[int]:
    return [n for n, line in enumerate(printed) if line.startswith('<<"EDGE"')]


@pytest.mark.parametrize("form", [str, quoted], ids=["unquoted", "as TLC prints it"])
def test_a_whole_graph_is_read_in_both_forms(tmp_path: Path, form: type[str]) -> None:
    graph = read_graph(write(tmp_path / "g.txt", map(form, lines())), states=3, edges=3 * len(LETTERS))
    assert len(graph.views) == 3 and graph.edges == 54
    assert graph.views[graph.initial] == '<<"Off", {}, 0>>'
    assert graph.edges_of_steps() == {"StayOff": 15, "SwitchOn": 3, "StayOn": 18, "Expire": 18}
    assert graph.outputs[graph.initial] == {"LAMP": False, "MW": 0}
    assert graph.shortest_paths() == (None, (0, 12), (1, 1))


def test_an_edge_that_was_lost_is_noticed(tmp_path: Path) -> None:
    printed = lines()
    del printed[edges_of(printed)[20]]
    assert "1 edges are missing; the first: input 2 at" in refused(tmp_path, printed)


def test_an_edge_that_comes_twice_is_noticed(tmp_path: Path) -> None:
    printed = lines()
    printed.append(printed[edges_of(printed)[5]])
    assert "two edges for input 5" in refused(tmp_path, printed)


def test_a_wrapped_line_is_noticed(tmp_path: Path) -> None:
    printed = lines()
    at = edges_of(printed)[3]
    printed[at : at + 1] = [printed[at][:30], "   " + printed[at][30:]]
    assert f"line {at + 1}: not one whole printed tuple" in refused(tmp_path, printed)


def test_a_view_without_state_line_is_noticed(tmp_path: Path) -> None:
    printed = [line for line in lines() if not line.startswith('<<"STATE", <<"On", {}, 1>>')]
    assert 'view without STATE line: <<"On", {}, 1>>' in refused(tmp_path, printed)


def test_a_view_that_hides_an_output_is_noticed(tmp_path: Path) -> None:
    printed = [*lines(), '<<"STATE", <<"Off", {}, 0>>, [LAMP |-> TRUE, MW |-> 0]>>']
    assert "two different rows" in refused(tmp_path, printed)


def test_an_unreachable_state_is_noticed(tmp_path: Path) -> None:
    printed = lines()
    printed.append('<<"STATE", <<"Lost", {}, 0>>, [LAMP |-> TRUE, MW |-> 0]>>')
    printed += [f'<<"EDGE", <<"Lost", {{}}, 0>>, "StayOff", {n}, <<"Off", {{}}, 0>>>>' for n in range(18)]
    assert "never reaches" in refused(tmp_path, printed)


@pytest.mark.parametrize(
    ("pins", "said"),
    [({"states": 4}, "3 states printed, 4 pinned"), ({"edges": 53}, "54 edges printed, 53 pinned")],
)
def test_counts_other_than_the_pins_are_noticed(tmp_path: Path, pins: dict[str, int], said: str) -> None:
    assert said in refused(tmp_path, lines(), **pins)


def framed(generated: int) -> list[str]:
    def message(code: int, text: str) -> list[str]:
        return [f"@!@!@STARTMSG {code}:0 @!@!@", text, f"@!@!@ENDMSG {code} @!@!@"]

    return [
        *message(2190, "Finished computing initial states: 1 distinct state generated at 2026."),
        *map(quoted, lines()),
        *message(2199, f"{generated} states generated, 3 distinct states found, 0 states left on queue."),
        *message(2186, "Finished in 1s"),
    ]


def test_the_counts_of_tlc_are_compared(tmp_path: Path) -> None:
    assert read_graph(write(tmp_path / "g.txt", framed(55))).edges == 54
    assert "54 edges printed, TLC generated 55" in refused(tmp_path, framed(56))


def test_a_log_of_a_killed_tlc_is_noticed(tmp_path: Path) -> None:
    assert "TLC did not finish" in refused(tmp_path, framed(55)[:-3])
    assert "cut off" in refused(tmp_path, framed(55)[:-1])


@pytest.mark.parametrize(
    ("bad", "said"),
    [
        ('<<"EDGE", <<"Off", {}, 0>>, "StayOff", 99, <<"Off", {}, 0>>>>', "input 99"),
        ('<<"INIT", <<"On", {}, 0>>>>', "2 INIT views"),
        ('<<"INPUT", 0, [dt |-> 7, press |-> TRUE, word |-> 0]>>', "declared twice"),
        ('<<"INPUT", 70, [dt |-> 0, press |-> FALSE, word |-> 0]>>', "edges are missing"),
        ('<<"OTHER", 1>>', "neither INPUT, INIT, STATE nor EDGE"),
        ('<<"EDGE", <<"Off", {, 0>>, "StayOff", 1, <<"Off", {}, 0>>>>', "a view cannot be read"),
        ("Error: out of memory", "not one whole printed tuple"),
    ],
)
def test_a_line_that_does_not_belong_is_noticed(tmp_path: Path, bad: str, said: str) -> None:
    message = refused(tmp_path, [*lines(), bad])
    assert said in message


def test_a_last_line_that_was_cut_is_noticed(tmp_path: Path) -> None:
    path = write(tmp_path / "g.txt", lines())
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.raises(Unjudged, match="cut off"):
        read_graph(path)


def test_an_empty_or_missing_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "g.txt").touch()
    with pytest.raises(Unjudged):
        read_graph(tmp_path / "g.txt")
    with pytest.raises(Unjudged, match="No such file"):
        read_graph(tmp_path / "none.txt")


def test_two_spellings_of_a_set_are_one_view(tmp_path: Path) -> None:
    printed = [line.replace("{}", "{0, 1}") for line in lines()]
    printed = [line.replace("{0, 1}", "{1, 0}", 1) if n % 2 else line for n, line in enumerate(printed)]
    assert len(read_graph(write(tmp_path / "g.txt", printed)).views) == 3


values = st.recursive(
    st.integers(-9, 99999)
    | st.booleans()
    | st.text(st.characters(codec="ascii", exclude_characters="\n\t\r\f")),
    lambda inner: (
        st.lists(inner, max_size=3).map(tuple)
        | st.frozensets(st.integers(0, 9), max_size=4)
        | st.dictionaries(
            st.from_regex("[A-Za-z_][A-Za-z0-9_]{0,5}", fullmatch=True), inner, min_size=1, max_size=3
        )
    ),
    max_leaves=8,
)


@given(values)
def test_what_is_written_is_read_back(value: object) -> None:
    assert canonical(parse(canonical(value))) == canonical(value)
    assert unquote(quoted(canonical(value))[1:-1]) == canonical(value)


@pytest.mark.parametrize(
    "text", ["", "<<1", "1 2", "[a |-> 1, a |-> 2]", "{1, 1}", "[a -> 1]", "<<" * 200, '"a']
)
def test_what_is_no_value_is_refused(text: str) -> None:
    with pytest.raises(TlaError):
        parse(text)
