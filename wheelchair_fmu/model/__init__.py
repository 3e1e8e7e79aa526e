"""The paper: equations, laws, effects. CasADi expressions and records; no files, no plots."""
