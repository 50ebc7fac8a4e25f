"""Real records beside the repository, and pipelines varied without writing them anew."""

from pathlib import Path

from trialid.diagnosis.found_values import of_the_ship
from trialid.effects import CATALOGUE
from trialid.pipeline_file import Pipeline, load
from trialid.workflow import grow

HERE = Path(__file__).parent
DATA = HERE.parents[2] / "shared" / "data"


def with_effects(recipe: Pipeline, effects, free) -> Pipeline:
    """The pipeline with more effects, and their parameters free."""
    model = recipe.model.model_copy(update={"effects": (*recipe.model.effects, *effects)})
    identify = recipe.identify.model_copy(update={"free": (*recipe.identify.free, *free)})
    return recipe.model_copy(update={"model": model, "identify": identify})


def with_candidates(recipe: Pipeline, candidates, period=None) -> Pipeline:
    """The pipeline with a search for the missing effect, on a coarser clock if one is given."""
    changes = {"diagnose": recipe.diagnose.model_copy(update={"candidates": candidates})}
    if period is not None:
        changes["align"] = recipe.align.model_copy(update={"period": period})
    return recipe.model_copy(update=changes)


def stages(pipeline: Path, changes) -> list[grow.Stage]:
    """What the loop does with a pipeline file whose words are changed; printed as it goes."""
    text = pipeline.read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    pipeline.write_text(text, encoding="utf-8")
    done = []
    for stage in grow.stages(load(pipeline), lambda words, share: None):
        done.append(stage)
        fit, verdict = stage.run.result.fit, stage.run.result.verdict
        check = fit.eps_rmsn_check
        held_out = "" if check is None else f", held out {check:.2%}"
        kept = "" if stage.kept else " not kept:"
        print(f"{stage.added}:{kept} {fit.eps_rmsn:.2%}{held_out}; {verdict.sentence}")
    return done


def added(done) -> list[str]:
    """The effects that were added and stayed."""
    return [str(stage.added) for stage in done[1:] if stage.kept]


def of_a_clock(name: str) -> bool:
    """Whether an effect is of a sensor or its clock."""
    return name.startswith(("lag_", "delay_", "clock_", "bias_", "scale_"))


def moves_the_ship(name: str) -> bool:
    """Whether an effect is of the ship; a coefficient that is held fixed, and freed, is."""
    return name not in CATALOGUE or of_the_ship(CATALOGUE[name])
