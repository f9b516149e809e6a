"""Is a program equal to a reference, in every scan from power-up?"""
