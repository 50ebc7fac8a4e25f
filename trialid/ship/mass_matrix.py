"""The mass matrix of the simulated motions, inverted by cofactors."""

from trialid.maths import Number
from trialid.ship.rigid_body import Balance


def solve(balance: Balance, rows: tuple[str, ...]) -> dict[tuple[str, str], Number]:
    """Inverse of the mass matrix of the simulated rows, by cofactors (surge stands alone)."""
    inverse: dict[tuple[str, str], Number] = {}
    if "u" in rows:
        inverse["u", "u"] = 1.0 / balance.mass["u", "u"]
    lateral = tuple(s for s in rows if s != "u")
    matrix = [[balance.mass.get((a, b), 0.0) for b in lateral] for a in lateral]
    for i, a in enumerate(lateral):
        for j, b in enumerate(lateral):
            cofactor = determinant(_minor(matrix, j, i)) * (-1.0) ** (i + j)
            inverse[a, b] = cofactor
    if lateral:
        over = 1.0 / determinant(matrix)
        inverse |= {k: x * over for k, x in inverse.items() if k != ("u", "u")}
    return inverse


def _minor(matrix: list[list[Number]], row: int, column: int) -> list[list[Number]]:
    return [
        [x for j, x in enumerate(line) if j != column] for i, line in enumerate(matrix) if i != row
    ]


def determinant(matrix: list[list[Number]]) -> Number:
    """The determinant, by minors of the first row."""
    if not matrix:
        return 1.0
    total: Number = 0.0
    for j, x in enumerate(matrix[0]):
        total = total + x * determinant(_minor(matrix, 0, j)) * (-1.0) ** j
    return total
