"""Generators of the reference files: small ones of each format, and the phantom."""
