"""Which quantities the signals of a pipeline are: the dictionary's, an actuator's, one's own."""

from collections.abc import Iterator, Mapping

from trialid.errors import EffectError, PipelineError, UnitError
from trialid.names import units
from trialid.names.quantities import Quantity
from trialid.pipeline_file import Pipeline, signal_key, where
from trialid.pipeline_file.contradictions import nearest_signal
from trialid.pipeline_file.own_quantities import ship_quantities
from trialid.ship.effect import Effect
from trialid.workflow.build_model import available


def quantities_of(pipeline: Pipeline) -> Mapping[str, Quantity]:
    """Every quantity that the pipeline's signals may be, by name.

    Raises
    ------
    PipelineError
        A signal is none, and no effect reads it.
    """
    known = dict(ship_quantities(pipeline))
    if not pipeline.model.effects_from:
        return known
    for effect in available(pipeline).values():
        known |= {q.name: q for q in _own(effect, known)}
    for trial in pipeline.trials:
        for name, source in trial.signals.items():
            place = where(pipeline, signal_key(pipeline, trial, name))
            if name not in known:
                raise PipelineError(
                    f"{place}: unknown quantity, and no effect reads it as "
                    f"{name}=Signal(...); {nearest_signal(name, known)}"
                )
            try:
                units.factor(source.unit or known[name].unit, known[name].unit)
            except UnitError as error:
                raise UnitError(f"{place}.unit: {error}") from error
    return known


def _own(effect: Effect, known: Mapping[str, Quantity]) -> Iterator[Quantity]:
    """Signals of its own that one of the user's effects reads."""
    for name, signal in effect.own.items():
        if name in known and known[name].unit != signal.unit:
            raise EffectError(
                f"{effect.place} reads {name} in {signal.unit!r}, and it is known in "
                f"{known[name].unit!r}; write Signal({known[name].unit!r})"
            )
        try:
            units.factor(signal.unit, signal.unit)
        except UnitError as error:
            raise EffectError(f"{effect.place}: signal {name}: {error}") from error
        words = f"read by {effect.name}"
        yield Quantity(name, name, signal.unit, signal.unit, words)
