"""What a run shows of itself in a notebook: tables as DataFrames, the card, the pictures."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from trialid.errors import TrialidError
from trialid.identification.fit import Fit
from trialid.result.build import Findings
from trialid.result.finding_rows import VerdictPart
from trialid.result.schema import Result
from trialid.result.series import TrialSeries
from trialid.trial import Trial
from trialid.user_files import path_of
from trialid.workflow.notebook.arguments import changes_of, count_of, order_words

if TYPE_CHECKING:
    import pandas as pd

    from trialid.report.pictures.series_plot import Plot
    from trialid.workflow.use.in_memory import Draws


class RunView:
    """The tables and pictures of a finished run; they read its result, findings and series."""

    findings: Findings
    result: Result
    series: tuple[TrialSeries, ...]

    @property
    def fit(self) -> Fit:
        """The fit of the model as it is."""
        return self.findings.before.fit

    @property
    def trials(self) -> tuple[Trial, ...]:
        """The aligned trials, those to fit first."""
        return tuple(score.trial for score in self.fit.scores)

    @property
    def verdict(self) -> VerdictPart:
        """What is missing, in one word and in one sentence."""
        return self.result.verdict

    @property
    def error(self) -> float:
        """Error of all outputs over all trials to fit, as a share of the measured RMS."""
        return self.fit.eps_rmsn

    def simulate(
        self,
        *manoeuvre: str | float,
        period: float | None = None,
        what_if: Mapping[str, float] | None = None,
        without: Sequence[str] = (),
        anyway: bool = False,
        **inputs: "Sequence[float]",
    ) -> "pd.DataFrame":
        """What the fitted ship does under orders, with where each motion is likely to lie.

        Parameters
        ----------
        manoeuvre
            Its name and angles [deg]: `"zigzag", 20, 20`, `"circle", 35`; or `"stop"`.
        period, inputs
            Or orders: the time between samples [s], and inputs by name in SI, the rudder positive
            to starboard; (N,) each.
        what_if, without
            Other numbers by name: a parameter, `speed` [m/s], an input that is held [SI]; and
            effects to leave out. The words say what the record says of that.
        anyway
            Of a fit that carries no verdict, too.

        Returns
        -------
        DataFrame
            Index `t` [s]; inputs, motions and the track in SI, each motion with `_from` and `_to`;
            `attrs` holds the standard `numbers` with their ranges, and `words` to read beside them.

        Raises
        ------
        TrialidError
            There is no such manoeuvre or input, both are given, a number is none, or the fit
            carries no verdict.
        """
        from trialid.workflow.use.in_memory import simulated_frame

        words = order_words(manoeuvre, {"period": period, **inputs})
        changes = changes_of(what_if, without)
        return simulated_frame(self, words, period, inputs, what_if=changes, anyway=anyway)

    def draw(
        self,
        *manoeuvre: str | float,
        number: int = 1000,
        seed: int = 0,
        period: float | None = None,
        anyway: bool = False,
        **inputs: "Sequence[float]",
    ) -> "Draws":
        """What ships would do that the record leaves open, drawn and sailed by the kernel.

        Drawn is what the likely ranges are about: noise, what was held fixed, an effect of the
        catalogue that may be missing. Arguments beside these as of `simulate`.

        Parameters
        ----------
        number, seed
            How many ships, and what they are drawn by: the same seed, the same ships.

        Raises
        ------
        TrialidError
            There is no such manoeuvre or input, or the fit carries no verdict.
        """
        from trialid.workflow.use.in_memory import drawn_ships

        words = order_words(manoeuvre, {"period": period, **inputs})
        number, seed = count_of(number, "number", 1), count_of(seed, "seed", 0)
        return drawn_ships(self, words, period, inputs, number=number, seed=seed, anyway=anyway)

    def export(
        self,
        kind: str,
        out: str | Path | None = None,
        *,
        bandwidth: float | None = None,
        full_rudder: float | None = None,
        full_command: float | None = None,
        force: bool = False,
        anyway: bool = False,
    ) -> Path:
        """The fitted model written for other programs, as `trialid export` writes it.

        Parameters
        ----------
        kind, out
            `"ship"`, `"json"`, `"python"`, `"c"`, `"fmu"`, ...; and where, by default the run's
            name and the kind, here.
        bandwidth, full_rudder, full_command
            Of gains: how fast [rad/s], the rudder [deg] or command of a thruster at full output.
        force, anyway
            Replace what is there; of a fit that carries no verdict, too.

        Returns
        -------
        Path
            The first of the files.

        Raises
        ------
        TrialidError
            There is no such kind, a file is there, or the model is none of that kind.
        """
        from trialid.workflow.use.export_model import wishes_of
        from trialid.workflow.use.in_memory import exported_model

        wishes = wishes_of(bandwidth, full_rudder, full_command)
        place = None if out is None else path_of(out, "export")
        return exported_model(self, kind, place, wishes, force=force, anyway=anyway)

    @property
    def parameters(self) -> "pd.DataFrame":
        """The ship's parameters; the columns of `accuracy` in result.json, the name as index."""
        return _frame(self.result.physical, "name")

    @property
    def ranking(self) -> "pd.DataFrame":
        """Every effect that was tried, the likeliest first; the columns of `missing`."""
        return _frame(self.result.missing, "rank")

    @property
    def history(self) -> "pd.DataFrame":
        """The steps of the model; the columns of `history`."""
        return _frame(self.result.history, None)

    def compare(self, other: "RunView") -> "pd.DataFrame":
        """Another run and this one side by side: errors, parameters and how far they lie apart.

        Columns `other`, `this`, and `apart` in joint standard errors (None for errors).

        Raises
        ------
        TrialidError
            `other` is no run: a finished run's folder is none.
        """
        import pandas as pd

        from trialid.report.pages.side_by_side import joint_distance

        if not isinstance(other, RunView):
            raise TrialidError(
                f"compare: expected another run, as ti.run and ti.diagnose give, got {other!r}"
            )
        rows: dict[str, tuple[Any, Any, float | None]] = {}
        for name, of in _ERRORS.items():
            rows[name] = (of(other.result), of(self.result), None)
        old = {row.name: row for row in other.result.physical}
        new = {row.name: row for row in self.result.physical}
        for name in dict.fromkeys([*old, *new]):
            both = [rows_by.get(name) for rows_by in (old, new)]
            values = [(r.value, r.standard_error) if r else (None, None) for r in both]
            rows[name] = (values[0][0], values[1][0], joint_distance(values))
        return pd.DataFrame.from_dict(rows, orient="index", columns=["other", "this", "apart"])

    def plot(self, output: str) -> "Plot":
        """Measured and predicted of an output in every trial, with the residual.

        Raises
        ------
        TrialidError
            The output is not compared in this run.
        """
        from trialid.report.pictures.series_plot import plot

        return plot(self.series, str(output))

    def __repr__(self) -> str:
        kind, sentence = self.verdict.kind, self.verdict.sentence or ""
        return f"{self.result.pipeline}: error {self.error:.2%}; {kind}: {sentence}"

    def _repr_html_(self) -> str:
        from trialid.report.pages.card import card

        return card(self.result)


_ERRORS: Final[Mapping[str, Callable[[Result], float | None]]] = {
    "error, fitted": lambda result: result.fit.eps_rmsn,
    "error, held out": lambda result: result.fit.eps_rmsn_check,
    "noise part": lambda result: result.split.noise,
    "model part": lambda result: result.split.undermodelling,
}


def _frame(rows: tuple[Any, ...], index: str | None) -> "pd.DataFrame":
    """Rows of a result as a table."""
    import pandas as pd

    frame = pd.DataFrame([asdict(row) for row in rows])
    return frame.set_index(index) if index and len(frame) else frame
