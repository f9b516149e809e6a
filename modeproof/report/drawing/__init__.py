"""Pictures of the report: layered layout, and SVG without any resource from outside."""
