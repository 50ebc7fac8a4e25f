"""Real records beside the repository, and pipelines varied without writing them anew."""

from pathlib import Path

from trialid.recipe import Recipe

HERE = Path(__file__).parent
DATA = HERE.parents[2] / "shared" / "data"


def with_effects(recipe: Recipe, effects, free) -> Recipe:
    """The pipeline with more effects, and their parameters free."""
    model = recipe.model.model_copy(update={"effects": (*recipe.model.effects, *effects)})
    identify = recipe.identify.model_copy(update={"free": (*recipe.identify.free, *free)})
    return recipe.model_copy(update={"model": model, "identify": identify})


def with_candidates(recipe: Recipe, candidates, period=None) -> Recipe:
    """The pipeline with a search for the missing effect, on a coarser clock if one is given."""
    changes = {"diagnose": recipe.diagnose.model_copy(update={"candidates": candidates})}
    if period is not None:
        changes["align"] = recipe.align.model_copy(update={"period": period})
    return recipe.model_copy(update=changes)
