"""Least squares: a tall matrix folded to a triangle, and the search for the smallest sum.

Other packages take its modules: `fold` is what accuracy and design need of a Jacobian, too.
"""

__all__: list[str] = []
