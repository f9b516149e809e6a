"""What the page has in place of seven modules of the standard library.

Brython's own are whole, and take many seconds to load from a file. These hold what the reference
implementations use of them, and refuse the rest by not having it. The suites, run in the browser, judge them.
"""
