"""The least cost of taking every transition of a graph: a minimum-cost flow, and the proof that it is least.

Cost counts one for each scan and one for each case, which begins with a reset. Cases that take every
transition, each closed by a reset back to power-up, are a circulation that passes every transition at least
once; so no suite costs less than the cheapest circulation. How it is found does not matter: `lower_bound`
checks it by prices of the states (linear programming duality), and gives the cost that the prices prove.
"""

from __future__ import annotations

from collections import Counter

from modeproof.graph.columns import Columns
from modeproof.ground.errors import Unjudged

_RESET, _SOURCE = -1, -2
Arcs = dict[tuple[int, int], int]


def lower_bound(columns: Columns, initial: int) -> int:
    """Scans and resets that every suite needs which takes each transition. Raises Unjudged when unproved."""
    import networkx  # an installed tool that makes no suites has none

    supply, arcs = problem(columns, initial)
    network: networkx.DiGraph[int] = networkx.DiGraph()
    for state, excess in supply.items():
        network.add_node(state, demand=-excess)
    for (node, other), cost in arcs.items():
        network.add_edge(node, other, weight=cost)
    extra, flow = networkx.network_simplex(network)
    prices = _prices(arcs, flow)
    proved = proved_by(prices, supply, arcs)
    if proved != extra:
        raise Unjudged(f"the lower bound is not proved: the flow costs {extra}, the prices prove {proved}")
    return columns.transitions + proved


def problem(columns: Columns, initial: int) -> tuple[Counter[int], Arcs]:
    """For each state how often more it is entered than left when every transition is taken once; the arcs."""
    supply: Counter[int] = Counter({_RESET: 0})
    arcs: Arcs = {(_RESET, initial): 0}
    for state, row in enumerate(columns.next_of):
        supply[state] += 0
        arcs[state, _RESET] = 1
        for after in row:
            supply[state] -= 1
            supply[after] += 1
            if after != state:
                arcs[state, after] = 1
    return supply, arcs


def _prices(arcs: Arcs, flow: dict[int, dict[int, int]]) -> dict[int, int]:
    """Distances in the residual network from a source that reaches all (Bellman and Ford)."""
    import networkx

    costs = dict(arcs)
    for (node, other), cost in arcs.items():
        if flow[node].get(other, 0) > 0:
            costs[other, node] = min(-cost, costs.get((other, node), -cost))
    residual: networkx.DiGraph[int] = networkx.DiGraph()
    residual.add_weighted_edges_from((node, other, cost) for (node, other), cost in costs.items())
    residual.add_weighted_edges_from([(_SOURCE, state, 0) for state in list(residual)])
    try:
        found = networkx.single_source_bellman_ford_path_length(residual, _SOURCE)
    except networkx.NetworkXUnbounded:
        raise Unjudged("the lower bound is not proved: the flow is not the cheapest") from None
    return {state: int(price) for state, price in found.items()}


def proved_by(prices: dict[int, int], supply: Counter[int], arcs: Arcs) -> int:
    """What prices prove: where no arc gains more than it costs, every flow costs at least this.

    Raises Unjudged when an arc gains more than it costs.
    """
    for (node, other), cost in arcs.items():
        if prices[other] - prices[node] > cost:
            raise Unjudged(f"the lower bound is not proved: the prices break the arc {node} to {other}")
    return sum(-prices[state] * excess for state, excess in supply.items())
