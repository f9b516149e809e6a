"""What to build: each target of each document as one pure Python file, standard library only.

A target offers ``Params``, ``State``, ``Inputs``, ``Outputs``, ``power_up(params)`` and ``step(state,
inputs)``. There is no clock, no input or output and no global state behind them: time comes in as ``dt_ms``.
The code was written from the documents' text and the published decisions, separately from the specification,
and is never generated from it.
"""
