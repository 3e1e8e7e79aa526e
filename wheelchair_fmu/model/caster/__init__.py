"""Caster laws, of which a model has one: ideal, swivelling without side slip, or slipping."""

from . import ideal, paper, slipping, swivelling

LAWS = {law.LAW.name: law.LAW for law in (ideal, swivelling, slipping, paper)}
