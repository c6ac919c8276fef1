//! Coefficients of the generalised-alpha method.

/// Coefficients of Chung and Hulbert 1993 ([10.1115/1.2900803](https://doi.org/10.1115/1.2900803)), of second order and
/// stable for any step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scheme {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Scheme {
    /// The scheme whose steps, when much longer than a vibration's period, leave this share of it each.
    pub(super) fn new(spectral_radius: f64) -> Self {
        let alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
        let alpha_f = spectral_radius / (spectral_radius + 1.0);
        let gamma = 0.5 - alpha_m + alpha_f;
        Self {
            alpha_m,
            alpha_f,
            beta: (gamma + 0.5).powi(2) / 4.0,
            gamma,
        }
    }

    /// The scheme's own acceleration at the end of a step of `h` that has moved by `motion`, from rate and acceleration
    /// at its start.
    pub(super) fn acceleration(&self, h: f64, motion: f64, rate: f64, before: f64) -> f64 {
        ((motion / h - rate) / h - (0.5 - self.beta) * before) / self.beta
    }

    /// The rate at the end of a step, from rate and accelerations of the scheme.
    pub(super) fn rate(&self, h: f64, rate: f64, before: f64, after: f64) -> f64 {
        rate + h * ((1.0 - self.gamma) * before + self.gamma * after)
    }

    /// The true acceleration at the end of a step, from the true one at its start and those of the scheme.
    pub(super) fn true_acceleration(&self, truly_before: f64, before: f64, after: f64) -> f64 {
        ((1.0 - self.alpha_m) * after + self.alpha_m * before - self.alpha_f * truly_before)
            / (1.0 - self.alpha_f)
    }

    /// What a unit of motion in a step of `h` adds to rate \[1/s\] and true acceleration \[1/s2\] at its end.
    pub(super) fn slopes(&self, h: f64) -> (f64, f64) {
        let acceleration = 1.0 / (self.beta * h * h);
        let share = (1.0 - self.alpha_m) / (1.0 - self.alpha_f);
        (self.gamma * h * acceleration, share * acceleration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Decay a step of an oscillator of angular frequency `w`, over many steps of 1.
    fn decay(scheme: Scheme, w: f64) -> f64 {
        let (mut x, mut v, mut a) = (1.0, 0.0, -w * w);
        let mut truly = a;
        let (rate, slope) = scheme.slopes(1.0);
        assert!(rate > 0.0);
        let mut sizes = Vec::new();
        for _ in 0..200 {
            // linear, so one correction of no motion is exact
            let still = scheme.acceleration(1.0, 0.0, v, a);
            let residual = -w * w * x - scheme.true_acceleration(truly, a, still);
            let motion = residual / (w * w + slope);
            let next = scheme.acceleration(1.0, motion, v, a);
            x += motion;
            v = scheme.rate(1.0, v, a, next);
            (truly, a) = (scheme.true_acceleration(truly, a, next), next);
            sizes.push(x.hypot(v / w));
        }
        // nothing at all may be left
        (sizes[199] / sizes[99].max(f64::MIN_POSITIVE)).powf(0.01)
    }

    #[test]
    fn slow_vibrations_stay_and_fast_ones_decay_as_the_spectral_radius_says() {
        for radius in [0.0, 0.5, 0.8, 1.0] {
            let scheme = Scheme::new(radius);
            assert!(decay(scheme, 0.01) > 1.0 - 1e-5, "radius {radius}");
            let fast = decay(scheme, 1e5);
            // a double root: n radius^n
            assert!((fast - radius).abs() < 0.03, "radius {radius}: {fast}");
        }
    }
}
