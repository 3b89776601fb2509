"""Reference files of FITS, written by astropy and gzipped, because even the smallest is larger than the limit."""

import gzip
import io

import numpy as np
from astropy.io import fits

from cases.sources import small, source

SKY = {"CTYPE1": "RA---SIN", "CTYPE2": "DEC--SIN", "CDELT1": -0.002, "CDELT2": 0.004}


def cases(folder):
    """Writes types, scales, blanks, axes, coordinates, extensions and gzipped files. Rows are written bottom to top."""

    def write(name, units, choice="", expected=None):
        units = units if isinstance(units, list) else [units]
        plain = io.BytesIO()
        fits.HDUList(units).writeto(plain)
        (folder / name).write_bytes(gzip.compress(plain.getvalue(), mtime=0))
        data = units[0].data if expected is None else expected
        return name, choice, np.asarray(data)[:, ::-1] if np.ndim(data) == 3 else np.asarray(data)[None, ::-1]

    def image(data, header=None, unit=fits.PrimaryHDU):
        found = unit(data)
        for keyword, value in (header or {}).items():
            found.header[keyword] = value
        return found

    for kind in ("uint8", "int16", "int32", "int64", "float32", "float64"):
        yield write(f"fits_{kind}.fits.gz", image(source(kind)))
    for kind in ("uint16", "int8"):
        yield write(f"fits_{kind}.fits.gz", image(source(kind)))
    yield write("fits_picture.fits.gz", image(source("int16", (4, 5))))
    times = source("int16", (2, 3, 4, 5))
    yield write("fits_times.fits.gz", image(times), "--frame 1", times[1])
    single = source("int16", (3, 1, 4, 5))
    yield write("fits_single.fits.gz", image(single), expected=single[:, 0])
    sky = SKY | {"CTYPE3": "FREQ", "CUNIT3": "Hz", "CDELT3": 1e6}
    yield write("fits_sky.fits.gz", image(source("float32"), sky))
    lengths = {f"CUNIT{axis}": "mm" for axis in (1, 2, 3)} | {"CDELT1": 0.5, "CDELT2": 0.5, "CDELT3": 2.0}
    yield write("fits_lengths.fits.gz", image(source("float32"), lengths))
    matrix = {"CTYPE1": "GLON-CAR", "CTYPE2": "GLAT-CAR", "CD1_1": 0.0, "CD1_2": 0.2, "CD2_1": 0.1, "CD2_2": 0.0}
    yield write("fits_matrix.fits.gz", image(source("int16"), matrix))
    second = source("float32")
    units = [fits.PrimaryHDU(), image(source("int16"), {"EXTNAME": "SCI"}, fits.ImageHDU)]
    units.append(image(second, {"EXTNAME": "ERR"}, fits.ImageHDU))
    yield write("fits_extensions.fits.gz", units, "--array 2", second)
    gaps = source("float32")
    gaps.flat[3] = np.nan
    yield write("fits_not_a_number.fits.gz", image(gaps))
    numbers = small("int16")
    scaled = image(numbers)
    scaled.scale("int16", bscale=0.5, bzero=10)
    yield (*write("fits_scaled.fits.gz", scaled)[:2], None)
