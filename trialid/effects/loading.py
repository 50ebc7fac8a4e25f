"""Mass, where it is, how it is spread, and the water that moves with it.

Within one trial these are constant, and mostly hide behind the linear coefficients: the score test
says how little of each is visible. Coefficients are primed.
"""

from trialid.ship.effect import Force, Mass, Parameter, effect
from trialid.ship.parameter import S175

LOADING = "loading condition; size by judgement"
SN82 = "Son & Nomoto (1982), container ship S-175: 10 % of the added mass"


@effect(source="inclining test or loading computer: 10 to 30 %")
def metacentric_height_error(
    phi,
    rho,
    g,
    nabla,
    *,
    dGM=Parameter(0.05, "m", low=-5.0, high=5.0, of_length=S175, corrects="GM"),
):
    """K = -rho g nabla dGM phi: GM is not what was stated."""
    return Force(K=-rho * g * nabla * dGM * phi)


@effect(source=LOADING)
def displacement_error(*, dm=Parameter(0.0004, low=-0.01, high=0.01, corrects="m")):
    """m = m + dm: the ship is heavier than stated."""
    return Mass(m=dm)


@effect(source=LOADING)
def gravity_centre_ahead(*, dx_G=Parameter(0.01, low=-0.1, high=0.1, corrects="x_G")):
    """x_G = x_G + dx_G: the centre of gravity lies further ahead than stated."""
    return Mass(x_G=dx_G)


@effect(source=LOADING)
def gravity_centre_lower(*, dz_G=Parameter(0.003, low=-0.05, high=0.05, corrects="z_G")):
    """z_G = z_G + dz_G: the centre of gravity lies lower than stated."""
    return Mass(z_G=dz_G)


@effect(source=LOADING)
def yaw_inertia_error(*, dI_zz=Parameter(0.00005, low=-0.001, high=0.001, corrects="I_zz")):
    """I_zz = I_zz + dI_zz (or -N_rdot): mass or turning water lies further fore and aft."""
    return Mass(I_zz=dI_zz)


@effect(source=LOADING)
def roll_inertia_error(*, dI_xx=Parameter(0.000002, low=-0.0001, high=0.0001, corrects="I_xx")):
    """I_xx = I_xx + dI_xx (or -K_pdot): mass or rolling water lies further out."""
    return Mass(I_xx=dI_xx)


@effect(source=SN82)
def sway_added_mass_error(*, dYvdot=Parameter(-0.0007, low=-0.02, high=0.02, corrects="Yvdot")):
    """Yvdot = Yvdot + dYvdot: water that moves sideways with the hull."""
    return Mass(Yvdot=dYvdot)


@effect(source=SN82)
def sway_yaw_added_mass_error(
    *, dYrdot=Parameter(-0.00004, low=-0.003, high=0.003, corrects="Yrdot")
):
    """Yrdot = Yrdot + dYrdot,  Nvdot = Nvdot + dYrdot: the water's centre lies ahead or aft."""
    return Mass(Yrdot=dYrdot, Nvdot=dYrdot)


@effect(source=SN82)
def sway_roll_added_mass_error(
    *, dKvdot=Parameter(0.00002, low=-0.003, high=0.003, corrects="Kvdot")
):
    """Kvdot = Kvdot + dKvdot,  Ypdot = Ypdot + dKvdot: the water's centre lies above or below."""
    return Mass(Kvdot=dKvdot, Ypdot=dKvdot)


EFFECTS = (
    metacentric_height_error, displacement_error, gravity_centre_ahead, gravity_centre_lower,
    yaw_inertia_error, roll_inertia_error, sway_added_mass_error, sway_yaw_added_mass_error,
    sway_roll_added_mass_error,
)  # fmt: skip
