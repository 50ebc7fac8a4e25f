"""A drawn ship as a newcomer begins with her: logs, and the pipeline that `start` writes."""

import mmg

from trialid import pipeline_file
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter


def begun(folder, ship, rng, manoeuvres, heading=False, file=None, write=mmg.write_log):
    """The pipeline of a log of each of the manoeuvres, by name; one is held out.

    Without a ship's file she is begun by her dimensions.
    """
    for name, manoeuvre in manoeuvres.items():
        write(folder / f"{name}.csv", ship, rng, *manoeuvre, heading=heading)
    logs = [inspect_log(folder / f"{name}.csv") for name in manoeuvres]
    given = Given(length=ship.L, beam=ship.B, draught=ship.d, block=ship.block)
    made = starter(logs, folder / "begun.toml", file, Given() if file else given)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return pipeline_file.load(folder / "begun.toml")
