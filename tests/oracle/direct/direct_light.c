// Pictures of direct light with volumetric shadows, computed by brute force: the oracle of compare.py.
//
// It shares no code with the program. Densities and slopes are sums over the 64 neighbours with cubic B-spline weights,
// zero outside; every ray, from the eye and from each sample to the light, takes even steps of a small fraction of a
// voxel, with values at their middles. docs/LIGHT.md has the formulas of matter and reflectance.
//
//   cc -O3 -march=native -ffast-math -o direct_light direct_light.c -lm
//   ./direct_light VOXELS < PARAMETERS > PIXELS
//
// VOXELS: 32-bit floats, x fastest. PARAMETERS, numbers between spaces: voxels along x, y, z · edges of a voxel along
// them in scene units · values of densities 0 and 1 · opacity unit in scene units · number of control points, and
// density and opacity of each · ambient, intensity, surface gradient · unit vector to the parallel light · right, up and
// backward axis of the camera · half the height of the picture in scene units · pixels along an edge · first pixel, end
// and stride, along x and y alike · steps of the eye's rays and of shadow rays, in shortest edges of a voxel.
// PIXELS: x, y, radiance, and alpha, a pixel in each line; colours are white.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Entries of the table of extinctions: 1/256 of a step of 8 bits.
enum { ENTRIES = 65536, MOST_POINTS = 64 };
// Optical depth beyond which light no longer matters: e^-14 is 2e-4 of a step of 8 bits.
#define OPAQUE_DEPTH 14.0

static int dims[3];
static double edges[3];
static float *voxels;
// Cells that hold anything visible within the kernel's reach, counted from two voxels before the grid.
static unsigned char *cells;
static float extinctions[ENTRIES + 2];

static double number(void) {
    double value;
    if (scanf("%lf", &value) != 1) {
        fprintf(stderr, "direct_light: a parameter is missing\n");
        exit(2);
    }
    return value;
}

static void vector(double *to) {
    for (int axis = 0; axis < 3; axis++) {
        to[axis] = number();
    }
}

static size_t cell_at(int x, int y, int z) {
    return ((size_t)z * (dims[1] + 3) + y) * (dims[0] + 3) + x;
}

static int may_hold_matter(const double *p) {
    int at[3];
    for (int axis = 0; axis < 3; axis++) {
        at[axis] = (int)floor(p[axis]) + 2;
        if (at[axis] < 0 || at[axis] > dims[axis] + 2) {
            return 0;
        }
    }
    return cells[cell_at(at[0], at[1], at[2])];
}

static void weights(double f, double *w) {
    double g = 1 - f;
    w[0] = g * g * g / 6;
    w[1] = (4 - 3 * f * f * (2 - f)) / 6;
    w[2] = (4 - 3 * g * g * (2 - g)) / 6;
    w[3] = f * f * f / 6;
}

static void derivatives(double f, double *w) {
    double g = 1 - f;
    w[0] = -0.5 * g * g;
    w[1] = f * (1.5 * f - 2);
    w[2] = g * (2 - 1.5 * g);
    w[3] = 0.5 * f * f;
}

// Density at a point in index space, and its gradient there if that is asked for.
static double density(const double *p, double *gradient) {
    int first[3];
    double w[3][4], d[3][4];
    for (int axis = 0; axis < 3; axis++) {
        double cell = floor(p[axis]);
        first[axis] = (int)cell - 1;
        weights(p[axis] - cell, w[axis]);
        derivatives(p[axis] - cell, d[axis]);
    }
    double sum = 0, along[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++) {
        int z = first[2] + k;
        for (int j = 0; j < 4; j++) {
            int y = first[1] + j;
            if (z < 0 || z >= dims[2] || y < 0 || y >= dims[1]) {
                continue;
            }
            const float *row = voxels + ((size_t)z * dims[1] + y) * dims[0];
            double value = 0, change = 0;
            for (int i = 0; i < 4; i++) {
                int x = first[0] + i;
                if (x >= 0 && x < dims[0]) {
                    value += w[0][i] * row[x];
                    change += d[0][i] * row[x];
                }
            }
            sum += w[2][k] * w[1][j] * value;
            along[0] += w[2][k] * w[1][j] * change;
            along[1] += w[2][k] * d[1][j] * value;
            along[2] += d[2][k] * w[1][j] * value;
        }
    }
    for (int axis = 0; gradient && axis < 3; axis++) {
        gradient[axis] = along[axis];
    }
    return sum;
}

static double extinction(double of_density) {
    double at = fmin(fmax(of_density, 0), 1) * ENTRIES;
    int entry = (int)at;
    return extinctions[entry] + (extinctions[entry + 1] - extinctions[entry]) * (at - entry);
}

// Fills the table of extinctions per scene unit from opacities per `unit`, linear between control points.
static void read_curve(double unit) {
    int points = (int)number();
    double at[MOST_POINTS], opacity[MOST_POINTS];
    if (points < 1 || points > MOST_POINTS) {
        fprintf(stderr, "direct_light: 1 to %d control points\n", MOST_POINTS);
        exit(2);
    }
    for (int i = 0; i < points; i++) {
        at[i] = number();
        opacity[i] = number();
    }
    for (int entry = 0, i = 0; entry <= ENTRIES + 1; entry++) {
        double here = fmin((double)entry / ENTRIES, 1);
        while (i + 1 < points && here > at[i + 1]) {
            i++;
        }
        double found = here <= at[0] ? opacity[0] : opacity[points - 1];
        if (here > at[0] && i + 1 < points) {
            found = opacity[i] + (opacity[i + 1] - opacity[i]) * (here - at[i]) / (at[i + 1] - at[i]);
        }
        extinctions[entry] = -log(1 - found) / unit;
    }
}

static void mark_cells(void) {
    int clear = 0;
    while (clear < ENTRIES && extinctions[clear + 1] <= 0) {
        clear++;
    }
    cells = calloc(cell_at(0, 0, dims[2] + 3), 1);
    for (int z = 0; z < dims[2]; z++) {
        for (int y = 0; y < dims[1]; y++) {
            for (int x = 0; x < dims[0]; x++) {
                if (voxels[((size_t)z * dims[1] + y) * dims[0] + x] * ENTRIES <= clear) {
                    continue;
                }
                for (int near = 0; near < 64; near++) {
                    cells[cell_at(x + near % 4, y + near / 4 % 4, z + near / 16)] = 1;
                }
            }
        }
    }
}

// Transmittance from a point in index space to a parallel light.
static double transmittance(const double *from, const double *to_light, double step, double reach) {
    double depth = 0;
    for (double way = step / 2; way < reach && depth < OPAQUE_DEPTH; way += step) {
        double p[3];
        for (int axis = 0; axis < 3; axis++) {
            p[axis] = from[axis] + to_light[axis] * way / edges[axis];
        }
        if (may_hold_matter(p)) {
            depth += extinction(density(p, NULL)) * step;
        }
    }
    return exp(-depth);
}

int main(int count, char **arguments) {
    double low, high, to_light[3], right[3], up[3], back[3];
    for (int axis = 0; axis < 3; axis++) {
        dims[axis] = (int)number();
    }
    vector(edges);
    low = number(), high = number();
    double unit = number();
    read_curve(unit);
    double ambient = number(), intensity = number(), surface_gradient = number();
    vector(to_light), vector(right), vector(up), vector(back);
    double half_height = number();
    int size = (int)number(), first = (int)number(), end = (int)number(), stride = (int)number();
    double shortest = fmin(edges[0], fmin(edges[1], edges[2]));
    double step = number() * shortest, shadow_step = number() * shortest;

    size_t total = (size_t)dims[0] * dims[1] * dims[2];
    voxels = malloc(total * sizeof *voxels);
    FILE *file = count > 1 ? fopen(arguments[1], "rb") : NULL;
    if (!voxels || !file || fread(voxels, sizeof *voxels, total, file) != total) {
        fprintf(stderr, "direct_light: cannot read the voxels\n");
        return 2;
    }
    fclose(file);
    for (size_t i = 0; i < total; i++) {
        voxels[i] = (voxels[i] - low) / (high - low);
    }
    mark_cells();
    double radius = 0;
    for (int axis = 0; axis < 3; axis++) {
        radius += pow(edges[axis] * (dims[axis] + 4) / 2, 2);
    }
    radius = sqrt(radius);

    for (int y = first; y < end; y += stride) {
        for (int x = first; x < end; x += stride) {
            double scale = 2 * half_height / size;
            double aside = (x + 0.5 - size / 2.0) * scale, above = (size / 2.0 - y - 0.5) * scale;
            double left = 1, radiance = 0;
            for (double way = step / 2; way < 2 * radius && left > 1e-4; way += step) {
                double p[3], slope[3];
                for (int axis = 0; axis < 3; axis++) {
                    double at = right[axis] * aside + up[axis] * above + back[axis] * (radius - way);
                    p[axis] = at / edges[axis] + (dims[axis] - 1) / 2.0;
                }
                double sigma = may_hold_matter(p) ? extinction(density(p, slope)) : 0;
                if (sigma <= 0) {
                    continue;
                }
                double share = 1 - exp(-sigma * step), steepness = 0, facing = 0;
                for (int axis = 0; axis < 3; axis++) {
                    double along = slope[axis] / edges[axis];
                    steepness += along * along;
                    facing -= along * to_light[axis];
                }
                facing = steepness > 0 ? facing / sqrt(steepness) : 0;
                double change = steepness * unit * unit;
                double surfaceness = change / (change + surface_gradient * surface_gradient);
                double reflected = surfaceness * fmax(facing, 0) + 1 - surfaceness;
                if (reflected > 0 && left * share > 2e-5) {
                    reflected *= transmittance(p, to_light, shadow_step, 2 * radius);
                }
                radiance += left * share * (ambient + intensity * reflected);
                left *= 1 - share;
            }
            printf("%d %d %.7g %.7g\n", x, y, radiance, 1 - left);
        }
    }
    return 0;
}
