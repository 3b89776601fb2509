// Mean transmittance over a slab of optical depth tau, relative to the transmittance in front of it: (1 − e^−τ)/τ.
fn slab_mean_transmittance(tau: f32) -> f32 {
    // The series avoids 0/0; at 0.01 its error is τ³/24 = 4e-8.
    return select((1.0 - exp(-tau)) / tau, 1.0 - tau * (0.5 - tau / 6.0), tau < 0.01);
}
