"""The files that are written: small ones of each format, and the phantom."""
