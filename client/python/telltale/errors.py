"""What the package raises, in the words of the command ``telltale``."""


class InputError(ValueError):
    """An argument, or a file that it names, is not what it should be.

    The message names what is wrong, where, and what is allowed. The command exits with 1 or 2 for the same.
    """


class DataCannotTell(RuntimeError):
    """The recordings cannot answer the question. The command exits with 3 for the same.

    Attributes:
        subject: what was asked about.
        reason: why the data do not answer it.
        advice: what to do.
    """

    def __init__(self, subject: str, reason: str, advice: str) -> None:
        super().__init__(subject, reason, advice)
        self.subject = subject
        self.reason = reason
        self.advice = advice

    def __str__(self) -> str:
        return f"{self.subject}: {self.reason}\n-> {self.advice}"
