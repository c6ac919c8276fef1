//! An auxetic trajectory that isn't the law's own.

use auxetica_engine::{Finite, LawView, Moment, Positive, ReadBody, RodLaw, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Changes the extension `eps` that the laws before have given each element, rest length = (1 + eps) printed length:
/// `e = gain eps + quadratic eps^2`, then `saturation tanh(e / saturation)`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Extension {
    /// Factor [-].
    #[serde(default)]
    gain: Option<Finite>,
    /// Factor of the square [-].
    #[serde(default)]
    quadratic: Option<Finite>,
    /// Extension that is approached [-]; none if left out.
    #[serde(default)]
    saturation: Option<Positive>,
}

register!(
    dyn RodLaw: Extension,
    example = "Extension(gain: 0.95, saturation: 0.8)",
    source = "Stölzle et al. 2023, section II-C: the linear trajectory holds in a limited range only",
);

impl RodLaw for Extension {
    fn rest(&self, _now: &Moment<'_>, rod: &mut LawView<'_>) {
        let gain = self.gain.map_or(1.0, f64::from);
        let quadratic = self.quadratic.map_or(0.0, f64::from);
        for e in 0..rod.elements() {
            let printed = rod.reference_length(e);
            let eps = rod.rest_length(e) / printed - 1.0;
            let bent = gain * eps + quadratic * eps * eps;
            let extension = self
                .saturation
                .map_or(bent, |most| *most * (bent / *most).tanh());
            rod.set_rest_length(e, printed * (1.0 + extension.max(-0.9)));
        }
    }
}
