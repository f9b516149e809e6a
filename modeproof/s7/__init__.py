"""A PLC behind the S7 protocol, as an adapter of the kit.

    python -m modeproof.s7 TARGET --host HOST[:PORT] --map FILE --vectors FILE

speaks adapter protocol 1 (see `modeproof.kit`) on standard input and output. It writes the inputs into the
PLC's memory, steps the program and reads the outputs, where the address map says they lie.
"""
