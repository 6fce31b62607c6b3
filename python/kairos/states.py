"""Bodies at one or several instants, as arrays."""


class States:
    """Positions and velocities of bodies, world frame.

    position (..., 3) m, orientation (..., 4) unit quaternion body to world w first,
    velocity (..., 3) m/s, angular_velocity (..., 3) rad/s.

    A force is given (n, 3), or (3,) where it acts on one body by name: arrays that are filled anew
    for each call and cannot be written; copy what shall last. Of a run the leading axes are times
    and bodies.
    """

    __slots__ = ("position", "orientation", "velocity", "angular_velocity")

    def __init__(self, position, orientation, velocity, angular_velocity):
        self.position = position
        self.orientation = orientation
        self.velocity = velocity
        self.angular_velocity = angular_velocity

    def __repr__(self):
        return f"States(position{getattr(self.position, 'shape', '')})"
