"""What is around a chair in a simulation: a person who pushes it, and the floor under it.

Both are models of the same kind as the chair, M(p) x' = f(x, w, p) with results y(x, w, p), so the engine that steps the
chair and the tools that make an FMU of it serve them too.
"""
