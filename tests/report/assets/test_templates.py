"""Templates are compiled once on a machine, and again whenever another page would come of it."""

import jinja2
import pytest

from trialid.report import templates


@pytest.fixture
def compiled(monkeypatch, tmp_path):
    """The templates that were compiled since, by name; their cache is empty."""
    names = []
    of_jinja = jinja2.Environment.compile

    def compile_(self, source, name=None, filename=None, **more):
        names.append(name)
        return of_jinja(self, source, name, filename, **more)

    monkeypatch.setattr(jinja2.Environment, "compile", compile_)
    monkeypatch.setenv("TRIALID_CACHE", str(tmp_path / "cache"))
    return names


def render():
    """A small page by a new environment."""
    found = templates.environment("trialid", "replay/layouts")
    name = found.list_templates(filter_func=lambda one: one.endswith(".j2"))[0]
    return found.get_template(name)


def test_a_template_is_compiled_once(compiled):
    first, second = render(), render()
    assert len(compiled) == 1
    assert first.filename == second.filename


def test_with_another_source_of_the_package_it_is_compiled_again(compiled, monkeypatch):
    render()
    monkeypatch.setattr(templates, "source_digest", lambda: "another")
    render()
    render()
    assert len(compiled) == 2


def test_what_others_may_write_is_not_run(compiled, tmp_path):
    render()
    (tmp_path / "cache").chmod(0o777)
    render()
    assert len(compiled) == 2


def test_without_a_place_to_keep_them_pages_are_made(compiled, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("no folder", encoding="utf-8")
    monkeypatch.setenv("TRIALID_CACHE", str(tmp_path / "file"))
    assert render().name == render().name
    assert len(compiled) == 2
