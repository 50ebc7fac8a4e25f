"""What a terminal says of how far numbers can be trusted stands on the screen as well."""

from dataclasses import replace
from pathlib import Path

from turn import WITH_CHECK, turned, write_folder

from trialid.report.words.doubt import doubtful, records_doubt
from trialid.workbench import screen
from trialid.workbench.shown import Shown


def model_part(shown: Shown, **changed: object) -> str:
    """What stands above the parameters, with the result changed so."""
    assert shown.run is not None
    result = replace(shown.run.result, **changed)  # type: ignore[arg-type]
    return screen.parts(replace(shown, run=replace(shown.run, result=result)))["model"]


def test_what_a_terminal_says_of_the_parameters_is_on_the_screen(tmp_path: Path) -> None:
    """Of a boat whose gear was 0.9 s late it was `Nothing is missing`, and no word more."""
    turn = turned(write_folder(tmp_path, WITH_CHECK))
    assert turn.after.run is not None
    result = turn.after.run.result
    rows = tuple(replace(row, likely=(-9.0, 9.0)) for row in result.accuracy.parameters)
    doubts = replace(result.verdict, doubts=("r comes late",))
    late = "r is taken as 0.31 s late in all trials"
    html = model_part(
        turn.after,
        accuracy=replace(result.accuracy, parameters=rows),
        fit=replace(result.fit, remarks=(late,)),
        verdict=doubts,
    )
    for said in (doubtful(rows), late, records_doubt(doubts)):
        assert said
        assert said in html
    assert late not in model_part(turn.after)
