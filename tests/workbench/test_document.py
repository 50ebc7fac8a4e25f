"""The file under several hands: nothing is lost, and what is undone is as it was, byte for byte."""

from pathlib import Path

import pytest
import quick

from trialid.errors import PipelineError
from trialid.pipeline_file import Pipeline, load, read
from trialid.pipeline_file.edit import fix_parameter, set_value
from trialid.workbench.document import ELSEWHERE, Document, Outdated


@pytest.fixture(params=["\n", "\r\n", "bom"])
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """Give the pipeline as several editors write it."""
    made = quick.write(tmp_path)
    ends, mark = ("\n", b"\xef\xbb\xbf") if request.param == "bom" else (request.param, b"")
    made.write_bytes(mark + quick.TEXT.replace("\n", ends).encode())
    return made


def fixed(document: Document, name: str) -> Pipeline:
    """The pipeline with a parameter fixed."""
    recipe = document.pipeline
    return read(fix_parameter(recipe.text, name)[0].encode(), recipe.path)


def valued(document: Document, value: float) -> Pipeline:
    recipe = document.pipeline
    return read(set_value(recipe.text, "GM", value).encode(), recipe.path)


def only_file(path: Path) -> bool:
    """Whether nothing was left behind beside the pipeline."""
    return sorted(p.name for p in path.parent.iterdir()) == ["log.csv", path.name, "s175q.toml"]


def test_edits_undone_one_by_one_and_made_again(path: Path) -> None:
    document = Document(path)
    contents = [path.read_bytes()]
    for name in ("GM", "Nrar", "Yvav"):
        document.put(fixed(document, name), f"fix {name}")
        contents.append(path.read_bytes())
        assert document.pipeline == load(path)
    assert len(set(contents)) == 4
    for content, name in zip(contents[-2::-1], ("Yvav", "Nrar", "GM"), strict=True):
        assert document.undo().words == f"fix {name}"
        assert path.read_bytes() == content == document.pipeline.content
    with pytest.raises(PipelineError, match="nothing to undo"):
        document.undo()
    for content in contents[1:]:
        document.redo()
        assert path.read_bytes() == content == document.pipeline.content
    with pytest.raises(PipelineError, match="nothing to do again"):
        document.redo()
    assert only_file(path)


def test_an_edit_after_an_undo_leaves_nothing_to_do_again(path: Path) -> None:
    document = Document(path)
    document.put(fixed(document, "GM"), "fix GM")
    document.undo()
    document.put(fixed(document, "Nrar"), "fix Nrar")
    assert document.undone == ()
    with pytest.raises(PipelineError, match="nothing to do again"):
        document.redo()


def test_versions_tell_contents_apart(path: Path) -> None:
    document = Document(path)
    first = document.version
    document.check(first)
    document.put(fixed(document, "GM"), "fix GM")
    assert document.version != first
    with pytest.raises(Outdated, match=r"quick\.toml was changed meanwhile"):
        document.check(first)
    document.undo()
    assert document.version == first


@pytest.mark.parametrize("theirs", [b"# theirs\n", b"", None])
def test_what_another_has_written_is_never_overwritten(path: Path, theirs: bytes | None) -> None:
    document = Document(path)
    document.put(fixed(document, "GM"), "fix GM")
    step = document.done[-1]
    path.unlink() if theirs is None else path.write_bytes(theirs)
    with pytest.raises(Outdated):
        document.check(document.version)
    for write in (
        document.undo,
        lambda: document.put(fixed(document, "Nrar"), "fix Nrar"),
        lambda: document.amend(valued(document, 1.0)),
    ):
        with pytest.raises(PipelineError, match="was changed meanwhile"):
            write()
    assert not document.take_back(step)
    assert document.done == (step,)
    assert (path.read_bytes() if path.exists() else None) == theirs


def test_an_edit_and_its_amendment_are_undone_together(path: Path) -> None:
    document = Document(path)
    old = path.read_bytes()
    first = document.put(fixed(document, "Nrar"), "fix Nrar")
    step = document.amend(valued(document, 1.5))
    assert (step.words, step.old, step.new) == ("fix Nrar", old, path.read_bytes())
    assert not document.take_back(first)  # it is not what the file holds any more
    document.undo()
    assert path.read_bytes() == old
    document.redo()
    assert path.read_bytes() == step.new


def test_what_is_taken_back_was_never_there(path: Path) -> None:
    document = Document(path)
    first = document.put(fixed(document, "Nrar"), "fix Nrar")
    content = path.read_bytes()
    second = document.put(fixed(document, "GM"), "fix GM")
    assert not document.take_back(first)
    assert document.take_back(second)
    assert path.read_bytes() == content == document.pipeline.content
    assert (document.done, document.undone) == ((first,), ())
    assert only_file(path)


def test_what_cannot_be_put_back_stays(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document = Document(path)
    step = document.put(fixed(document, "GM"), "fix GM")

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("tempfile.mkstemp", full)
    assert not document.take_back(step)
    assert path.read_bytes() == step.new == document.pipeline.content
    with pytest.raises(PipelineError, match="No space left on device"):
        document.undo()
    assert document.done == (step,)


def test_an_edit_made_elsewhere_is_one_to_undo(path: Path) -> None:
    document = Document(path)
    assert not document.reread()
    old = path.read_bytes()
    path.write_bytes(old.replace(b"period = 1.0", b"period = 2.0"))
    assert document.reread()
    assert document.pipeline == load(path)
    assert document.pipeline.align.period == 2.0
    assert document.undo().words == ELSEWHERE
    assert path.read_bytes() == old


@pytest.mark.parametrize("broken", [b"[model", b"\xff", b"name = 1\n", None])
def test_a_broken_file_keeps_what_was_read_before(path: Path, broken: bytes | None) -> None:
    document = Document(path)
    old = path.read_bytes()
    document.put(fixed(document, "GM"), "fix GM")
    recipe, done, whole = document.pipeline, document.done, path.read_bytes()
    path.unlink() if broken is None else path.write_bytes(broken)
    with pytest.raises(PipelineError, match="quick"):
        document.reread()
    assert document.pipeline is recipe
    assert document.done is done
    path.write_bytes(whole)
    assert not document.reread()
    document.undo()
    assert path.read_bytes() == old


def test_a_linked_file_stays_one(path: Path) -> None:
    link = path.with_name("link.toml")
    link.symlink_to(path.name)
    path.chmod(0o640)
    document = Document(link)
    document.put(fixed(document, "GM"), "fix GM")
    assert link.is_symlink()
    assert path.read_bytes() == document.pipeline.content
    assert path.stat().st_mode & 0o777 == 0o640
