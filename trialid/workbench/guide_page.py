"""The manual as pages of the workbench: the Markdown that `trialid guide` shows, as HTML.

Raw HTML in a page stays text, and the tables carry no style of their own: the policy of the guard
allows no other.
"""

from functools import cache

from trialid.guide import TOPICS, page
from trialid.workbench import screen


@cache
def html_page(topic: str | None) -> str:
    """The page of a topic as a whole HTML page; None is the list of topics.

    Raises
    ------
    TrialidError
        There is no such topic.
    """
    from markdown_it import MarkdownIt

    text = _listing() if topic is None else page(topic)
    body = MarkdownIt("commonmark", {"html": False}).enable("table").render(text)
    name = topic and topic.removesuffix(".md")
    template = screen.environment().get_template("guide.html.j2")
    return template.render(body=body, topics=TOPICS, topic=name)


def _listing() -> str:
    rows = "\n".join(f"- [{name}](/guide/{name}): {line}" for name, line in TOPICS.items())
    return f"# The guide\n\n{rows}\n"
