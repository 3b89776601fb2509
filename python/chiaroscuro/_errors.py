"""Exceptions of the package."""


class Error(Exception):
    """Base class of all exceptions of this package."""


class InvalidArgument(Error, ValueError):
    """An argument has a value that it cannot have; the message says which are possible."""


class UnreadableFile(Error, OSError):
    """A file is missing, damaged or of an unknown kind."""


class NoAdapter(Error):
    """There is no usable graphics adapter, or it was lost; the message says what to install."""


class OutOfMemory(Error, MemoryError):
    """Memory is exhausted, or a limit is exceeded; the message names sizes that fit."""


class ForkedProcess(Error):
    """The process is a fork of one that has used the package."""
