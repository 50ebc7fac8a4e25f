"""How far each parameter can be trusted: Eq. 8 to 14, coloured residuals, weak directions."""

__all__: list[str] = []
