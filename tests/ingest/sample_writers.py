"""The writers of the sample logs."""

from trialid.sample import log_writers as write_logs

__all__ = ["imu", "write_logs"]

MOTIONS = ("roll", "pitch", "yaw", "roll_rate", "pitch_rate", "yaw_rate")


def imu(t, *motions):
    """An inertial unit's samples; the motions in the order of `MOTIONS`."""
    return write_logs.Imu(t=t, **dict(zip(MOTIONS, motions, strict=True)))
