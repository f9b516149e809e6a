"""The same as for programs: what a command writes below build/ stays out of this tree."""

from tests.programs.conftest import a_build_of_its_own

__all__ = ["a_build_of_its_own"]
