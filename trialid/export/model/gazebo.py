"""A fitted hull as Gazebo takes it: an SDF with the Hydrodynamics plugin, and what that costs.

gz-sim 7 or later (src/systems/hydrodynamics): force = sum of coefficient times velocity, of
coefficient times |velocity| velocity, and of added mass times acceleration, in axes forward, to
port, up, signs as SNAME's derivatives; Coriolis forces of added mass are in the fitted terms, so
that the plugin's own are switched off.
"""

import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from trialid.design.following import steady_inputs
from trialid.design.hull_terms import KEPT, ROWS, HullTerms, Term, hull_terms, in_hull_terms
from trialid.export.model.fitted_model import FittedModel
from trialid.identification.fit import Fit
from trialid.identification.trial_score import of_trial
from trialid.names import labels
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.model import ShipModel
from trialid.ship.prime import mass_scale
from trialid.simulation.integrate import prepare, respond

WIDE: Final = 96
TURNED: Final = {"u": 1.0, "v": -1.0, "p": 1.0, "r": -1.0, "X": 1.0, "Y": -1.0, "K": 1.0, "N": -1.0}
"""Signs from axes forward, to starboard, down to forward, to port, up."""
LEAST: Final = 1e-12


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Error of an output over the fitted trials, as a share of its RMS: whole model, and terms."""

    output: str
    model: float
    terms: float


@dataclass(frozen=True, kw_only=True)
class GazeboHull:
    """The hull's terms, added masses by pairs of motions [SI], and what they cost."""

    terms: HullTerms
    mass: Mapping[str, float]
    added: Mapping[tuple[str, str], float]
    costs: tuple[Cost, ...]


def gazebo_hull(fit: Fit, made: FittedModel) -> GazeboHull:
    """What Gazebo can have of a fitted ship, the loss measured on the trials of the fit."""
    model = fit.model
    terms = hull_terms(model, made.seen, steady_inputs(fit))
    L, rho = (model.ship.particulars[n] for n in ("L", "rho"))
    mass = {n: model.value(n) * mass_scale(n, L, rho) for n in MASS_PARAMETERS}
    return GazeboHull(terms=terms, mass=mass, added=_added(mass), costs=_costs(fit, terms))


def _added(mass: Mapping[str, float]) -> dict[tuple[str, str], float]:
    """Derivatives of force by acceleration, as Yvdot, by force and motion."""
    added = {n: x for n, x in mass.items() if n.endswith("dot")}
    return {(n[0], n[1]): x for n, x in added.items() if x}


def _costs(fit: Fit, terms: HullTerms) -> tuple[Cost, ...]:
    """Errors of both on the fitted trials, each with its own start and sensors."""
    whole = fit.problem.simulator
    reduced = in_hull_terms(_with_fitted(fit, whole.model), terms)
    free = [n for n in whole.equations.free if n in reduced.parameters]
    simulator = prepare(reduced, free, whole.outputs, substeps=whole.substeps)
    outputs = whole.outputs
    squares = np.zeros((3, len(outputs)))
    for score in (s for s in fit.scores if s.trial.use == "fit"):
        values, start = of_trial(fit, score.trial)
        known = {n: values[n] for n in free}
        response = respond(simulator, score.trial, known, start, sensitivities=False)
        for c, name in enumerate(outputs):
            here = score.compared[:, c]
            measured = score.trial.signals[name][here]
            squares[0, c] += np.sum((score.response.y[here, c] - measured) ** 2)
            squares[1, c] += np.sum((response.y[here, c] - measured) ** 2)
            squares[2, c] += np.sum(measured**2)
    shares = np.sqrt(squares[:2] / np.maximum(squares[2], LEAST))
    return tuple(
        Cost(output=n, model=float(shares[0, c]), terms=float(shares[1, c]))
        for c, n in enumerate(outputs)
    )


def _with_fitted(fit: Fit, model: ShipModel) -> ShipModel:
    """A model of the fit's problem, sensors and all, with the fitted values."""
    known = {n: x for n, x in fit.model.values.items() if n in model.parameters}
    return model.with_values(known)


def gazebo_text(made: FittedModel, hull: GazeboHull) -> str:
    """The SDF file."""
    lines = ['<?xml version="1.0"?>', "<!--", *_words(made, hull), "-->", '<sdf version="1.9">']
    m = hull.mass
    lines += [
        f"  <model name={quoteattr(made.name)}>",
        '    <link name="base_link">',
        "      <inertial>",
        f"        <pose>{m['x_G']:.6g} 0 {-m['z_G']:.6g} 0 0 0</pose>",
        f"        <mass>{m['m']:.8g}</mass>",
        f"        <inertia><ixx>{_about(m, 'I_xx', 'z_G'):.8g}</ixx>"
        f"<iyy>{_about(m, 'I_zz', 'x_G'):.8g}</iyy><izz>{_about(m, 'I_zz', 'x_G'):.8g}</izz>"
        "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>",
        "      </inertial>",
        "    </link>",
        '    <plugin filename="gz-sim-hydrodynamics-system" '
        'name="gz::sim::systems::Hydrodynamics">',
        "      <link_name>base_link</link_name>",
        f"      <water_density>{made.model.ship.particulars['rho']:.6g}</water_density>",
        "      <disable_coriolis>true</disable_coriolis>",
        *(f"      <{name}>{value:.10g}</{name}>" for name, value in plugin_values(hull).items()),
        "    </plugin>",
        "  </model>",
        "</sdf>",
    ]
    return "\n".join(lines) + "\n"


def _about(mass: Mapping[str, float], inertia: str, arm: str) -> float:
    """A moment of inertia about the centre of gravity."""
    return mass[inertia] - mass["m"] * mass[arm] ** 2


def plugin_values(hull: GazeboHull) -> dict[str, float]:
    """The plugin's parameters by name, in Gazebo's axes."""
    found = {}
    for row, by in hull.terms.values.items():
        for term, value in by.items():
            found[_name(row, term)] = value * _sign(row, term)
    for (row, motion), value in hull.added.items():
        if ROWS[row][0] in hull_states(hull) and motion in hull_states(hull):
            name = f"{row.lower()}Dot{motion.upper()}"
            found[name] = value * TURNED[row] * TURNED[motion]
    return found


def hull_states(hull: GazeboHull) -> frozenset[str]:
    """Motions that the hull's forces drive."""
    return frozenset(ROWS[row][0] for row, by in hull.terms.values.items() if by)


def _name(row: str, term: Term) -> str:
    """As the plugin reads it: the velocity, then the one whose size multiplies it."""
    first, second, by_size = term
    if not first:
        return f"{row.lower()}{second.upper()}"
    return f"{row.lower()}{second.upper()}{'abs' if by_size else ''}{first.upper()}"


def _sign(row: str, term: Term) -> float:
    first, second, by_size = term
    own = 1.0 if by_size or not first else TURNED[first]
    return TURNED[row] * TURNED[second] * own


def _words(made: FittedModel, hull: GazeboHull) -> Iterator[str]:
    """Where it comes from, what was left out, what that costs, what is still to be done."""
    said = [f"{made.name}: the hull that a run of trialid fitted, for Gazebo's Hydrodynamics."]
    said += [f"{key.replace('_', ' ')}: {words}" for key, words in made.origin.items()]
    said += [f"NOTE {words}" for words in made.words]
    said += [*left_out_words(hull.terms), *(cost_words(c) for c in hull.costs)]
    missing = [s for s in ("u", "v", "p", "r") if s not in made.model.states]
    if missing:
        listed = ", ".join(labels.label(s) for s in missing)
        said.append(f"NOTE Not in the model, to be added by hand: resistance to {listed}.")
    said.append(
        "NOTE Heave and pitch are in no model of trialid; iyy is that of yaw. The righting moment "
        "is the buoyancy plugin's: give it a hull with the GM of the model. Heave, pitch and the "
        "list below are to be given beside it."
    )
    if -hull.added.get(("Y", "v"), 0.0) > hull.mass["m"]:
        said.append("NOTE Added mass above the ship's own may make the plugin unstable.")
    for words in said:
        clean = escape(" ".join(words.split())).replace("--", "- -")
        yield from textwrap.wrap(
            clean, WIDE, initial_indent="  ", subsequent_indent="    ", break_on_hyphens=False
        )


def left_out_words(terms: HullTerms) -> Iterator[str]:
    """What the terms do not hold, a sentence each."""
    partly = {n: x for n, x in terms.left_out.items() if x > KEPT}
    if partly:
        listed = ", ".join(f"{n} ({x:.0%} of its force)" for n, x in partly.items())
        yield f"Left out for want of a term: {listed}."
    if terms.heeled:
        yield f"Left out, what goes by heel: {', '.join(terms.heeled)}."
    if terms.elsewhere:
        yield f"Not of the hull, to be given by other plugins: {', '.join(terms.elsewhere)}."


def cost_words(cost: Cost) -> str:
    """What leaving out costs on the trials, in a sentence."""
    return (
        f"COST {cost.output}: error on the fitted trials {cost.terms:.2%} with these terms, "
        f"{cost.model:.2%} with the whole model (rudder and everything else as in the model)."
    )
