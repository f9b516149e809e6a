"""Annotations are never evaluated in the page."""

annotations = None
