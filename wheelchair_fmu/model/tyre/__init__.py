"""Tyre laws, of which a model has one: linear, Dugoff, or the Magic Formula."""

from . import dugoff, linear, magic_formula

LAWS = {law.LAW.name: law.LAW for law in (linear, dugoff, magic_formula)}
