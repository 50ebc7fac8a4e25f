"""What to do next, by the verdict: commands that exist, trials and lines the record calls for."""

import shlex
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from trialid.names import wording
from trialid.names.quantities import MOTIONS
from trialid.report.words import doubt
from trialid.result.schema import Result
from trialid.toml_text import quote

RIVALS: Final = 2
"""Other members of the family whose command is written out."""

STATED: Final = "stated sensor figure"
AS_STATED: Final = "as stated in [diagnose] noise: not typical, "
"""Begins why a figure that is stated is not used."""
STEADY: Final = "quiet stretch"
LONGER: Final = "record a longer steady course in the same sea: what there is of it is too short"
OPENS: Final = {
    "repeated manoeuvre": "run one manoeuvre twice, with the same orders",
    "periods of a periodic test": "run a test whose orders repeat themselves several times",
    STEADY: "record a minute or more of steady course, nothing ordered, in the same sea",
    STATED: "state how much each sensor scatters, as noise under [diagnose]",
}
"""What would open a route to the noise that this record does not have; of a ship that nothing
drives, as in a roll decay, only the last is one."""

FOLLOWS: Final = 0.1
"""Share of an output's squared error coherent with the rudder from which on it is no noise, said
beside a verdict that nothing is missing: of an outsider's yacht it was 0.25, in a heading known to
0.1 deg, under a heel whose gusts hid it. Half and twice say the same of it."""

FEWEST_COMPARED: Final = 3
"""Trials from which on whole models are compared: two that are fitted and one left out."""

EACH: Final = ("This", "Any one of these")


@dataclass(frozen=True)
class Advice:
    """One thing to do: what and why, and the command or the line of the pipeline file for it."""

    words: str
    command: str = ""


def advice(run: Result) -> tuple[Advice, ...]:
    """What to do next, most urgent first."""
    kind = run.verdict.kind
    by_kind = {
        "missing": _missing,
        "nothing missing": _nothing,
        "not in catalogue": _outside,
        "cannot tell": _unclear,
        "no fit": _no_fit,
    }
    found = [*_doubted(run), *_unfinished(run), *_planned(run)]
    if kind in by_kind:
        found += by_kind[kind](run)
    return (*found, *_unchecked(run), *_loose(run))


def first_step(run: Result) -> Advice | None:
    """What to do first, beside the next trial: that has a line of its own wherever this has."""
    planned = [*_planned(run)]
    return next((each for each in advice(run) if each not in planned), None)


def command(run: Result, verb: str, *words: str) -> str:
    """A command of trialid on this run's pipeline.

    >>> command(Result(file="my trial.toml"), "add", "static_list")
    "trialid add 'my trial.toml' static_list"
    """
    return command_on(run.file or "PIPELINE", verb, *words)


def command_on(file: str, verb: str, *words: str) -> str:
    """A command of trialid on a pipeline file.

    >>> command_on("pipelines/a.toml", "drop", "static_list")
    'trialid drop pipelines/a.toml static_list'
    """
    return shlex.join(["trialid", verb, file, *words])


def _unfinished(run: Result) -> Iterable[Advice]:
    if run.fit.converged is False and run.verdict.kind != "no fit":
        yield Advice(
            "The fit did not converge: rely on nothing here before it does. Start the search from "
            "several places, under [identify]:",
            "starts = 5",
        )


def _doubted(run: Result) -> Iterable[Advice]:
    """What the records contradict comes first: every number rests on it."""
    if run.verdict.doubts:
        yield Advice("Settle that in the pipeline file, or ask who was aboard, and run again.")


def _no_fit(run: Result) -> Iterable[Advice]:
    said = (run.verdict.sentence or "").removeprefix("no fit: ").rpartition("; ")[2]
    yield Advice(
        f"Rely on no number of this run. {said[:1].upper()}{said[1:]}."
        if said
        else "Rely on no number of this run."
    )


def _planned(run: Result) -> Iterable[Advice]:
    if (following := run.verdict.next_trial) and following.sentence:
        begun = "Run this trial next" if following.test else following.heading
        yield Advice(f"{begun}: {following.sentence.rstrip('.')}.")


def _missing(run: Result) -> Iterable[Advice]:
    effect = run.verdict.effect
    if not effect:
        return
    held = any(row.effect == effect and row.held is not None for row in run.missing)
    todo = "Free the coefficient in" if held else "Put the effect into"
    yield Advice(
        f"{todo} the pipeline and fit again; the report then shows before and after. "
        "What is added, trialid drop takes out again.",
        command(run, "add", effect),
    )
    if not held:
        yield Advice(
            "Read what it stands for, and whether your ship can have it:",
            shlex.join(["trialid", "effects", effect]),
        )
    others = [name for name in run.verdict.family if name != effect]
    for name in others[:RIVALS]:
        yield Advice(
            f"This record cannot tell it from {name}. If that is the likelier one on this ship:",
            command(run, "add", name),
        )
    yield Advice(
        "Or let it add effect after effect until none is named; the file stays as it is:",
        command(run, "run", "--auto"),
    )
    yield from _most_stays(run, effect)


def _most_stays(run: Result, effect: str) -> Iterable[Advice]:
    """Where it leaves more than half of what is not noise: what is missing is more than one."""
    if (row := next((row for row in run.missing if row.effect == effect), None)) is None:
        return
    held_out = row.eps_rmsn_check is not None
    before = run.fit.eps_rmsn_check if held_out else run.fit.eps_rmsn
    after = row.eps_rmsn_check if held_out else row.eps_rmsn_refitted
    if before is None or after is None or len(run.trials) < FEWEST_COMPARED:
        return
    so = f"so {'' if run.split.noise else 'that is noise, or '}more than it is missing"
    noise = (run.split.noise or 0.0) ** 2
    if after**2 - noise > 0.5 * (before**2 - noise):
        where = "where it was not fitted" if held_out else "of the fitted trials"
        yield Advice(
            f"{effect} leaves most of the error {where}, {wording.percent(after)} of "
            f"{wording.percent(before)}, {so}. Compare whole models, each fitted anew with every "
            "trial left out in turn:",
            command(run, "structures"),
        )


def _nothing(run: Result) -> Iterable[Advice]:
    ends = run.split.ends("undermodelling")
    limit = f" A model error of up to {wording.percent(ends[1])} would not be seen." if ends else ""
    for said in what_follows(run):
        yield Advice(
            f"Do not take what is left for noise: {said}. It is small, or no effect that was tried "
            "has its shape; a trial that moves her more tells."
        )
    use = "Use the model within the orders, speeds and heel that the trials cover; no"
    if not any(trial.use == "check" for trial in run.trials):
        use = "Hold a trial out before you use the model: what was fitted does not test it. No"
    yield Advice(f"{use} effect is to be added on the strength of this record.{limit}")


def what_follows(run: Result) -> list[str]:
    """Outputs of which what is left follows the rudder, in the sentences that say so."""
    return [
        row.sentence.rstrip(".")
        for row in run.where
        if row.finding == "frequency" and (row.share or 0.0) > FOLLOWS and row.sentence
    ]


def _outside(run: Result) -> Iterable[Advice]:
    if len(run.trials) >= FEWEST_COMPARED:
        yield Advice(
            "What was built up effect by effect may end where another hull does not. Compare whole "
            "models, each fitted anew with every trial left out in turn:",
            command(run, "structures"),
        )
    first = next((row.sentence for row in run.where if row.sentence), None)
    if first is not None:
        yield Advice(f"Look where the model fails first: {first.rstrip('.')}.")
    force = run.missing_force
    if force is not None and force.equations and not force.possible:
        yield Advice(
            f"No force can be drafted of this record: {force.sentence}. A trial that moves her "
            "more, or a motion that is simulated too, may show one."
        )
        return
    yield Advice(
        "Have the force that is missing written down as an effect in a Python file, and edit it:",
        shlex.join(["trialid", "run", "--draft", "my_effect.py", run.file or "PIPELINE"]),
    )
    yield Advice(
        "Name that file, or one you wrote yourself, under [model]; its effects are then tried "
        "beside the catalogue:",
        'effects_from = ["my_effect.py"]',
    )


def _unclear(run: Result) -> Iterable[Advice]:
    if run.verdict.together:
        several = wording.named_together(run.verdict.together)
        yield Advice(
            f"Let it add {several} at once, and what follows; the file stays as it is:",
            command(run, "run", "--auto"),
        )
        return
    if held := run.verdict.held_as_well:
        yield Advice(
            f"Add {wording.count_of(len(held), 'number')} to [identify] free, about her file "
            'by priors = "ship", and run again; with these priors `trialid run --auto` does so, '
            "and keeps what raises no held-out error:",
            ", ".join(map(quote, held)),
        )
        return
    yield from _one_of(run)
    if run.split.noise is not None:
        yield Advice(
            "The record itself leaves it open. What settles it is a trial in which the effect does "
            "something that the free parameters cannot do as well, or parameters known from a "
            "model test, held fixed or given as priors."
        )
        return
    whys = [row.why or "" for row in run.split.routes]
    if refused := [why.removeprefix(AS_STATED) for why in whys if why.startswith(AS_STATED)]:
        yield Advice(
            f"The noise that is stated is not used, {refused[0]}: "
            "state what is left of it in the samples of [align], which are means of what a sensor "
            "gives in their period."
        )
        return
    if ways := _ways(run):
        opens = f"{EACH[len(ways) > 1]} opens a way: {'; '.join(ways)}."
        yield Advice(f"Noise and model error cannot be told apart. {opens}")


def _ways(run: Result) -> list[str]:
    """What would open a route to the noise that is closed."""
    closed = {row.method: row.why or "" for row in run.split.routes if not row.available}
    driven = not run.signals or not MOTIONS.issuperset(row.signal for row in run.signals)
    ways = OPENS | ({STEADY: LONGER} if wording.TOO_SHORT in closed.get(STEADY, "") else {})
    return [w for method, w in ways.items() if method in closed and (driven or method == STATED)]


def _one_of(run: Result) -> Iterable[Advice]:
    """Those of which one is missing: each may be tried."""
    for name in run.verdict.family[: 1 + RIVALS]:
        yield Advice(
            f"It may be {name}. To see what it does, on trials that were not fitted, too:",
            command(run, "add", name),
        )


def _unchecked(run: Result) -> Iterable[Advice]:
    trials = run.trials
    if not trials or any(trial.use == "check" for trial in trials):
        return
    words = "No trial was held out, so nothing here was tested on data that the fit had not seen. "
    if len(trials) > 1:
        words += "Hold one back, in its [[trial]]:"
    else:
        words += "Add a second trial to the pipeline and hold it back, in its [[trial]]:"
    yield Advice(words, 'use = "check"')


def _loose(run: Result) -> Iterable[Advice]:
    said = doubt.doubtful(run.accuracy.parameters)
    if said and run.verdict.kind in ("nothing missing", "cannot tell"):
        yield Advice(
            f"{said} Do not use such a parameter by itself; together they still predict what the "
            "trials show."
        )
    for weak in run.accuracy.weak:
        if len(weak.parameters) > 1:
            yield Advice(
                f"To part {' from '.join(map(str, weak.parameters[:2]))}: a trial in which they "
                "act differently, such as larger or smaller orders or another rhythm of them; "
                "more of the same shrinks only the noise."
            )
