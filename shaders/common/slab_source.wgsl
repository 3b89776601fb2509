// Emission of a slab, as shares of its source: with m = (1 − e^−τ)/τ, the mean over the slab gets the share g = (1 −
// m)/τ of the light emitted over all of it, and m leaves it.
fn slab_emission_share(tau: f32) -> f32 {
    // The series avoids 0/0; at 0.1 its error is τ⁴/720 = 2e-7, and the rounding of the quotient is as small.
    let mean = (1.0 - exp(-tau)) / max(tau, 0.1);
    return select((1.0 - mean) / max(tau, 0.1), 0.5 - tau * (1.0 / 6.0 - tau * (1.0 / 24.0 - tau / 120.0)), tau < 0.1);
}
