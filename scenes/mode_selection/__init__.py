"""The four devices, the user and the wires between them."""
