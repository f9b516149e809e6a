"""The path explorer: shipped functions run unchanged on symbolic values, path by path.

`values` has the symbolic values and what they refuse, `explore` runs a function on every feasible path,
`lint` refuses what no symbolic value can notice, `device` runs a device's `step` from each control state.
"""
