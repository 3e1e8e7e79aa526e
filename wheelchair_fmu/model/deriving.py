"""One thread at a time makes and derives expressions."""

from threading import RLock

# CasADi lets other threads of Python run while it works, and counts who uses an expression without heeding them; all share some
# of them, such as 0 and 1, so that two models that are made at once may end the process.
deriving = RLock()
