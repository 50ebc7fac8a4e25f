"""Forces from outside that the record knows: a tug, a tow line, a test rig."""

from trialid.ship.effect import Force, Parameter, effect


@effect(source="a measured or computed force, taken as it is", system="SI")
def outer_force(X_ext, Y_ext, K_ext, N_ext, *, scale_ext=Parameter(1.0, null=0.0)):
    """X, Y, K, N = scale_ext (X_ext, Y_ext, K_ext, N_ext): a force that was recorded."""
    return Force(X=scale_ext * X_ext, Y=scale_ext * Y_ext, K=scale_ext * K_ext, N=scale_ext * N_ext)


EFFECTS = (outer_force,)
