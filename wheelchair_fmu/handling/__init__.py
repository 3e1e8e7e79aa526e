"""How the chair handles: the manoeuvres it is put through."""
