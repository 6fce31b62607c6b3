"""What kairos raises."""


class InputError(ValueError):
    """What a person wrote is wrong: a scene, an option, a row of an array.

    file: of a scene; "" where there is none.  line: of it; 0 where it is not of a line.
    key: "body.ball.radius", "frame", "row 17".  reason: what is wrong and what is allowed.
    """

    def __init__(self, file: str, line: int, key: str, reason: str):
        place = file + (f":{line}" if file and line else "")
        super().__init__(": ".join(part for part in (place, key, reason) if part))
        self.file, self.line, self.key, self.reason = file, line, key, reason

    def __reduce__(self):
        return type(self), (self.file, self.line, self.key, self.reason)


class CallableError(RuntimeError):
    """A force, drive, impact law or recorder of one's own returned what cannot be used. What it
    raises itself comes through as it is."""


class ProgramError(RuntimeError):
    """The program kairos, which sweeps and advice are run by, failed or was not found.

    code: its exit code (1: a run failed, 2: the input is wrong), None where it did not run."""

    def __init__(self, message: str, code=None):
        super().__init__(message)
        self.code = code
