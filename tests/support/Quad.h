// Reference values in quadruple precision (113 bits) by GCC's libquadmath, for tests. Declared here because
// clang does not see GCC's quadmath.h.
#pragma once

__extension__ typedef __float128 Quad;

extern "C" {
Quad expq(Quad) noexcept;
Quad expm1q(Quad) noexcept;
Quad logq(Quad) noexcept;
Quad log1pq(Quad) noexcept;
Quad sinq(Quad) noexcept;
Quad cosq(Quad) noexcept;
Quad tanq(Quad) noexcept;
Quad tanhq(Quad) noexcept;
Quad sinhq(Quad) noexcept;
Quad coshq(Quad) noexcept;
Quad atanq(Quad) noexcept;
Quad atan2q(Quad, Quad) noexcept;
Quad asinq(Quad) noexcept;
Quad acosq(Quad) noexcept;
Quad sqrtq(Quad) noexcept;
Quad fabsq(Quad) noexcept;
Quad powq(Quad, Quad) noexcept;
}
