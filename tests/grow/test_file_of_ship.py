"""A ship begun with the file of another is told so; by her own file she is not, whatever lacks."""

import mmg
import numpy as np
import pytest
from begun import begun

from trialid.identification.adequacy import why_no_fit
from trialid.identification.file_of_ship import left_by_file
from trialid.progress import silent
from trialid.workflow import run
from trialid.workflow.build_model import available

TRIALS = {"zz10": (10.0, 10.0), "zz20": (20.0, 20.0), "zz15": (15.0, 15.0), "turn20": (20.0,)}


def fitted(folder, seed, heading, of):
    """The linear fit of a drawn ship of another structure, begun with the file of a drawn ship."""
    file = folder / "file.toml"
    file.write_text(mmg.file_of(mmg.drawn(of)), encoding="utf-8")
    rng = np.random.default_rng([seed, 11])
    pipeline = begun(folder, mmg.drawn(seed), rng, TRIALS, heading, file)
    return run.fit_of(pipeline, run.align_trials(pipeline, silent), available(pipeline), silent)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("heading", [False, True])
def test_only_another_ships_file_is_another_ships(tmp_path, heading):
    """Of 21 m with the file of 80 m: 7.7 and 18 times the error, two coefficients clearly unlike.

    By heading the fit with the wrong file leaves half of what the one with her own does.
    """
    another, own = (fitted(tmp_path, 2008, heading, of) for of in (2010, 2008))
    assert "the ship as fitted is not the one of her file" in why_no_fit(another).reason
    assert left_by_file(own) is None


def test_sensors_do_not_make_up_for_another_hull(tmp_path):
    """Of 47 m with the file of 18 m: 4 times the error with other zeros, 30 with those fitted."""
    assert left_by_file(fitted(tmp_path, 2003, True, 2004)) > 10.0


@pytest.mark.study(turn="each")
def test_files_of_ships_of_another_length_are_noticed(tmp_path):
    """Of twenty ships, by two recorders; at least twice or half as long is another length.

    Ours: 21 of 26, and none by her own file.
    """
    noticed, far = 0, 0
    for seed in range(2060, 2080):
        lengths = mmg.drawn(seed).L / mmg.drawn(seed + 1).L
        for heading in (False, True):
            assert left_by_file(fitted(tmp_path, seed, heading, seed)) is None, seed
            if not 0.5 < lengths < 2.0:
                far += 1
                noticed += left_by_file(fitted(tmp_path, seed, heading, seed + 1)) is not None
    assert noticed >= 0.75 * far, (noticed, far)
