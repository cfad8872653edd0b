// Restitution coefficients of the normal laws in closed form or as fits (docs/physics.md 3), for derived
// quantities and tests; engines that collide particles directly use them as models.
#pragma once

namespace sandlane::laws {

// Linear dashpot cut at zero force; z = gamma/(2 sqrt(k m_eff)) >= 0.
[[nodiscard]] double linear_dashpot_restitution(double z);
// Duration of the same contact in units of 1/w0 = sqrt(m_eff/k).
[[nodiscard]] double linear_dashpot_contact_time(double z);
// Viscoelastic spheres, cut; x = A (K/m_eff)^{2/5} g^{1/5}. Pade form of Mueller & Poeschel 2011.
[[nodiscard]] double viscoelastic_restitution(double x);

} // namespace sandlane::laws
