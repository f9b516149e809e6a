"""Is a changed copy of a shipped step the same, and if not, which theorem does it break?"""
