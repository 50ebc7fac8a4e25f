"""What the propeller does besides pushing: speed, race, side force."""

from trialid.ship.effect import Force, Parameter, Rate, Steered, effect

SN82 = "Son & Nomoto (1982), container ship S-175"
STANDSTILL = 1e-12  # (m/s)^2: quotients keep their limit for a ship without approach speed


@effect(source=SN82)
def rudder_slipstream(
    u, delta, U0, *,
    N_slip=Parameter(0.0015, low=0.0, high=0.03),
    z_slip=Parameter(0.03, low=0.0, high=0.2, null=None),
):  # fmt: skip
    """N = N_slip delta u (U0 - u) / U^2,  Y = -2 N,  K = 2 z_slip N: the race feeds the rudder.

    At constant shaft speed the flow over a rudder aft, x = -L/2, falls less than the ship's speed;
    with N_slip = Ndelta the force goes as u U0.
    """
    N = N_slip * delta * u * (U0 - u)
    return Force(Y=-2.0 * N, K=2.0 * z_slip * N, N=N)


@effect(
    source=SN82 + ": 10 % of speed lost at 5 deg of rudder, 55 % at 35 deg", states={"u_lost": None}
)
def surge_loss(
    u, r, u_lost, L, *,
    k_lost=Parameter(5.0, low=0.0, high=50.0),
    tau_lost=Parameter(10.0, low=1.0, high=100.0, null=None),
):  # fmt: skip
    """u = u - u_lost,  d(u_lost)/dt = (k_lost (r L)^2 - u u_lost) / (tau_lost L): speed loss.

    In turns, for a record without speed; with u simulated, surge_resistance and surge_turning say
    the same.
    """
    return Steered(u=-u_lost), Rate(u_lost=(k_lost * (r * L) ** 2 - u * u_lost) / (tau_lost * L))


@effect(source="diesel at constant fuel: van Berlekom & Goddard (1972), tanker")
def shaft_speed_drop(n, u, U0, *, k_n=Parameter(0.2, low=0.0, high=1.5)):
    """n = n + k_n n (u / U0 - 1), n as ordered: the shaft slows down with the ship."""
    return Steered(n=k_n * n * (u - U0) * U0 / (U0 * U0 + STANDSTILL))


@effect(source="thrust and torque as lines of J: Son & Nomoto (1982), S-175, at its J of 0.79")
def propeller_unrecorded(
    u,
    U0,
    *,
    X_P0=Parameter(0.0004, low=0.0, high=0.01, null=None),
    k_P=Parameter(2.1, low=0.0, high=6.0, null=None),
):
    """X = X_P0 U0 (U0 + k_P (U0 - u)): thrust where nobody recorded the shaft.

    On a course X_P0 is -Xuu. k_P is 2.1 where the revolutions stay, 0.6 where the power does, 0.2
    where the torque does; at half the speed the line is off by 0, 0.5 and 1.6 %. In hard turns the
    record tells which it was.
    """
    return Force(X=X_P0 * U0 * (U0 + k_P * (U0 - u)))


@effect(source="bilinear in shaft speed and speed of advance: Blanke (1981)")
def shaft_thrust(
    u,
    n,
    *,
    X_nn=Parameter(4e-8, low=0.0, high=1e-6),
    X_un=Parameter(-5e-6, low=-1e-4, high=0.0),
):
    """X = (X_nn n + X_un u) n with the shaft ahead: thrust as the shaft turns.

    Beside a thrust that knows one shaft speed, as propeller_unrecorded, or instead of it; what
    propeller_thrust says by the numbers of the screw, where nobody has them.
    """
    ahead = 0.5 * (n + abs(n))
    return Force(X=(X_nn * ahead + X_un * u) * ahead)


@effect(source="wheel effect of a single screw; right-handed ahead: bow to port; size by judgement")
def propeller_side_force(n, *, N_n=Parameter(-1e-9, low=-2e-8, high=2e-8)):
    """N = N_n n^2,  Y = -2 N: a turning screw, aft, also pushes sideways."""
    N = N_n * n * n
    return Force(Y=-2.0 * N, N=N)


@effect(source="B-screws in four quadrants: 20 to 40 % less astern; right-handed: bow to starboard")
def propeller_astern(
    n, *, X_ast=Parameter(2e-9, low=-5e-8, high=5e-8), N_ast=Parameter(4e-10, low=-1e-8, high=1e-8)
):
    """X = X_ast n^2,  N = N_ast n^2,  Y = -2 N where n < 0: less thrust than ahead, and a race.

    On top of propeller_thrust, which has as much astern; the race astern pushes the stern sideways.
    """
    back = 0.5 * (n - abs(n))
    N = N_ast * back * back
    return Force(X=X_ast * back * back, Y=-2.0 * N, N=N)


@effect(source="Fossen (1994), Guidance and Control of Ocean Vehicles: bilinear thrust, |n| u")
def propeller_astern_advance(u, n, *, X_ast_u=Parameter(-5e-6, low=-1e-4, high=0.0)):
    """X = X_ast_u u |n| where n < 0: a screw astern brakes the more, the more way she has.

    Where a crash stop is fitted without it the hull's resistance stands in, and with the engine
    stopped she then seems to lose her speed in half of the time.
    """
    return Force(X=-0.5 * X_ast_u * u * (n - abs(n)))


@effect(source="thrust of two shafts at some distance from the middle; size by judgement")
def twin_screws(n_p, n_s, *, N_twin=Parameter(2e-10, low=0.0, high=1e-8)):
    """N = N_twin (n_p |n_p| - n_s |n_s|): two screws that do not turn alike."""
    return Force(N=N_twin * (n_p * abs(n_p) - n_s * abs(n_s)))


EFFECTS = (
    rudder_slipstream,
    surge_loss,
    shaft_speed_drop,
    propeller_unrecorded,
    shaft_thrust,
    propeller_side_force,
    propeller_astern,
    propeller_astern_advance,
    twin_screws,
)
