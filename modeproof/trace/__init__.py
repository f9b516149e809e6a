"""A recorded log against the specification: against its graph, and again by TLC, exactly."""
