"""Tables, as pages, CSV, Markdown and LaTeX have them."""

__all__: list[str] = []
