"""When the sensors say it: delay, low-pass, a clock that drifts."""

from trialid.ship.effect import Delayed, Effect, Lagged, Parameter, effect

PRACTICE = "sensor practice: typical sizes from data sheets and sea trials"
CLOCKS = "unsynchronised loggers: 1e-5 to 1e-4; rows counted at a nominal rate: to 0.05"
"""Of 107 runs of outsiders' logs the slope of one clock that takes most off went beyond a tenth of
that, of a gyro that was 2 % fast; at half and twice of it that one comes first as well."""


@effect(source=PRACTICE)
def delay_u(*, tau_u=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """u_measured(t) = u(t - tau_u): a late speed log."""
    return Delayed(u=tau_u)


@effect(source=PRACTICE)
def delay_v(*, tau_v=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """v_measured(t) = v(t - tau_v): a late sway speed."""
    return Delayed(v=tau_v)


@effect(source=PRACTICE)
def delay_p(*, tau_p=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """p_measured(t) = p(t - tau_p): a late roll rate."""
    return Delayed(p=tau_p)


@effect(source=PRACTICE)
def delay_r(*, tau_r=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """r_measured(t) = r(t - tau_r): a late rate of turn, by filtering or by its clock."""
    return Delayed(r=tau_r)


@effect(source=PRACTICE)
def delay_phi(*, tau_phi=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """phi_measured(t) = phi(t - tau_phi): a late roll angle."""
    return Delayed(phi=tau_phi)


@effect(source=PRACTICE)
def delay_psi(*, tau_psi=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """psi_measured(t) = psi(t - tau_psi): a late heading."""
    return Delayed(psi=tau_psi)


@effect(source=PRACTICE)
def lag_u(*, T_u=Parameter(0.5, "s", low=0.0, high=20.0)):
    """T_u d(u_measured)/dt = u - u_measured: a speed log behind a low-pass."""
    return Lagged(u=T_u)


@effect(source=PRACTICE)
def lag_v(*, T_v=Parameter(0.5, "s", low=0.0, high=20.0)):
    """T_v d(v_measured)/dt = v - v_measured: a sway speed behind a low-pass."""
    return Lagged(v=T_v)


@effect(source=PRACTICE)
def lag_p(*, T_p=Parameter(0.5, "s", low=0.0, high=20.0)):
    """T_p d(p_measured)/dt = p - p_measured: a roll rate behind a low-pass."""
    return Lagged(p=T_p)


@effect(source=PRACTICE)
def lag_r(*, T_r=Parameter(0.5, "s", low=0.0, high=20.0, scan=(2.0, 5.0, 10.0))):
    """T_r d(r_measured)/dt = r - r_measured: a rate of turn behind a low-pass."""
    return Lagged(r=T_r)


@effect(source="compasses that smooth their rate of turn in two stages: 1 to 10 s each")
def lag_twice_r(*, T_rr=Parameter(0.5, "s", low=0.0, high=20.0, scan=(1.0, 3.0, 6.0))):
    """(1 + T_rr d/dt)^2 r_measured = r: a rate of turn behind two equal low-passes.

    A small T_rr is a delay of 2 T_rr, the longer the less.
    """
    return Lagged(r=T_rr), Lagged(r=T_rr)


@effect(source=PRACTICE)
def lag_phi(*, T_phi=Parameter(0.5, "s", low=0.0, high=20.0)):
    """T_phi d(phi_measured)/dt = phi - phi_measured: a roll angle behind a low-pass."""
    return Lagged(phi=T_phi)


@effect(source=PRACTICE)
def lag_psi(*, T_psi=Parameter(0.5, "s", low=0.0, high=20.0)):
    """T_psi d(psi_measured)/dt = psi - psi_measured: a heading behind a low-pass."""
    return Lagged(psi=T_psi)


@effect(source=CLOCKS)
def clock_drift_u(t, *, drift_u=Parameter(0.00005, low=-0.05, high=0.05)):
    """u_measured(t) = u(t - drift_u t): a speed log on a clock that runs fast or slow."""
    return Delayed(u=drift_u * t)


@effect(source=CLOCKS)
def clock_drift_v(t, *, drift_v=Parameter(0.00005, low=-0.05, high=0.05)):
    """v_measured(t) = v(t - drift_v t): a sway speed on a clock that runs fast or slow."""
    return Delayed(v=drift_v * t)


@effect(source=CLOCKS)
def clock_drift_p(t, *, drift_p=Parameter(0.00005, low=-0.05, high=0.05)):
    """p_measured(t) = p(t - drift_p t): a roll rate on a clock that runs fast or slow."""
    return Delayed(p=drift_p * t)


@effect(source=CLOCKS)
def clock_drift_r(t, *, drift_r=Parameter(0.00005, low=-0.05, high=0.05)):
    """r_measured(t) = r(t - drift_r t): a rate of turn on a clock that runs fast or slow."""
    return Delayed(r=drift_r * t)


@effect(source=CLOCKS)
def clock_drift_phi(t, *, drift_phi=Parameter(0.00005, low=-0.05, high=0.05)):
    """phi_measured(t) = phi(t - drift_phi t): a roll angle on a clock that runs fast or slow."""
    return Delayed(phi=drift_phi * t)


@effect(source=CLOCKS)
def clock_drift_psi(t, *, drift_psi=Parameter(0.00005, low=-0.05, high=0.05)):
    """psi_measured(t) = psi(t - drift_psi t): a heading on a clock that runs fast or slow."""
    return Delayed(psi=drift_psi * t)


EFFECTS: tuple[Effect, ...] = (
    delay_u, delay_v, delay_p, delay_r, delay_phi, delay_psi,
    lag_u, lag_v, lag_p, lag_r, lag_twice_r, lag_phi, lag_psi,
    clock_drift_u, clock_drift_v, clock_drift_p, clock_drift_r,
    clock_drift_phi, clock_drift_psi,
)  # fmt: skip
