"""Caster laws, of which a model has one: ideal, or swivelling."""

from . import ideal, paper, swivelling

LAWS = {law.LAW.name: law.LAW for law in (ideal, swivelling, paper)}
