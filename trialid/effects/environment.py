"""Wind, waves, current and shallow water."""

from trialid.maths import Number, clip, cos, sin, sqrt
from trialid.ship.effect import Force, Measured, Parameter, Steered, effect
from trialid.ship.parameter import S175

WIND = "Isherwood (1973), Blendermann (1994): shape of wind loads; size for a container ship"
BG72 = "van Berlekom & Goddard (1972), tanker in shallow water"
AGROUND = 1e-9  # of the length: a quotient stays a number where the depth is the draught
MOST_DRIFT = 0.9  # of the speed: no ship turns with more, and a search that tries one goes on
AT_REST = 1e-6  # (m/s)^2: a ship that lies still does not drift
GROUND = "uniform steady current: the ship moves with the water, and does not feel it"


@effect(source=WIND)
def steady_wind(
    psi, U0, *,
    F_N=Parameter(0.0002, low=-0.05, high=0.05), F_E=Parameter(0.0002, low=-0.05, high=0.05),
    x_wind=Parameter(0.05, low=-0.3, high=0.3, null=None),
    z_wind=Parameter(0.05, low=0.0, high=0.5, null=None),
    k_wind=Parameter(0.3, low=0.0, high=1.5, null=None),
):  # fmt: skip
    """Y = (F_E cos(psi) - F_N sin(psi)) U0^2 / U^2,  K = z_wind Y,  N = x_wind Y: wind unseen.

    A force that is steady to north and east, of wind or of wave drift, over 1/2 rho L^2 U0^2. It is
    there at rest too. From ahead it grips k_wind times as hard, X = k_wind (F_N cos(psi) +
    F_E sin(psi)) U0^2 / U^2, which a model feels that simulates u: without it two of three boats
    in wind had currents of 0.1 m/s told that were not there, and the wind from the other side.
    """
    X = (F_N * cos(psi) + F_E * sin(psi)) * U0 * U0
    Y = (F_E * cos(psi) - F_N * sin(psi)) * U0 * U0
    return Force(X=k_wind * X, Y=Y, K=z_wind * Y, N=x_wind * Y)


@effect(source=WIND)
def apparent_wind(
    V_aw, gamma_aw, *,
    C_aw=Parameter(0.00008, low=0.0, high=0.002),
    z_aw=Parameter(0.05, low=0.0, high=0.5, null=None),
):  # fmt: skip
    """Y = -C_aw V_aw^2 sin(gamma_aw),  K = z_aw Y: side force of the wind an anemometer saw.

    C_aw = rho_air / rho C_Y A / L^2 with the side area A.
    """
    Y = -C_aw * V_aw**2 * sin(gamma_aw)
    return Force(Y=Y, K=z_aw * Y)


@effect(source=WIND)
def apparent_wind_yaw(
    V_aw, gamma_aw, *,
    N_aw=Parameter(0.000004, low=-0.0003, high=0.0003),
    N_2aw=Parameter(-0.000008, low=-0.0003, high=0.0003),
):  # fmt: skip
    """N = V_aw^2 (N_aw sin(gamma_aw) + N_2aw sin(2 gamma_aw)): wind in yaw.

    N_aw is C_aw times the lever of the side area. From ahead the wind grips further forward, and
    blows the bow off: N_2aw is -0.1 C_aw or so (Blendermann 1994: 0.18 of the length a radian).
    """
    return Force(N=V_aw**2 * (N_aw * sin(gamma_aw) + N_2aw * sin(2.0 * gamma_aw)))


@effect(source=WIND)
def apparent_wind_ahead(V_aw, gamma_aw, *, C_ax=Parameter(0.00001, low=0.0, high=0.0005)):
    """X = -C_ax V_aw^2 cos(gamma_aw): resistance of the wind that was seen."""
    return Force(X=-C_ax * V_aw**2 * cos(gamma_aw))


@effect(source="Froude-Krylov moment of long waves")
def wave_slope_roll(
    alpha_w, rho, g, nabla, *, GM_w=Parameter(0.5, "m", low=0.0, high=20.0, of_length=S175)
):
    """K = rho g nabla GM_w alpha_w: she rights herself to the slope of a measured wave."""
    return Force(K=rho * g * nabla * GM_w * alpha_w)


@effect(source=GROUND)
def current_in_sway(
    psi, *,
    vc_N=Parameter(0.3, "m/s", low=-5.0, high=5.0), vc_E=Parameter(0.3, "m/s", low=-5.0, high=5.0),
):  # fmt: skip
    """v_measured = v + vc_E cos(psi) - vc_N sin(psi): v is recorded over ground, as by GNSS."""
    return Measured(v=vc_E * cos(psi) - vc_N * sin(psi))


@effect(source=GROUND)
def current_in_surge(
    psi, *,
    uc_N=Parameter(0.3, "m/s", low=-5.0, high=5.0), uc_E=Parameter(0.3, "m/s", low=-5.0, high=5.0),
):  # fmt: skip
    """u_measured = u + uc_N cos(psi) + uc_E sin(psi): u, simulated, is recorded over ground."""
    return Measured(u=uc_N * cos(psi) + uc_E * sin(psi))


@effect(source=GROUND)
def current_in_speed_record(
    psi, *,
    Uc_N=Parameter(0.3, "m/s", low=-5.0, high=5.0), Uc_E=Parameter(0.3, "m/s", low=-5.0, high=5.0),
):  # fmt: skip
    """u = u - Uc_N cos(psi) - Uc_E sin(psi): u, an input, is recorded over ground."""
    return Steered(u=-Uc_N * cos(psi) - Uc_E * sin(psi))


@effect(source="kinematics: U^2 = u^2 + v^2")
def drift_in_speed_record(u, v):
    """u = sqrt(u^2 - v^2): u, an input, is recorded over ground."""
    drift = clip(u * v / (u * u + AT_REST), MOST_DRIFT)
    return Steered(u=u * (sqrt(1.0 - drift * drift) - 1.0))


def _blockage(h: Number, T: Number) -> Number:
    """T / (h - T): zero in deep water, 1 with as much water under the keel as draught."""
    return T / (h - T + AGROUND)


@effect(source=BG72)
def shallow_water_sway(
    v,
    h,
    T,
    *,
    Yvz=Parameter(-0.013, low=-0.5, high=0.05),
    Yvavz=Parameter(-0.023, low=-1.0, high=0.1),
):
    """Y = (Yvz v + Yvavz v |v|) T / (h - T): the bottom hinders the flow under the keel."""
    return Force(Y=(Yvz * v + Yvavz * v * abs(v)) * _blockage(h, T))


@effect(source=BG72)
def shallow_water_yaw(
    v, r, h, T, *,
    Nvz=Parameter(-0.0037, low=-0.1, high=0.1), Nrz=Parameter(-0.0007, low=-0.05, high=0.01),
    Nravz=Parameter(-0.0019, low=-0.1, high=0.05),
):  # fmt: skip
    """N = (Nvz v + Nrz r + Nravz r |v|) T / (h - T): yaw moments change over a near bottom."""
    return Force(N=(Nvz * v + Nrz * r + Nravz * r * abs(v)) * _blockage(h, T))


EFFECTS = (
    steady_wind, apparent_wind, apparent_wind_yaw, apparent_wind_ahead, wave_slope_roll,
    current_in_sway, current_in_surge, current_in_speed_record, drift_in_speed_record,
    shallow_water_sway, shallow_water_yaw,
)  # fmt: skip
