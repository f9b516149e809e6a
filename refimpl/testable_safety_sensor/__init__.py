"""Reference implementation of the document testable_safety_sensor."""
